// YOLO segmentation: one line per label, its class and one ring in shares of the image's sides.

import type { FormatMeta, YoloFiles } from '../../types/formats.js';
import { invalidInput, invalidOption, isListOf, reading } from '../common/checks.js';
import { checkedOptions, classNames, masksOf } from './input.js';
import { Outlines } from './outline.js';

/** Enough for an error far below a thousandth of a pixel. */
const DECIMALS = 8;

export function encodeYolo(
  labels: Uint8Array,
  width: number,
  height: number,
  meta: FormatMeta = {},
  options?: { tolerance?: number; classes?: readonly string[] },
): YoloFiles {
  const { tolerance, classes } = checkedOptions(options, [], {}, ['classes']);
  const masks = masksOf(labels, width, height, meta);
  const names = reading(() => listed(classes)) ?? classNames(masks);
  const outlines = new Outlines(tolerance);
  const [shareX, shareY] = [shares(width), shares(height)];
  const lines = masks.map((mask) => {
    const ring = outlines.single(mask);
    return `${numberOf(mask.name, names)} ${ring.map((value, at) => (at % 2 === 0 ? shareX : shareY)[value]).join(' ')}\n`;
  });
  return { text: lines.join(''), names };
}

function listed(classes: unknown): string[] | undefined {
  const isName = (name: unknown) => typeof name === 'string';
  if (classes === undefined || isListOf(classes, isName)) return classes && [...classes];
  throw invalidOption('classes', 'a list of names', classes);
}

function numberOf(name: string, classes: readonly string[]): number {
  const number = classes.indexOf(name);
  if (number < 0) throw invalidInput(`'${name}' is not among the classes`);
  return number;
}

/** What the whole numbers up to a side are of it, as text: once each and not for every vertex. */
function shares(side: number): string[] {
  return Array.from({ length: side + 1 }, (_, value) => String(Number((value / side).toFixed(DECIMALS))));
}
