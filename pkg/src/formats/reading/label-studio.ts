// Tasks of Label Studio: brushes, polygons and rectangles of what people have annotated, or of predictions where nobody has. Objects have no
// numbers. Images that were uploaded are called by a hash and their name.

import { invalidInput, isListOf, isNumber, isObject, isWhole } from '../../common/checks.js';
import type { Size } from '../png-reader.js';
import {
  checkSize,
  type Context,
  type Drawing,
  frameOfShapes,
  known,
  listOf,
  polygonOf,
  quoted,
  type ReadFrame,
  type Shape,
  shapesOf,
  stemOf,
  turnedBox,
  Unnumbered,
  within,
} from './frame.js';

type Json = Record<string, unknown>;

/** Results about other results. */
const REMARKS = ['choices', 'textarea', 'rating', 'relation', 'taxonomy', 'number'];
const CHANNELS = 4;

export function readLabelStudio(tasks: readonly Json[], file: string, context: Context): ReadFrame[] {
  return tasks.flatMap((task, at) => {
    const name = imageOf(task);
    return within(`task ${quoted(task['id'] ?? at + 1)}, image ${quoted(name)}`, () => frameOf(task, name, file, context));
  });
}

function frameOf(task: Json, image: string, file: string, context: Context): ReadFrame[] {
  const unnumbered = new Unnumbered();
  let size: Size | undefined;
  const shapes = resultsOf(task).flatMap((result): Shape[] => {
    const { id, type, value, original_width: width, original_height: height } = result;
    if (REMARKS.includes(String(type))) return [];
    if (typeof type !== 'string' || !isObject(value)) return [{ leftOut: `results of type ${quoted(type)}` }];
    const place = `result ${quoted(id)}`;
    const own = within(place, () => checkSize(width, height, 'the image'));
    size ??= own;
    if (own.width !== size.width || own.height !== size.height) throw invalidInput(`${place}: the image has had another size`);
    const [name] = isListOf(value[type], (entry): entry is string => typeof entry === 'string') ? value[type] : [];
    return shapesOf(
      place,
      () => [drawing(type, value, own)],
      () => known(unnumbered.keyOf(name), undefined, name),
    );
  });
  return size ? [frameOfShapes({ name: stemOf(image), file, ...size }, shapes, context)] : [];
}

/** The results of the last annotation that was not skipped, else of the last prediction. */
function resultsOf({ annotations, completions = annotations, predictions }: Json): Json[] {
  const made = listOf(completions ?? [], 'annotations').filter((one) => one['was_cancelled'] !== true);
  const last = made.at(-1) ?? listOf(predictions ?? [], 'predictions').at(-1);
  return last ? listOf(last['result'], 'result') : [];
}

/** Of local files the path is in a query; uploads begin with eight digits of a hash. */
function imageOf({ data }: Json): string {
  const texts = Object.values(isObject(data) ? data : {}).filter((value) => typeof value === 'string');
  const path = texts.find((text) => /\.\w+$/.test(text)) ?? texts[0] ?? '';
  const name = path
    .replace(/^.*[?&]d=/s, '')
    .replace(/[?#].*$/s, '')
    .replace(/^.*\//s, '');
  return decoded(name)
    .replace(/^.*\//s, '')
    .replace(/^[0-9a-f]{8}-(?=.)/, '');
}

function decoded(text: string): string {
  try {
    return decodeURIComponent(text);
  } catch {
    return text;
  }
}

function drawing(type: string, value: Json, { width, height }: Size): Drawing {
  if (type === 'brushlabels') {
    const { rle } = value;
    const isBytes = isListOf(rle, (byte): byte is number => isWhole(byte, 0, 255));
    if (value['format'] !== 'rle' || !isBytes) throw invalidInput('a brush must have run lengths');
    return { draw: (canvas, label) => canvas.stamp(unpacked(Uint8Array.from(rle), width * height), label) };
  }
  if (type === 'polygonlabels') {
    const { points } = value;
    const isPoint = (point: unknown): point is number[] => isListOf(point, isNumber) && point.length === 2;
    if (!isListOf(points, isPoint)) throw invalidInput('the points of a polygon must each be x and y');
    return polygonOf(points.flatMap(([x, y]) => [((x as number) * width) / 100, ((y as number) * height) / 100]));
  }
  const [x, y, across, down] = ['x', 'y', ...(type === 'ellipselabels' ? ['radiusX', 'radiusY'] : ['width', 'height'])].map(
    (side, at) => (Number(value[side]) * (at % 2 === 0 ? width : height)) / 100,
  ) as [number, number, number, number];
  const angle = Number(value['rotation']) || 0;
  if (type === 'ellipselabels') return { draw: (canvas, label) => canvas.ellipse([x, y, across, down], label, angle) };
  if (type !== 'rectanglelabels') return { leftOut: `results of type ${quoted(type)}` };
  // It is turned about its first corner.
  return turnedBox([x, y, across, down], angle, [x, y]);
}

/** The pixels that are not transparent, from runs of RGBA bytes as @thi.ng/rle-pack packs them. Throws `invalid-input`. */
function unpacked(bytes: Uint8Array, pixels: number): Uint8Array {
  let at = 0;
  const read = (count: number): number => {
    if (at + count > 8 * bytes.length) throw invalidInput('the run lengths of a brush end early');
    let value = 0;
    for (const end = at + count; at < end; at++) value = value * 2 + (((bytes[at >> 3] as number) >> (7 - (at & 7))) & 1);
    return value;
  };
  const size = read(32);
  if (size !== CHANNELS * pixels) throw invalidInput(`the run lengths of a brush must be of ${CHANNELS * pixels} values, not ${size}`);
  const word = read(5) + 1;
  const lengths = [0, 1, 2, 3].map(() => read(4) + 1);
  const mask = new Uint8Array(pixels);
  for (let k = 0; k < size;) {
    const isRun = read(1) === 1;
    const end = k + read(lengths[read(2)] as number) + 1;
    if (end > size) throw invalidInput('the run lengths of a brush are damaged');
    for (let value = isRun ? read(word) : 0; k < end; k++) {
      if (!isRun) value = read(word);
      if (k % CHANNELS === CHANNELS - 1 && value > 0) mask[Math.floor(k / CHANNELS)] = 1;
    }
  }
  return mask;
}
