//! A row of the list of masks: what the masks of a pair and the objects of a clip have in common.

import { nameOf } from '../common/naming.js';
import { strings } from '../common/strings.js';
import { colourOfMask, isShown } from '../drawing/paint.js';
import { cssColour, hexColour } from '../drawing/palette.js';
import type { Session } from '../session/session.js';
import type { Look, Store } from '../state/state.js';
import { find } from './markup.js';

interface MaskRow {
  readonly element: HTMLElement;
  /** Shows the state. */
  readonly refresh: (look: Look) => void;
}

/** A new row for a mask, connected to the state. */
export function maskRow(of: 'pair' | 'clip', id: number, store: Store, session: Session): MaskRow {
  const template = find(document, '#mask-row', HTMLTemplateElement);
  const row = find(document.importNode(template.content, true), 'li', HTMLElement);
  for (const part of row.querySelectorAll(`[data-of]:not([data-of=${of}])`)) part.remove();
  row.dataset.mask = String(id);
  const shown = find(row, '[data-action=show]', HTMLInputElement);
  const colour = find(row, '[data-action=colour]', HTMLInputElement);
  const name = find(row, '.motion-name', HTMLInputElement);
  const solo = find(row, '[data-action=solo]', HTMLButtonElement);

  shown.addEventListener('change', () => {
    const hidden = new Set(store.get().look.hidden);
    if (shown.checked) hidden.delete(id);
    else hidden.add(id);
    store.look({ hidden, solo: null });
  });
  colour.disabled = of === 'pair';
  if (of === 'pair') name.removeAttribute('title');
  solo.addEventListener('click', () => store.look({ solo: store.get().look.solo === id ? null : id }));
  // A row that is selected has its actions elsewhere, and another one that was loses its own: nothing may move away from a pointer that is down.
  let pressed = false;
  const select = ({ target }: Event): void => {
    if (!pressed && (!(target instanceof Element) || target.closest('.motion-actions') === null)) session.shown.select(id);
  };
  row.addEventListener('pointerdown', () => {
    pressed = true;
    for (const end of ['pointerup', 'pointercancel']) window.addEventListener(end, () => (pressed = false), { once: true, capture: true });
  });
  row.addEventListener('focusin', select);
  // At once, because a key may come next; a box that was clicked has to change before.
  row.addEventListener('click', (event) => {
    const isBox = event.target instanceof HTMLInputElement && event.target.type === 'checkbox';
    return isBox ? void setTimeout(() => select(event)) : select(event);
  });
  // The background cannot be hidden: it is not painted.
  for (const control of [shown, colour, solo, find(row, '.thumbnail', HTMLCanvasElement)]) control.hidden = id === 0;

  const refresh = (look: Look): void => {
    const called = nameOf(look, id);
    const own = colourOfMask(id, look);
    row.style.setProperty('--colour', cssColour(own));
    colour.value = hexColour(own);
    if (name.readOnly) name.value = called;
    shown.checked = isShown(id, look);
    row.classList.toggle('away', !shown.checked);
    row.classList.toggle('selected', look.selected === id);
    solo.setAttribute('aria-pressed', String(look.solo === id));
    shown.setAttribute('aria-label', strings.show(called));
    colour.setAttribute('aria-label', strings.colourOf(called));
    name.setAttribute('aria-label', strings.nameOf(called));
    solo.setAttribute('aria-label', strings.soloOf(called));
  };
  return { element: row, refresh };
}

/** The name that was pressed last. A second press is about it, though its row may have moved since it is selected. */
let pressedName: HTMLInputElement | null = null;
const isSecond = (event: MouseEvent): boolean => {
  const again = event.detail === 2 && pressedName !== null && pressedName.isConnected && pressedName.readOnly;
  if (again) {
    event.preventDefault();
    event.stopPropagation();
  }
  return again;
};
document.addEventListener('mousedown', (event) => {
  if (isSecond(event)) return;
  pressedName = event.target instanceof HTMLInputElement && event.target.matches('.motion-name') ? event.target : null;
}, true);
document.addEventListener('click', (event) => {
  if (isSecond(event)) rename(pressedName!);
}, true);

/** Lets a person change the name of an object, which a click only selects. */
export function rename(name: HTMLInputElement): void {
  const row = name.closest<HTMLElement>('#objects > li');
  // The background has no name of its own.
  if (row === null || row.dataset.mask === '0') return;
  name.readOnly = false;
  name.focus();
  name.select();
}

/** Lets a person change the name of the mask that is selected. */
export function renameSelected(): void {
  const name = document.querySelector<HTMLInputElement>('#objects:not([hidden], [inert]) .selected .motion-name');
  if (name !== null) rename(name);
}

/** The mask whose row has the focus. */
export function heldRow(list: HTMLElement): number | null {
  const row = list.contains(document.activeElement) ? document.activeElement!.closest<HTMLElement>('[data-mask]') : null;
  return row === null ? null : Number(row.dataset.mask);
}

/** Gives the focus back to a list that was made anew: to the row that had it, or if that is gone, to the selected one. */
export function focusRow(list: HTMLElement, held: number, { selected }: Look): void {
  const summaryOf = (id: number | null): HTMLElement | null => list.querySelector(`[data-mask="${id}"] summary`);
  (summaryOf(held) ?? summaryOf(selected))?.focus({ preventScroll: true });
}
