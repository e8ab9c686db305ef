// Work for the compiler's sake. A browser runs a module slowly at first and compiles what runs often to the end meanwhile. Whoever comes
// with a task waits for one slice of it at most, so the first slices, which run slowly, are the smallest.

import type { Pixels } from '../../types/index.js';
import type { Api } from '../calls/api.js';

/**
 * Width and height of the pair of each slice, pixels. The largest ones, of which one is halved and one is not, are repeated: measured,
 * smaller pairs alone leave some of what is slow unused.
 */
const SLICES = [
  [32, 24],
  [48, 36],
  [64, 48],
  [96, 72],
  [128, 96],
  [352, 264],
  [256, 192],
] as const;
/** The first slice that is repeated. */
const REPEATED = 5;
/** Tiles across and down, of which every other one belongs to the background. */
const TILES = 3;
/** Displacements between the frames, pixels; the first is the background's. */
const MOTIONS = [
  [0.3, 0.2],
  [2, 1],
  [-1, 2],
  [1, -2],
] as const;
/** Slices go on until this time has passed. */
const MILLISECONDS = 500;

export class Warming {
  readonly #api: Pick<Api, 'warm'>;
  #ended = false;

  constructor(api: Pick<Api, 'warm'>) {
    this.#api = api;
  }

  /** Whether it was ended by something else to do. */
  get ended(): boolean {
    return this.#ended;
  }

  /** Ends it after the slice under way. */
  end(): void {
    this.#ended = true;
  }

  /** Segments small pairs of its own for a moment. Between two of them the worker hears what has come. */
  async run(): Promise<void> {
    const until = performance.now() + MILLISECONDS;
    for (let slice = 0; !this.#ended && performance.now() < until; slice++) {
      const [width, height] = sizeOf(slice);
      await this.#api.warm(frame(0, width, height), frame(1, width, height));
      await new Promise((resolve) => setTimeout(resolve));
    }
  }
}

function sizeOf(slice: number): readonly [width: number, height: number] {
  return SLICES[slice] ?? SLICES[REPEATED + ((slice - REPEATED) % (SLICES.length - REPEATED))] ?? SLICES[0];
}

/** Smooth texture, in tiles that move on their own. */
function frame(time: 0 | 1, width: number, height: number): Pixels {
  const data = new Uint8Array(4 * width * height);
  for (let y = 0, pixel = 0; y < height; y++) {
    for (let x = 0; x < width; x++, pixel++) {
      const column = Math.floor((TILES * x) / width);
      const row = Math.floor((TILES * y) / height);
      const motion = (row + column) % 2 === 0 ? 1 + column : 0;
      const [u, v] = MOTIONS[motion] ?? MOTIONS[0];
      data.fill(texture(x - time * u, y - time * v, motion), 4 * pixel, 4 * pixel + 3);
      data[4 * pixel + 3] = 255;
    }
  }
  return { data, width, height };
}

function texture(x: number, y: number, phase: number): number {
  return (
    128 +
    50 * (Math.sin(0.55 * x + phase) * Math.cos(0.37 * y - phase) + 0.6 * Math.sin(0.21 * x + 0.43 * y) + 0.4 * Math.cos(0.9 * y - 0.3 * x))
  );
}
