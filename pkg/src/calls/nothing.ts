// Why no motion was found but one, from what two frames show: in one sentence, with the numbers that it rests on.

import type { Matrix, Note, Pixels } from '../../types/index.js';

/** Pixels that are looked at, at most, and blocks of a side of the picture. */
const [SAMPLES, BLOCKS] = [40_000, 16];
/** Grey levels: deviation of a picture without contrast; mean difference that noise and compression make. */
const [FLAT, NOISE] = [3, 1.5];
/** Steps that are shorter are not told from noise, pixels. */
const SHORTEST_STEP = 0.2;
/** Below this correlation of the blocks of two frames they show different scenes. */
const ALIKE = 0.3;
/** Above this share of their contrast, what the only motion leaves between two frames is a difference of scenes. */
const UNLIKE = 0.8;

/** `motion`: the only one, as far as it is known. */
export function whyNothing(
  first: Pixels,
  second: Pixels,
  { matrix, residual = 0 }: { matrix?: Matrix | undefined; residual?: number },
): Note {
  const { width, height } = first;
  const [one, other] = [sampled(first), sampled(second)];
  const contrast = Math.max(deviation(one), deviation(other));
  if (contrast < FLAT) {
    return {
      code: 'no-contrast',
      message: `the frames have nearly no contrast: their grey levels differ by ${contrast.toFixed(1)} in all`,
    };
  }
  const isOther = residual > UNLIKE * contrast || correlation(blocks(first), blocks(second)) < ALIKE;
  if (isOther) return { code: 'cut', message: 'the frames show different scenes: there is a cut between them' };
  const difference = mean(one.map((level, at) => Math.abs(level - (other[at] as number))));
  const step = matrix ? longestStep(matrix, width, height) : 0;
  if (step < SHORTEST_STEP && difference < NOISE) {
    return {
      code: 'no-motion',
      message: `nothing moves between the frames: their grey levels differ by ${difference.toFixed(2)} on average`,
    };
  }
  if (step < SHORTEST_STEP) {
    return {
      code: 'small-steps',
      message: `nothing moves by ${SHORTEST_STEP} pixels or more as one piece: frames that are farther apart may tell more`,
    };
  }
  return {
    code: 'one-motion',
    message: `the whole picture follows one motion, of up to ${step.toFixed(1)} pixels: nothing is seen to move by itself`,
  };
}

/** The longest displacement at a corner. */
function longestStep([a11, a12, a13, a21, a22, a23]: Matrix, width: number, height: number): number {
  const corners = [0, width - 1].flatMap((x) => [0, height - 1].map((y) => Math.hypot(a11 * x + a12 * y + a13, a21 * x + a22 * y + a23)));
  return Math.max(...corners);
}

function levelAt(data: ArrayLike<number>, pixel: number): number {
  return 0.299 * (data[4 * pixel] as number) + 0.587 * (data[4 * pixel + 1] as number) + 0.114 * (data[4 * pixel + 2] as number);
}

/** Grey levels of pixels all over the picture. */
function sampled({ data, width, height }: Pixels): Float64Array {
  const step = Math.max(1, Math.floor((width * height) / SAMPLES));
  return Float64Array.from({ length: Math.floor((width * height) / step) }, (_, at) => levelAt(data, at * step));
}

/** Mean grey levels of the blocks of a grid. */
function blocks({ data, width, height }: Pixels): Float64Array {
  const [sums, counts] = [new Float64Array(BLOCKS * BLOCKS), new Float64Array(BLOCKS * BLOCKS)];
  const step = Math.max(1, Math.floor(Math.sqrt((width * height) / SAMPLES)));
  for (let y = 0; y < height; y += step) {
    for (let x = 0; x < width; x += step) {
      const block = Math.floor((y * BLOCKS) / height) * BLOCKS + Math.floor((x * BLOCKS) / width);
      sums[block] = (sums[block] as number) + levelAt(data, y * width + x);
      counts[block] = (counts[block] as number) + 1;
    }
  }
  return sums.map((sum, block) => sum / Math.max(counts[block] as number, 1));
}

function mean(values: Float64Array): number {
  return values.reduce((sum, value) => sum + value, 0) / values.length;
}

function deviation(values: Float64Array): number {
  const middle = mean(values);
  return Math.sqrt(mean(values.map((value) => (value - middle) ** 2)));
}

/** 1 where one of them is flat: then there is nothing to compare. */
function correlation(one: Float64Array, other: Float64Array): number {
  const [middle, otherMiddle] = [mean(one), mean(other)];
  const together = mean(one.map((value, at) => (value - middle) * ((other[at] as number) - otherMiddle)));
  const apart = deviation(one) * deviation(other);
  return Math.min(deviation(one), deviation(other)) < 1 ? 1 : together / apart;
}
