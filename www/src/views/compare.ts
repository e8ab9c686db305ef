//! The split view: the first frame with its masks on the left, the second on the right, and a movable line between them.

import { inPicture } from '../drawing/viewport.js';
import type { Store } from '../state/state.js';
import { find } from './markup.js';

export function mountCompare(stage: HTMLElement, store: Store): void {
  const layers = find(stage, '.layers', HTMLElement);
  const line = find(stage, '#divide', HTMLInputElement);
  line.addEventListener('input', () => store.look({ divide: line.valueAsNumber / 1000 }));
  // Moving the line is not a press on the picture.
  line.addEventListener('pointerdown', (event) => event.stopPropagation());
  store.subscribe(({ look, viewport, pair }, before) => {
    if (look === before.look && viewport === before.viewport && pair === before.pair) return;
    const split = look.view === 'split' && pair.second !== null;
    line.hidden = !split;
    layers.classList.toggle('split', split);
    if (!split) return;
    line.value = String(Math.round(look.divide * 1000));
    const [x] = inPicture(viewport, [look.divide, 0]);
    stage.style.setProperty('--divide', `${(100 * x).toFixed(3)}%`);
    stage.style.setProperty('--line', `${(100 * look.divide).toFixed(3)}%`);
  });
}
