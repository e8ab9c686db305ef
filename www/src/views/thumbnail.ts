//! A small picture of a mask: its part of the frame.

import type { FrameMasks } from '../result/masks.js';
import type { LoadedFrame } from '../state/pair.js';
import { contextOf } from './markup.js';

type Box = FrameMasks['objects'][number]['bbox'];

/** Draws the part of a frame that is in a box. */
export function drawThumbnail(canvas: HTMLCanvasElement, frame: LoadedFrame, [left, top, across, down]: Box): void {
  const context = contextOf(canvas);
  const scale = Math.min(canvas.width / across, canvas.height / down);
  const [width, height] = [canvas.width / scale, canvas.height / scale];
  context.imageSmoothingQuality = 'high';
  context.clearRect(0, 0, canvas.width, canvas.height);
  // Beyond the frame there is nothing to draw.
  context.drawImage(frame.bitmap, left + (across - width) / 2, top + (down - height) / 2, width, height, 0, 0, canvas.width, canvas.height);
}
