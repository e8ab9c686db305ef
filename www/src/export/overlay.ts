//! The frame with its masks as a PNG.

import { fillOf, outlinesOf } from '../drawing/paint.js';
import type { Look, Result } from '../state/state.js';

export async function overlayPicture({ masks, frame }: Result, look: Look): Promise<Blob> {
  const { width, height } = masks;
  const canvas = new OffscreenCanvas(width, height);
  const context = canvas.getContext('2d')!;
  context.drawImage(frame.bitmap, 0, 0);
  context.globalAlpha = look.opacity;
  context.drawImage(layer(fillOf(masks, look), width, height), 0, 0);
  context.globalAlpha = 1;
  const thickness = Math.max(1, Math.round(Math.max(width, height) / 400));
  if (look.outlines) context.drawImage(layer(outlinesOf(masks, look, thickness), width, height), 0, 0);
  return canvas.convertToBlob({ type: 'image/png' });
}

function layer(pixels: Uint32Array<ArrayBuffer>, width: number, height: number): OffscreenCanvas {
  const canvas = new OffscreenCanvas(width, height);
  canvas.getContext('2d')!.putImageData(new ImageData(new Uint8ClampedArray(pixels.buffer), width), 0, 0);
  return canvas;
}
