//! Onion skin: the outlines of a clip's objects in the frame before, dashed, and in the frame after, dotted.

import { unpacked } from '../result/runs.js';
import { contoursOf } from '../drawing/contours.js';
import { colourOfMask, isShown } from '../drawing/paint.js';
import { cssColour } from '../drawing/palette.js';
import { UNLABELLED } from '../result/masks.js';
import { type State, type Store, isPassing } from '../state/state.js';
import { drawn } from './markup.js';

const SIDES = [
  { by: -1, name: 'before' },
  { by: 1, name: 'after' },
] as const;

export function mountOnion(picture: SVGSVGElement, store: Store): void {
  let waiting = 0;
  const draw = ({ look, tracked, pair, ...now }: State): void => {
    const origin = pair.first?.origin;
    const at = origin !== undefined && origin.clip === tracked?.clip ? origin.index : NaN;
    const seen = look.onion && look.view !== 'second' && !isPassing(now);
    const paths = (seen ? SIDES : []).flatMap(({ by, name }) => {
      const runs = tracked?.frames[at + by]?.runs;
      if (runs === undefined) return [];
      picture.setAttribute('viewBox', `0 0 ${runs.width} ${runs.height}`);
      const contours = contoursOf(unpacked(runs), runs.width, runs.height, (label) => label !== 0 && label !== UNLABELLED && isShown(label, look));
      return [...contours].map(([label, d]) => drawn('path', { d, class: name, stroke: cssColour(colourOfMask(label, look)) }));
    });
    picture.replaceChildren(...paths);
  };
  const later = (): void => {
    // In a later task: masks and list come first.
    clearTimeout(waiting);
    waiting = window.setTimeout(() => draw(store.get()));
  };
  store.subscribe((now, before) => {
    const same = (['look', 'pair', 'playing', 'scrubbing'] as const).every((part) => now[part] === before[part]);
    if (!same || now.tracked?.frames !== before.tracked?.frames) later();
  });
  later();
}
