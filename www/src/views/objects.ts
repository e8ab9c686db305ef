//! The list of a clip's objects: colour, name and life of each, with its actions. It is the same in every frame.

import { nameOf } from '../common/naming.js';
import { strings } from '../common/strings.js';
import { colourFromHex } from '../drawing/palette.js';
import type { Session } from '../session/session.js';
import type { Look, Result, State, Store } from '../state/state.js';
import { type Life, isDrafting, isObject, isReady, isSeen, livesOf, lockedIn, shownFrames } from '../state/tracked.js';
import { find } from './markup.js';
import { focusRow, heldRow, maskRow, rename } from './mask-row.js';
import { drawThumbnail } from './thumbnail.js';
import { chooseTool } from './tools.js';

interface Row {
  readonly element: HTMLElement;
  /** Shows the state; `ids` are the numbers of all. */
  readonly refresh: (now: State, life: Life | null, ids: readonly number[]) => void;
}

export function mountObjects(root: ParentNode, store: Store, session: Session): void {
  const list = find(root, '#objects', HTMLOListElement);
  const foot = find(root, '#list-foot', HTMLElement);
  const add = find(foot, '#add-object', HTMLButtonElement);
  const empty = find(root, '#motions-empty', HTMLElement);
  const rows = new Map<number, Row>();
  add.addEventListener('click', () => {
    if (session.objects.addObject()) chooseTool(store, 'brush');
  });

  store.subscribe((now, before) => {
    const { tracked, look, result, live } = now;
    if (tracked === before.tracked && live === before.live && look === before.look && result === before.result) return;
    list.hidden = !isSeen(tracked);
    empty.hidden = !list.hidden;
    empty.textContent = live === null ? strings.noMasksYet : strings.liveMasks(result?.second?.objects.length ?? 0);
    if (tracked === null) return;
    foot.hidden = list.hidden;
    add.disabled = !isReady(tracked);
    if (list.hidden) return;
    const lives = livesOf({ frames: shownFrames(tracked) });
    list.inert = isDrafting(tracked);
    const ids = [0, ...lives.map(({ id }) => id)];
    // A new object that is selected but not painted yet.
    if (look.selected !== null && isObject(look.selected) && !tracked.objects.some(({ number }) => number === look.selected)) ids.push(look.selected);
    // Rows that stay are left alone: a press may have begun in one, or a name be typed.
    const held = heldRow(list);
    for (const [id, { element }] of rows) {
      if (ids.includes(id)) continue;
      element.remove();
      rows.delete(id);
    }
    for (const [k, id] of ids.entries()) {
      const row = rows.get(id) ?? rowOf(id, store, session);
      rows.set(id, row);
      if (list.children[k] !== row.element) list.insertBefore(row.element, list.children[k] ?? null);
      row.refresh(now, lives.find((life) => life.id === id) ?? null, ids);
    }
    if (held !== null && !rows.has(held)) focusRow(list, held, look);
    if (look.selected !== before.look.selected) scrollTo(list, rows.get(look.selected ?? -1)?.element);
  });
}

/** Scrolls a list that scrolls by itself, and nothing around it, until a row is in sight. */
function scrollTo(list: HTMLElement, row: HTMLElement | undefined): void {
  if (row === undefined) return;
  const [inner, outer] = [row.getBoundingClientRect(), list.getBoundingClientRect()];
  if (inner.top < outer.top || inner.height > outer.height) list.scrollTop += inner.top - outer.top;
  else if (inner.bottom > outer.bottom) list.scrollTop += inner.bottom - outer.bottom;
}

