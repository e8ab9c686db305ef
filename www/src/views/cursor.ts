//! The name and the colour of what a tool draws with, beside the pointer.

import { nameOf } from '../common/naming.js';
import { strings } from '../common/strings.js';
import { colourOfMask } from '../drawing/paint.js';
import { cssColour } from '../drawing/palette.js';
import type { State, Store } from '../state/state.js';
import { find } from './markup.js';
import { pointingIn } from './pointing.js';

/** From this share of the picture on, the name is on the other side of the pointer. */
const RIGHT = 0.75;

export function mountCursor(layers: HTMLElement, store: Store): void {
  const tag = find(layers, '#cursor', HTMLElement);
  let isOver = false;
  const show = (): void => void (tag.hidden = !isOver || tag.textContent === '');
  const follow = ({ clientX, clientY, pointerType }: PointerEvent): void => {
    const { left, top, width } = layers.getBoundingClientRect();
    // A finger would hide it.
    isOver = pointerType !== 'touch';
    show();
    tag.style.left = `${clientX - left}px`;
    tag.style.top = `${clientY - top}px`;
    tag.classList.toggle('before', clientX - left > RIGHT * width);
  };
  layers.addEventListener('pointermove', follow);
  // Where the picture comes under a pointer that rests, nothing moves.
  layers.addEventListener('pointerenter', follow);
  layers.addEventListener('pointerleave', () => {
    isOver = false;
    show();
  });
  const render = (now: State): void => {
    const { look, tool, result } = now;
    const isNew = tool.name === 'box' && pointingIn(now) === 'new';
    tag.textContent = tool.name === 'look' || result === null ? '' : isNew ? strings.newObject : look.selected === null ? '' : nameOf(look, look.selected);
    show();
    tag.classList.toggle('removes', removes(now));
    tag.style.setProperty('--colour', isNew || look.selected === null ? 'transparent' : cssColour(colourOfMask(look.selected, look)));
  };
  store.subscribe((now, before) => {
    if ((['look', 'tool', 'result', 'tracked'] as const).some((part) => now[part] !== before[part])) render(now);
  });
  render(store.get());
}

/** Whether what is drawn is taken away from what is selected. */
function removes(state: State): boolean {
  const { tool } = state;
  return tool.name === 'eraser' || (tool.name === 'box' && pointingIn(state) === 'remove');
}
