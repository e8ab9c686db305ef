//! The masks over the picture: a canvas of fills, with the opacity, and a canvas of outlines. Over the second frame each mask is moved by
//! its motion. Large frames are painted in pieces, so that the page stays responsive.

import { fillOf, outlinesOf } from '../drawing/paint.js';
import { Piecewise } from '../drawing/piecewise.js';
import { transformOf } from '../drawing/warp.js';
import type { Look, Result, Store } from '../state/state.js';
import { contextOf, find, prefersStillness } from './markup.js';

/** Outlines are one pixel thick for every so many pixels of the longer side. */
const PIXELS_PER_OUTLINE = 400;

/** How long masks take to appear where there were none, milliseconds. */
const APPEARING = 350;

type Segmentation = Result['segmentation'];
type Painter = (segmentation: Segmentation, from: number, to: number) => Uint32Array<ArrayBuffer>;

export function mountOverlay(stage: HTMLElement, store: Store): void {
  const fill = find(stage, '#fill', HTMLCanvasElement);
  const outlines = find(stage, '#outlines', HTMLCanvasElement);
  const fillWork = new Piecewise(1 << 19, false);
  const outlineWork = new Piecewise(1 << 18, true);

  store.subscribe(({ result, look }, before) => {
    if (look.opacity !== before.look.opacity) fill.style.opacity = String(look.opacity);
    if (look.outlines !== before.look.outlines) outlines.hidden = !look.outlines;
    if (result === before.result && !repaints(look, before.look)) return;
    if (before.result === null && result !== null && !prefersStillness()) for (const canvas of [fill, outlines]) appear(canvas);
    paint(fill, fillWork, result, look, (segmentation, from, to) => fillOf(segmentation, look, from, to));
    paint(outlines, outlineWork, result, look, (segmentation, from, to) =>
      outlinesOf(segmentation, look, thicknessFor(segmentation), from, to),
    );
  });
  fill.style.opacity = String(store.get().look.opacity);
}

function appear(canvas: HTMLCanvasElement): void {
  canvas.animate([{ opacity: 0 }, { opacity: canvas.style.opacity || 1 }], { duration: APPEARING, easing: 'ease-out' });
}

/** Whether masks are drawn at their positions in the first frame. */
function inPlace(look: Look): boolean {
  return look.view !== 'second' || look.stabilised !== null;
}

/** The masks to draw, and whether they are where they were found. */
function masksFor({ segmentation, second }: Result, look: Look): { readonly segmentation: Segmentation; readonly moved: boolean } | null {
  if (inPlace(look)) return { segmentation, moved: false };
  if (second === undefined) return { segmentation, moved: true };
  return second === null ? null : { segmentation: second, moved: false };
}

function repaints(now: Look, before: Look): boolean {
  if (inPlace(now) !== inPlace(before)) return true;
  return (['kind', 'hidden', 'solo', 'colours'] as const).some((key) => now[key] !== before[key]);
}

function thicknessFor({ width, height }: { readonly width: number; readonly height: number }): number {
  return Math.max(1, Math.round(Math.max(width, height) / PIXELS_PER_OUTLINE));
}

function paint(canvas: HTMLCanvasElement, work: Piecewise, result: Result | null, look: Look, painter: Painter): void {
  const context = contextOf(canvas);
  const masks = result === null ? null : masksFor(result, look);
  if (masks === null) {
    work.stop();
    context.clearRect(0, 0, canvas.width, canvas.height);
    return;
  }
  const { segmentation, moved } = masks;
  const { width, height } = segmentation;
  if (canvas.width !== width || canvas.height !== height) {
    canvas.width = width;
    canvas.height = height;
  }
  if (!moved) {
    work.rows(width, height, (from, to) => {
      context.putImageData(imageOf(painter(segmentation, from, to), width), 0, from);
    });
    return;
  }
  const pixels = new Uint32Array(width * height);
  work.rows(
    width,
    height,
    (from, to) => pixels.set(painter(segmentation, from, to), from * width),
    () => {
      context.clearRect(0, 0, width, height);
      for (const motion of segmentation.motions) drawMoved(context, pixels, segmentation, motion);
    },
  );
}

function imageOf(pixels: Uint32Array<ArrayBuffer>, width: number): ImageData {
  return new ImageData(new Uint8ClampedArray(pixels.buffer), width);
}

/** Draws the pixels of one motion where it moves them. The largest motion is drawn first, so that the others cover it. */
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
  piece.getContext('2d')?.putImageData(imageOf(own, across), 0, 0);
  context.setTransform(transformOf(motion.matrix));
  context.drawImage(piece, left, top);
  context.resetTransform();
}
