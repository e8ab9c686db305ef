//! The clicks of a prompt as discs with a plus or a minus, and its box.

import type { Prompt } from '../state/statement.js';
import { drawn } from './markup.js';

/** Radius of a disc, and half the length of the lines in it. */
const [DISC, LINE] = [7, 4];

/** `scale`: pixels of the frame for each of the masks. `unit`: pixels of the frame for one of the screen. */
export function promptMarks({ clicks, box }: Prompt, scale: number, unit: number): SVGElement[] {
  const place = (value: number): number => (value + 0.5) * scale - 0.5;
  const [x, y, width, height] = box ?? [];
  const boxes = x === undefined ? [] : [drawn('rect', { class: 'prompt box', x: x * scale - 0.5, y: y! * scale - 0.5, width: width! * scale, height: height! * scale })];
  const discs = clicks.map(([column, row, sign]) => {
    const [radius, half, left] = [DISC * unit, LINE * unit, place(column) - DISC * unit];
    const plus = sign > 0 ? `M${place(column)} ${place(row) - half}v${2 * half}` : '';
    const disc = `M${left} ${place(row)}a${radius} ${radius} 0 1 0 ${2 * radius} 0a${radius} ${radius} 0 1 0 ${-2 * radius} 0z`;
    return drawn('path', { class: sign > 0 ? 'prompt plus' : 'prompt minus', d: `${disc}M${place(column) - half} ${place(row)}h${2 * half}${plus}` });
  });
  return [...boxes, ...discs];
}
