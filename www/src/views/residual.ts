//! The residual, drawn instead of the picture.

import { Piecewise } from '../drawing/piecewise.js';
import { residualOf } from '../drawing/residual.js';
import type { Store } from '../state/state.js';
import { contextOf, find } from './markup.js';

export function mountResidual(stage: HTMLElement, store: Store): void {
  const canvas = find(stage, '#residual', HTMLCanvasElement);
  const work = new Piecewise(1 << 16, true);
  store.subscribe(({ look, result }, before) => {
    if (look.residual === before.look.residual && result === before.result) return;
    // Objects of a clip need not have one motion.
    const seen = look.residual && look.kind !== 'objects';
    canvas.hidden = !seen || result === null;
    work.stop();
    if (!seen || result === null) return;
    const { segmentation, pair } = result;
    const { width, height } = segmentation;
    canvas.width = width;
    canvas.height = height;
    const context = contextOf(canvas);
    work.rows(width, height, (from, to) => {
      const pixels = residualOf(segmentation, pair.first, pair.second, from, to);
      context.putImageData(new ImageData(new Uint8ClampedArray(pixels.buffer), width), 0, from);
    });
  });
}
