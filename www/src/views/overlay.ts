//! The masks over the picture: a canvas of fills, faded by the opacity, and a canvas of outlines. Over the first frame they lie as
//! labelled; over the second each is carried along by its motion.

import { fillOf, outlinesOf } from '../paint.js';
import type { Look, Result, Store } from '../state.js';
import { transformOf } from '../warp.js';
import { contextOf, find } from './markup.js';

/** One pixel of outline for every so many pixels of the longer side. */
const PIXELS_PER_OUTLINE = 400;

export function mountOverlay(stage: HTMLElement, store: Store): void {
  const fill = find(stage, '#fill', HTMLCanvasElement);
  const outlines = find(stage, '#outlines', HTMLCanvasElement);

  store.subscribe(({ result, look }, before) => {
    if (look.opacity !== before.look.opacity) fill.style.opacity = String(look.opacity);
    if (look.outlines !== before.look.outlines) outlines.hidden = !look.outlines;
    if (result === before.result && !repaints(look, before.look)) return;
    paint(fill, result, look, (segmentation) => fillOf(segmentation, look));
    paint(outlines, result, look, (segmentation) => outlinesOf(segmentation, look, thicknessFor(segmentation)));
  });
  fill.style.opacity = String(store.get().look.opacity);
}

function repaints(now: Look, before: Look): boolean {
  return (['frame', 'colouring', 'hidden', 'solo', 'still'] as const).some((key) => now[key] !== before[key]);
}

function thicknessFor({ width, height }: { readonly width: number; readonly height: number }): number {
  return Math.max(1, Math.round(Math.max(width, height) / PIXELS_PER_OUTLINE));
}

type Segmentation = Result['segmentation'];

function paint(canvas: HTMLCanvasElement, result: Result | null, look: Look, pixelsOf: (segmentation: Segmentation) => Uint32Array<ArrayBuffer>): void {
  const context = contextOf(canvas);
  if (result === null) {
    context.clearRect(0, 0, canvas.width, canvas.height);
    return;
  }
  const { segmentation } = result;
  canvas.width = segmentation.width;
  canvas.height = segmentation.height;
  const pixels = pixelsOf(segmentation);
  // The second frame held still lies in the first frame's place, and so do the masks.
  if (look.frame === 'first' || look.still !== null) context.putImageData(imageOf(pixels, canvas.width, canvas.height), 0, 0);
  else for (const motion of segmentation.motions) drawMoved(context, pixels, segmentation, motion);
}

function imageOf(pixels: Uint32Array<ArrayBuffer>, width: number, height: number): ImageData {
  return new ImageData(new Uint8ClampedArray(pixels.buffer), width, height);
}

/** Draws the pixels of one motion where it has carried them. The largest comes first, so that what moves before it covers it. */
function drawMoved(context: CanvasRenderingContext2D, pixels: Uint32Array, { labels, width }: Segmentation, motion: Segmentation['motions'][number]): void {
  const [left, top, across, down] = motion.bbox;
  if (across === 0 || down === 0) return;
  const own = new Uint32Array(across * down);
  for (let y = 0; y < down; y++) {
    const row = (top + y) * width + left;
    for (let x = 0; x < across; x++) {
      if (labels[row + x] === motion.label) own[y * across + x] = pixels[row + x]!;
    }
  }
  const piece = new OffscreenCanvas(across, down);
  piece.getContext('2d')?.putImageData(imageOf(own, across, down), 0, 0);
  context.setTransform(transformOf(motion.matrix));
  context.drawImage(piece, left, top);
  context.resetTransform();
}
