//! The list of a clip's objects: colour, name and life of each, with its actions. It is the same in every frame.

import { nameOf } from '../common/naming.js';
import { strings } from '../common/strings.js';
import { colourOfMask, isShown } from '../drawing/paint.js';
import { colourFromHex, cssColour, hexColour } from '../drawing/palette.js';
import { UNLABELLED } from '../result/masks.js';
import type { Session } from '../session/session.js';
import type { State, Store } from '../state/state.js';
import { type Life, livesOf } from '../state/tracked.js';
import { find } from './markup.js';
import { chooseTool } from './tools.js';

/** Updates one row; `ids` are the numbers of all. */
type Refresh = (now: State, life: Life | null, ids: readonly number[]) => void;

export function mountObjects(root: ParentNode, store: Store, session: Session): void {
  const list = find(root, '#objects', HTMLOListElement);
  const template = find(root, '#object-row', HTMLTemplateElement);
  const add = find(root, '#add-object', HTMLButtonElement);
  let rows: Refresh[] = [];
  let listed = '';
  add.addEventListener('click', () => {
    if (session.tracking.addObject()) chooseTool(store, 'brush');
  });

  store.subscribe((now, before) => {
    const { tracked, look, result } = now;
    if (tracked === before.tracked && look === before.look && result === before.result) return;
    list.hidden = look.kind !== 'objects' || tracked === null;
    if (tracked === null) return;
    add.hidden = list.hidden;
    add.disabled = tracked.state === null;
    if (list.hidden) return;
    const lives = livesOf(tracked);
    const ids = [0, ...lives.map(({ id }) => id)];
    // A new object that is selected but not painted yet.
    if (look.selected !== null && look.selected > tracked.largest && look.selected !== UNLABELLED) ids.push(look.selected);
    if (ids.join() !== listed) {
      listed = ids.join();
      const held = document.activeElement?.closest<HTMLElement>('#objects > li')?.dataset.mask;
      list.replaceChildren();
      rows = ids.map((id) => {
        const row = find(document.importNode(template.content, true), 'li', HTMLElement);
        list.append(row);
        return wire(row, id, store, session);
      });
      list.querySelector<HTMLElement>(`[data-mask="${held}"] .motion-name`)?.focus({ preventScroll: true });
    }
    for (const [k, refresh] of rows.entries()) refresh(now, lives.find(({ id }) => id === ids[k]) ?? null, ids);
  });
}

/** Connects the controls of a row to the state. */
function wire(row: HTMLElement, id: number, store: Store, session: Session): Refresh {
  row.dataset.mask = String(id);
  const shown = find(row, '[data-action=show]', HTMLInputElement);
  const colour = find(row, '[data-action=colour]', HTMLInputElement);
  const name = find(row, '.motion-name', HTMLInputElement);
  const share = find(row, '.motion-share', HTMLElement);
  const facts = find(row, '.motion-facts', HTMLElement);
  const solo = find(row, '[data-action=solo]', HTMLButtonElement);
  const doubtful = find(row, '[data-action=doubtful]', HTMLButtonElement);
  const merge = find(row, '[data-action=merge]', HTMLSelectElement);
  const split = find(row, '[data-action=split]', HTMLButtonElement);
  const remove = find(row, '[data-action=remove]', HTMLButtonElement);

  shown.addEventListener('change', () => {
    const hidden = new Set(store.get().look.hidden);
    if (shown.checked) hidden.delete(id);
    else hidden.add(id);
    store.look({ hidden, solo: null });
  });
  colour.addEventListener('input', () => session.tracking.setAppearance(id, { colour: colourFromHex(colour.value) }));
  name.addEventListener('change', () => session.tracking.setAppearance(id, { name: name.value.trim() }));
  name.addEventListener('keydown', (event) => {
    if (event.key === 'Enter') name.blur();
  });
  solo.addEventListener('click', () => store.look({ solo: store.get().look.solo === id ? null : id }));
  doubtful.addEventListener('click', () => void session.goTo(Number(doubtful.dataset.frame)));
  merge.addEventListener('change', () => session.tracking.merge(id, Number(merge.value)));
  split.addEventListener('click', () => session.tracking.split(id));
  remove.addEventListener('click', () => session.tracking.remove(id));
  row.addEventListener('focusin', () => session.select(id));
  row.addEventListener('pointerdown', () => session.select(id));
  // The background cannot be hidden: it is not painted.
  for (const control of [shown, colour, find(row, '.motion-actions', HTMLElement)]) control.hidden = id === 0;

  return ({ look, result, tracked }, life, ids) => {
    const called = nameOf(look, id);
    const own = colourOfMask(id, look);
    const here = result?.segmentation.motions.find(({ label }) => label === id);
    row.style.setProperty('--colour', cssColour(own));
    row.classList.toggle('selected', look.selected === id);
    if (document.activeElement !== name) name.value = called;
    name.setAttribute('aria-label', strings.nameOf(called));
    share.textContent = here === undefined ? '' : strings.percent(here.share);
    if (id === 0) return;
    facts.textContent = factsOf(life, here === undefined && result !== null);
    const ready = life !== null && tracked !== null && tracked.state !== null;
    for (const control of [merge, split, remove]) control.disabled = !ready;
    const others = ids.filter((other) => other !== 0 && other !== id).map((other) => new Option(nameOf(look, other), String(other)));
    // Options that stay are left alone: their list may be open.
    if (others.map(({ text, value }) => `${value} ${text}`).join() !== [...merge.options].slice(1).map(({ text, value }) => `${value} ${text}`).join() || merge.options.length === 0) {
      merge.replaceChildren(new Option(strings.mergeWith, ''), ...others);
    }
    merge.hidden = merge.options.length < 2;
    colour.value = hexColour(own);
    shown.checked = isShown(id, look);
    row.classList.toggle('away', !shown.checked);
    solo.setAttribute('aria-pressed', String(look.solo === id));
    doubtful.hidden = life === null;
    if (life !== null) {
      doubtful.dataset.frame = String(life.doubtful.index);
      doubtful.textContent = strings.doubtful(life.doubtful.index);
      doubtful.setAttribute('aria-label', strings.doubtfulOf(called, life.doubtful.index));
    }
    merge.setAttribute('aria-label', strings.mergeOf(called));
    split.setAttribute('aria-label', strings.splitOf(called));
    remove.setAttribute('aria-label', strings.removeOf(called));
    shown.setAttribute('aria-label', strings.show(called));
    colour.setAttribute('aria-label', strings.colourOf(called));
    solo.setAttribute('aria-label', strings.soloOf(called));
  };
}

function factsOf(life: Life | null, away: boolean): string {
  if (life === null) return strings.newObjectHelp;
  const lives = strings.life(life.first, life.last);
  return away ? `${lives} · ${strings.away}` : lives;
}
