//! Objects cut out of their frames: the picture on them, and something else everywhere else.

import { PageError } from '../common/errors.js';
import { strings } from '../common/strings.js';
import { UNLABELLED } from '../result/masks.js';
import type { ClipExport, ClipFile } from './clip-export.js';

/** The background behind the objects. */
export type Ground = 'transparent' | 'green' | 'black';

const GREEN = '#00ff00';
/** Pixels of the picture around a transparent object, because codecs mix the colours of neighbours. */
const MARGIN = 4;

/** One byte per pixel: 255 where an object is, else 0. */
export function matteOf({ labels }: Pick<ClipFile, 'labels'>): Uint8Array<ArrayBuffer> {
  return Uint8Array.from(labels, (label) => (label === 0 || label === UNLABELLED ? 0 : 255));
}

/** The frame as it is shown: the objects, or before black their silhouettes. */
export async function drawn({ clip }: ClipExport, frame: ClipFile, ground: Ground): Promise<OffscreenCanvas> {
  const mask = silhouetteOf(frame);
  if (ground === 'black') return filledBehind(mask, 'black');
  const { bitmap } = await clip.frame(frame.index, Infinity);
  const [canvas, context] = contextOf(frame);
  context.drawImage(bitmap, 0, 0, frame.width, frame.height);
  bitmap.close();
  context.globalCompositeOperation = 'destination-in';
  context.drawImage(mask, 0, 0);
  return ground === 'green' ? filledBehind(canvas, GREEN) : canvas;
}

/** The colours of a transparent video: of the picture on the objects and next to them, black elsewhere. */
export async function colours({ clip }: ClipExport, frame: ClipFile): Promise<OffscreenCanvas> {
  const mask = silhouetteOf(frame);
  const [wider, around] = contextOf(frame);
  for (const x of [-MARGIN, 0, MARGIN]) for (const y of [-MARGIN, 0, MARGIN]) around.drawImage(mask, x, y);
  const { bitmap } = await clip.frame(frame.index, Infinity);
  around.globalCompositeOperation = 'source-in';
  around.drawImage(bitmap, 0, 0, frame.width, frame.height);
  bitmap.close();
  return filledBehind(wider, 'black');
}

/** White where an object is, transparent elsewhere. */
function silhouetteOf(frame: ClipFile): OffscreenCanvas {
  const [canvas, context] = contextOf(frame);
  const words = Uint32Array.from(matteOf(frame), (matte) => (matte === 0 ? 0 : 0xffff_ffff));
  context.putImageData(new ImageData(new Uint8ClampedArray(words.buffer), frame.width, frame.height), 0, 0);
  return canvas;
}

function filledBehind(canvas: OffscreenCanvas, colour: string): OffscreenCanvas {
  const context = canvas.getContext('2d')!;
  context.globalCompositeOperation = 'destination-over';
  context.fillStyle = colour;
  context.fillRect(0, 0, canvas.width, canvas.height);
  return canvas;
}

function contextOf({ width, height }: Pick<ClipFile, 'width' | 'height'>): readonly [OffscreenCanvas, OffscreenCanvasRenderingContext2D] {
  const canvas = new OffscreenCanvas(width, height);
  const context = canvas.getContext('2d');
  if (context === null) throw new PageError('unsupported-browser', strings.errors.noCanvas);
  return [canvas, context];
}
