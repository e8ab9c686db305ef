//! The masks over the picture: a canvas of fills, with the opacity, and a canvas of outlines. Large frames are painted in pieces, so that the
//! page stays responsive.

import { type Painting, fillOf, outlinesOf } from '../drawing/paint.js';
import { Piecewise } from '../drawing/piecewise.js';
import type { Labels } from '../result/masks.js';
import type { State, Store } from '../state/state.js';
import { contextOf, find, prefersStillness } from './markup.js';

/** Outlines are one pixel thick for every so many pixels of the longer side. */
const PIXELS_PER_OUTLINE = 400;

/** How long masks take to appear where there were none, milliseconds. */
const APPEARING = 350;

/** Motions have the colours of their numbers, and are all shown. */
const MOTIONS: Painting = { hidden: new Set(), solo: null, colours: {} };

type Painter = (masks: Labels, from: number, to: number) => Uint32Array<ArrayBuffer>;

export function mountOverlay(stage: HTMLElement, store: Store): void {
  const fill = find(stage, '#fill', HTMLCanvasElement);
  const outlines = find(stage, '#outlines', HTMLCanvasElement);
  const fillWork = new Piecewise(1 << 19, false);
  const outlineWork = new Piecewise(1 << 18, true);

  store.subscribe((now, before) => {
    const { result, look } = now;
    if (look.opacity !== before.look.opacity) fill.style.opacity = String(look.opacity);
    if (look.outlines !== before.look.outlines) outlines.hidden = !look.outlines;
    const masks = masksSeen(now);
    const repaints = (['hidden', 'solo', 'colours', 'motions'] as const).some((key) => look[key] !== before.look[key]);
    if (masks === masksSeen(before) && !repaints) return;
    if (before.result === null && result !== null && !prefersStillness()) for (const canvas of [fill, outlines]) appear(canvas);
    const painting = look.motions ? MOTIONS : look;
    paint(fill, fillWork, masks, (...rows) => fillOf(rows[0], painting, rows[1], rows[2]));
    paint(outlines, outlineWork, masks, (...rows) => outlinesOf(rows[0], painting, thicknessFor(rows[0]), rows[1], rows[2]));
  });
  fill.style.opacity = String(store.get().look.opacity);
}

function appear(canvas: HTMLCanvasElement): void {
  canvas.animate([{ opacity: 0 }, { opacity: canvas.style.opacity || 1 }], { duration: APPEARING, easing: 'ease-out' });
}

/** The masks of the frame that is seen: of motions those of the first. */
function masksSeen({ result, look, inspected }: State): Labels | null {
  const isSecond = look.view === 'second';
  if (look.motions) return isSecond ? null : (inspected?.segmentation ?? null);
  return (isSecond ? result?.second : result?.masks) ?? null;
}

function thicknessFor({ width, height }: { readonly width: number; readonly height: number }): number {
  return Math.max(1, Math.round(Math.max(width, height) / PIXELS_PER_OUTLINE));
}

function paint(canvas: HTMLCanvasElement, work: Piecewise, masks: Labels | null, painter: Painter): void {
  const context = contextOf(canvas);
  if (masks === null) {
    work.stop();
    context.clearRect(0, 0, canvas.width, canvas.height);
    return;
  }
  const { width, height } = masks;
  if (canvas.width !== width || canvas.height !== height) {
    canvas.width = width;
    canvas.height = height;
  }
  work.rows(width, height, (from, to) => {
    context.putImageData(new ImageData(new Uint8ClampedArray(painter(masks, from, to).buffer), width), 0, from);
  });
}
