//! Flow arrows over the picture.

import { strings } from '../common/strings.js';
import { type Arrow, arrowsOf } from '../drawing/arrows.js';
import { colourOfMask, isShown } from '../drawing/paint.js';
import { cssColour } from '../drawing/palette.js';
import { maskOf } from '../result/masks.js';
import type { State, Store } from '../state/state.js';
import { drawn, find } from './markup.js';

/** Arrows shorter than this are dots, pixels of the frame. */
const DOT = 0.5;

export function mountArrows(stage: HTMLElement, store: Store): void {
  const picture = find(stage, '#arrows', SVGSVGElement);
  const note = find(stage, '#magnified', HTMLElement);
  let waiting = 0;
  store.subscribe((now, before) => {
    if (now.look === before.look && now.result === before.result) return;
    // In a later task: masks and list come first.
    clearTimeout(waiting);
    waiting = window.setTimeout(() => draw(now));
  });
  const draw = ({ look, result }: State): void => {
    const seen = look.arrows && result !== null;
    picture.toggleAttribute('hidden', !seen);
    note.hidden = true;
    if (!seen) return picture.replaceChildren();
    const { segmentation } = result;
    const { arrows, magnified } = arrowsOf(segmentation);
    note.hidden = magnified === 1;
    note.textContent = strings.magnified(magnified);
    picture.setAttribute('viewBox', `-0.5 -0.5 ${segmentation.width} ${segmentation.height}`);
    const paths = segmentation.motions.map(({ label }) => {
      const mask = maskOf(label, segmentation, look.kind);
      const own = isShown(mask, look) ? arrows.filter((arrow) => arrow.label === label) : [];
      const d = own.map(pathOf).join('');
      return [
        drawn('path', { d, class: 'arrow-edge' }),
        drawn('path', { d, class: 'arrow', stroke: cssColour(mask === 0 ? [235, 238, 242] : colourOfMask(mask, look)) }),
      ];
    });
    picture.replaceChildren(...paths.flat());
  };
}

/** A line with two barbs, or a dot. */
function pathOf({ from: [x, y], to: [u, v] }: Arrow): string {
  const point = (px: number, py: number): string => `${px.toFixed(1)} ${py.toFixed(1)}`;
  const [dx, dy] = [u - x, v - y];
  const length = Math.hypot(dx, dy);
  if (length < DOT) return `M${point(x, y)}h0.01`;
  const barb = Math.min(0.35 * length, 5) / length;
  const [bx, by] = [dx * barb, dy * barb];
  return `M${point(x, y)}L${point(u, v)}M${point(u - bx - by * 0.7, v - by + bx * 0.7)}L${point(u, v)}L${point(u - bx + by * 0.7, v - by - bx * 0.7)}`;
}
