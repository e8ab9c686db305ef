// YOLO segmentation: one line per label, its class and one ring in shares of the image's sides.

import type { FormatMeta, YoloFiles } from '../../types/formats.js';
import { invalidInput, invalidOption, isListOf, reading } from '../common/checks.js';
import { checkedMeta, checkedOptions, classNames, type Mask, masksOf } from './input.js';
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
  const names = reading(() => listed(classes)) ?? classNames(masks, checkedMeta(meta));
  const [shareX, shareY] = [shares(width), shares(height)];
  const lines = new Outlines(tolerance).singles({ masks, width, height }).map((ring, at) => {
    const share = ring.map((value, at) => (at % 2 === 0 ? shareX : shareY)[2 * value]);
    return `${numberOf((masks[at] as Mask).name, names)} ${share.join(' ')}\n`;
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

/** Half pixels up to a side as shares of it, as text: once each and not for every vertex. */
function shares(side: number): string[] {
  return Array.from({ length: 2 * side + 1 }, (_, halves) => String(Number((halves / 2 / side).toFixed(DECIMALS))));
}