/** Connects what only objects of a clip have: their life, and what becomes of them in all frames. */
function rowOf(id: number, store: Store, session: Session): Row {
  const { element: row, refresh } = maskRow('clip', id, store, session);
  const share = find(row, '.motion-share', HTMLElement);
  const facts = find(row, '.motion-facts', HTMLElement);
  const thumbnail = find(row, '.thumbnail', HTMLCanvasElement);
  let drawn: Result | null = null;
  const doubtful = find(row, '[data-action=doubtful]', HTMLButtonElement);
  const lock = find(row, '[data-action=lock]', HTMLButtonElement);
  const split = find(row, '[data-action=split]', HTMLButtonElement);
  const remove = find(row, '[data-action=remove]', HTMLButtonElement);
  const mergeWith = find(row, '[data-action=merge-with]', HTMLSelectElement);
  const merge = find(row, '[data-action=merge]', HTMLButtonElement);
  mountAppearance(row, id, store, session);
  // A select changes with every arrow key, so it only chooses.
  mergeWith.addEventListener('change', () => (merge.disabled = mergeWith.value === ''));
  merge.addEventListener('click', () => session.objects.merge(id, Number(mergeWith.value)));
  doubtful.addEventListener('click', () => {
    session.frames.goToDoubtful(id);
    find(document, '.layers', HTMLElement).focus({ preventScroll: true }); // the button has gone
  });
  lock.addEventListener('click', () => session.objects.toggleLock(id));
  split.addEventListener('click', () => session.objects.split(id));
  remove.addEventListener('click', () => session.objects.remove(id));
  const others = (): number[] => livesOf(store.get().tracked ?? { frames: [] }).map((life) => life.id).filter((other) => other !== id);
  const aboutOthers = (['lock', 'hide', 'remove'] as const).map((what) => ({ what, button: find(row, `[data-action=${what}-others]`, HTMLButtonElement) }));
  for (const { what, button } of aboutOthers) {
    button.addEventListener('click', () => {
      if (what === 'lock') session.objects.toggleLock(...others());
      else if (what === 'remove') session.objects.remove(...others());
      else store.look({ hidden: new Set(others()), solo: null });
    });
  }
  find(row, '.motion-actions', HTMLElement).hidden = id === 0;

  const refreshAll: Row['refresh'] = ({ look, result, tracked }, life, ids) => {
    refresh(look);
    const called = nameOf(look, id);
    const here = result?.masks.objects.find((object) => object.id === id);
    const pixels = id === 0 ? result?.masks.rest : here?.pixels;
    share.textContent = result === null || pixels === undefined ? '' : strings.percent(pixels / result.masks.labels.length);
    if (id === 0) return;
    // Where it is not in sight, it looks as it did.
    if (result !== null && result !== drawn && here !== undefined) drawThumbnail(thumbnail, (drawn = result).frame, here.bbox);
    facts.textContent = factsOf(life, here === undefined && result !== null);
    const ready = life !== null && isReady(tracked);
    for (const control of [lock, split, remove]) control.disabled = !ready;
    const alone = !ids.some((other) => other !== 0 && other !== id);
    for (const { what, button } of aboutOthers) {
      button.disabled = alone || (!ready && what !== 'hide');
      button.setAttribute('aria-label', strings.othersOf(button.textContent, called));
    }
    lock.setAttribute('aria-pressed', String(tracked !== null && lockedIn(tracked).has(id)));
    lock.setAttribute('aria-label', strings.lockOf(called));
    offerMerging(row, ids.filter((other) => other !== 0 && other !== id), look, ready);
    doubtful.hidden = life === null || tracked?.checked.get(id) === life.doubtful.index;
    if (life !== null) {
      doubtful.textContent = strings.doubtful(life.doubtful.index);
      doubtful.ariaLabel = doubtful.title = strings.doubtfulOf(called, life.doubtful.index);
    }
    mergeWith.setAttribute('aria-label', strings.mergeWithOf(called));
    merge.setAttribute('aria-label', strings.mergeOf(called));
    split.setAttribute('aria-label', strings.splitOf(called));
    remove.setAttribute('aria-label', strings.removeOf(called));
  };
  return { element: row, refresh: refreshAll };
}

function factsOf(life: Life | null, away: boolean): string {
  if (life === null) return strings.newObjectHelp;
  const lives = strings.life(life.first, life.last);
  return away ? `${lives} · ${strings.away}` : lives;
}

/** Connects the colour and the name, which a person can change. */
function mountAppearance(row: HTMLElement, id: number, store: Store, session: Session): void {
  const colour = find(row, '[data-action=colour]', HTMLInputElement);
  const name = find(row, '.motion-name', HTMLInputElement);
  let picking = false;
  colour.addEventListener('input', () => {
    session.objects.setAppearance(id, { colour: colourFromHex(colour.value) }, picking);
    picking = true;
  });
  colour.addEventListener('change', () => (picking = false));
  name.addEventListener('change', () => session.objects.setAppearance(id, { name: name.value.trim() }));
  name.addEventListener('blur', () => (name.readOnly = true));
  name.addEventListener('keydown', (event) => {
    if (event.key === 'Enter' && name.readOnly) return rename(name);
    if (event.key === 'Escape' && !name.readOnly) name.value = nameOf(store.get().look, id);
    else if (event.key !== 'Enter') return;
    name.blur();
  });
}

/** Lists the objects that this one can be merged with. Options that stay are left alone: their list may be open, or one chosen. */
function offerMerging(row: HTMLElement, others: readonly number[], look: Look, ready: boolean): void {
  const merge = find(row, '[data-action=merge-with]', HTMLSelectElement);
  const button = find(row, '[data-action=merge]', HTMLButtonElement);
  const offered = [new Option(strings.mergeWith, ''), ...others.map((id) => new Option(nameOf(look, id), String(id)))];
  const textOf = (options: Iterable<HTMLOptionElement>): string => Array.from(options, ({ text, value }) => `${value} ${text}`).join();
  if (textOf(offered) !== textOf(merge.options)) merge.replaceChildren(...offered);
  merge.disabled = !ready;
  button.disabled = !ready || merge.value === '';
  merge.hidden = button.hidden = others.length === 0;
}
