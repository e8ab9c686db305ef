//! A small picture of a mask: its part of the frame.

import type { Result } from '../state/state.js';
import { contextOf } from './markup.js';

type Labels = readonly number[];

/** Draws the part of the first frame that the motions with these labels cover. Returns whether there is any. */
export function drawThumbnail(canvas: HTMLCanvasElement, { segmentation, pair }: Result, labels: Labels): boolean {
  const boxes = segmentation.motions.filter(({ label }) => labels.includes(label)).map(({ bbox }) => bbox);
  const shown = boxes.filter(([, , width, height]) => width > 0 && height > 0);
  if (shown.length === 0) return false;
  const left = Math.min(...shown.map(([x]) => x));
  const top = Math.min(...shown.map(([, y]) => y));
  const right = Math.max(...shown.map(([x, , width]) => x + width));
  const bottom = Math.max(...shown.map(([, y, , height]) => y + height));
  const context = contextOf(canvas);
  const scale = Math.min(canvas.width / (right - left), canvas.height / (bottom - top));
  const [width, height] = [canvas.width / scale, canvas.height / scale];
  context.imageSmoothingQuality = 'high';
  context.clearRect(0, 0, canvas.width, canvas.height);
  // Beyond the frame there is nothing to draw.
  context.drawImage(pair.first.bitmap, (left + right - width) / 2, (top + bottom - height) / 2, width, height, 0, 0, canvas.width, canvas.height);
  return true;
}
