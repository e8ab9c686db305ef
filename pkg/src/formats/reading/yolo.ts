// YOLO: a text for each image, a line for each object: the number of its class, then its outline or its box, in shares of the image's sides. A
// text without lines says that there is nothing.

import { invalidInput } from '../../common/checks.js';
import { headOf, type Size } from '../png-reader.js';
import {
  type Context,
  type Drawing,
  frameOfShapes,
  isPng,
  known,
  type ReadFrame,
  shapesOf,
  type Source,
  stemOf,
  Unnumbered,
  within,
} from './frame.js';

/** How far outside a share may be: outlines are rounded, and moved. */
const SLACK = 0.01;

/** Whether text begins as YOLO's labels do. */
export function isYolo(text: string): boolean {
  return lineOf(/\S.*/.exec(text)?.[0] ?? '') !== undefined;
}

export function readYolo({ name: file }: Source, text: string, context: Context): ReadFrame {
  const name = stemOf(file);
  const { width, height } = context.sizeOf(file);
  const names = context.namesOf(file);
  const unnumbered = new Unnumbered();
  const shapes = text.split('\n').flatMap((written, at) => {
    if (written.trim() === '') return [];
    const place = `line ${at + 1}`;
    const line = within(place, () => checkedLine(written));
    const called = names[line.class] ?? `class-${line.class}`;
    const places = line.shares.map((share, k) => share * (k % 2 === 0 ? width : height));
    return shapesOf(
      place,
      () => [drawing(places)],
      () => known(unnumbered.keyOf(called), undefined, called),
    );
  });
  return frameOfShapes({ name, file, width, height }, shapes, context);
}

function checkedLine(written: string): Line {
  const line = lineOf(written);
  if (!line) throw invalidInput('it must have the number of a class, then a box, or three vertices or more');
  if (line.shares.some((share) => share < -SLACK || share > 1 + SLACK))
    throw invalidInput('its numbers are no shares of the sides, from 0 to 1');
  return line;
}

function drawing(places: readonly number[]): Drawing {
  if (places.length > 4) return { draw: (canvas, label) => canvas.polygon(places, label) };
  const [x, y, width, height] = places as [number, number, number, number];
  return { box: [x - width / 2, y - height / 2, width, height] };
}

/** A class, and columns and rows of vertices, or the middle, width and height of a box. */
interface Line {
  class: number;
  shares: number[];
}

/** Programs that find objects write their confidence behind it. */
function lineOf(text: string): Line | undefined {
  const [number = '', ...rest] = text.trim().split(/\s+/);
  if (!/^\d+$/.test(number) || rest.length < 4 || !rest.every((share) => Number.isFinite(Number(share)))) return undefined;
  return { class: Number(number), shares: rest.slice(0, rest.length - (rest.length % 2)).map(Number) };
}

/** The names of classes in a `data.yaml`, by number: a list or a map, over lines or within brackets. */
export function namesInYaml(text: string): string[] {
  const [, within = ''] = /^names[ \t]*:((?:.*[[{][^\]}]*)|(?:.*\n(?=[ \t\r\n#-]|\d+:))*.*)/m.exec(text) ?? [];
  const isFlow = /^\s*[[{]/.test(within);
  const names: string[] = [];
  const entry = isFlow
    ? /(?:(\d+)\s*:\s*)?("(?:\\.|[^"])*"|'(?:''|[^'])*'|[^\s,[{][^,]*)/g
    : /^[ \t]*(?:-|(\d+)[ \t]*:)[ \t]*("(?:\\.|[^"])*"|'(?:''|[^'])*'|[^\s#][^#\r\n]*)/gm;
  for (const [, number = names.length, name = ''] of within.matchAll(entry)) names[Number(number)] = plain(name.trim());
  return names;
}

function plain(name: string): string {
  const [quote] = name;
  return quote === '"' || quote === "'" ? name.slice(1, -1).replace(quote === '"' ? /\\(.)/g : /'(')/g, '$1') : name;
}

/** The size of a PNG or JPEG file, from its beginning; undefined of another one, or if it is not within the bytes. */
export function sizeOfPicture(bytes: Uint8Array): Size | undefined {
  if (isPng(bytes)) return headOf(bytes);
  const word = (at: number) => ((bytes[at] as number) << 8) | (bytes[at + 1] as number);
  // Segments of a JPEG: FF, what it is, its length. The one that begins a frame has the size.
  for (let at = 2; bytes[0] === 0xff && bytes[1] === 0xd8 && at + 9 < bytes.length; at += 2 + word(at + 2)) {
    while (bytes[at + 1] === 0xff) at++;
    const kind = bytes[at + 1] as number;
    if (bytes[at] !== 0xff) return undefined;
    if (kind >= 0xc0 && kind <= 0xcf && ![0xc4, 0xc8, 0xcc].includes(kind)) return { width: word(at + 7), height: word(at + 5) };
  }
  return undefined;
}
