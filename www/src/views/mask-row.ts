//! A row of the list of masks: what the masks of a pair and the objects of a clip have in common.

import { nameOf } from '../common/naming.js';
import { strings } from '../common/strings.js';
import { colourOfMask, isShown } from '../drawing/paint.js';
import { colourFromHex, cssColour, hexColour } from '../drawing/palette.js';
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
  const merge = find(row, '[data-action=merge]', HTMLSelectElement);
  const masks = of === 'pair' ? session.correcting : session.tracking;

  shown.addEventListener('change', () => {
    const hidden = new Set(store.get().look.hidden);
    if (shown.checked) hidden.delete(id);
    else hidden.add(id);
    store.look({ hidden, solo: null });
  });
  colour.addEventListener('input', () => masks.setAppearance(id, { colour: colourFromHex(colour.value) }));
  name.addEventListener('change', () => masks.setAppearance(id, { name: name.value.trim() }));
  name.addEventListener('keydown', (event) => {
    if (event.key === 'Enter') name.blur();
  });
  solo.addEventListener('click', () => store.look({ solo: store.get().look.solo === id ? null : id }));
  merge.addEventListener('change', () => masks.merge(id, Number(merge.value)));
  row.addEventListener('focusin', () => session.select(id));
  row.addEventListener('pointerdown', () => session.select(id));
  // The background cannot be hidden: it is not painted.
  for (const control of [shown, colour, solo]) control.hidden = id === 0;

  const refresh = (look: Look): void => {
    const called = nameOf(look, id);
    const own = colourOfMask(id, look);
    row.style.setProperty('--colour', cssColour(own));
    colour.value = hexColour(own);
    if (document.activeElement !== name) name.value = called;
    shown.checked = isShown(id, look);
    row.classList.toggle('away', !shown.checked);
    row.classList.toggle('selected', look.selected === id);
    solo.setAttribute('aria-pressed', String(look.solo === id));
    shown.setAttribute('aria-label', strings.show(called));
    colour.setAttribute('aria-label', strings.colourOf(called));
    name.setAttribute('aria-label', strings.nameOf(called));
    solo.setAttribute('aria-label', strings.soloOf(called));
    merge.setAttribute('aria-label', strings.mergeOf(called));
  };
  return { element: row, refresh };
}

/** Lists the masks that this one can be merged with. Options that stay are left alone: their list may be open. */
export function offerMerging(row: HTMLElement, others: readonly number[], look: Look): void {
  const merge = find(row, '[data-action=merge]', HTMLSelectElement);
  const offered = [new Option(strings.mergeWith, ''), ...others.map((id) => new Option(nameOf(look, id), String(id)))];
  const said = (options: Iterable<HTMLOptionElement>): string => Array.from(options, ({ text, value }) => `${value} ${text}`).join();
  if (said(offered) !== said(merge.options)) merge.replaceChildren(...offered);
  merge.hidden = others.length === 0;
}
