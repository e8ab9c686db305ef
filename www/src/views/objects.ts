//! The list of a clip's objects: colour, name and life of each, with its actions. It is the same in every frame.

import { nameOf } from '../common/naming.js';
import { strings } from '../common/strings.js';
import { colourOfMask, isShown } from '../drawing/paint.js';
import { colourFromHex, cssColour, hexColour } from '../drawing/palette.js';
import type { Session } from '../session/session.js';
import type { State, Store } from '../state/state.js';
import { type Life, livesOf } from '../state/tracked.js';
import { find } from './markup.js';

/** Updates one row. */
type Refresh = (now: State) => void;

export function mountObjects(root: ParentNode, store: Store, session: Session): void {
  const list = find(root, '#objects', HTMLOListElement);
  const template = find(root, '#object-row', HTMLTemplateElement);
  let rows: Refresh[] = [];

  store.subscribe((now, before) => {
    const { tracked, look, result } = now;
    if (tracked?.frames === before.tracked?.frames && look === before.look && result === before.result) return;
    list.hidden = look.kind !== 'objects' || tracked === null;
    if (tracked === null) return;
    if (tracked.frames !== before.tracked?.frames) {
      list.replaceChildren();
      rows = [null, ...livesOf(tracked)].map((life) => {
        const row = find(document.importNode(template.content, true), 'li', HTMLElement);
        list.append(row);
        return wire(row, life, store, session);
      });
    }
    if (!list.hidden) for (const refresh of rows) refresh(now);
  });
}

/** Connects the controls of a row to the state; `life` is `null` for the background. */
function wire(row: HTMLElement, life: Life | null, store: Store, session: Session): Refresh {
  const id = life?.id ?? 0;
  row.dataset.mask = String(id);
  const shown = find(row, '[data-action=show]', HTMLInputElement);
  const colour = find(row, '[data-action=colour]', HTMLInputElement);
  const name = find(row, '.motion-name', HTMLInputElement);
  const share = find(row, '.motion-share', HTMLElement);
  const facts = find(row, '.motion-facts', HTMLElement);
  const solo = find(row, '[data-action=solo]', HTMLButtonElement);
  const doubtful = find(row, '[data-action=doubtful]', HTMLButtonElement);

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
  doubtful.addEventListener('click', () => {
    if (life !== null) void session.goTo(life.doubtful.index);
  });
  row.addEventListener('focusin', () => session.select(id));
  row.addEventListener('pointerdown', () => session.select(id));
  // The background cannot be hidden: it is not painted.
  for (const control of [shown, colour, find(row, '.motion-actions', HTMLElement)]) control.hidden = life === null;

  return ({ look, result }) => {
    const called = nameOf(look, id);
    const own = colourOfMask(id, look);
    const here = result?.segmentation.motions.find(({ label }) => label === id);
    row.style.setProperty('--colour', cssColour(own));
    row.classList.toggle('selected', look.selected === id);
    if (document.activeElement !== name) name.value = called;
    name.setAttribute('aria-label', strings.nameOf(called));
    share.textContent = here === undefined ? '' : strings.percent(here.share);
    if (life === null) return;
    const lives = strings.life(life.first, life.last);
    facts.textContent = here === undefined && result !== null ? `${lives} · ${strings.away}` : lives;
    colour.value = hexColour(own);
    shown.checked = isShown(id, look);
    row.classList.toggle('away', !shown.checked);
    solo.setAttribute('aria-pressed', String(look.solo === id));
    doubtful.textContent = strings.doubtful(life.doubtful.index);
    doubtful.setAttribute('aria-label', strings.doubtfulOf(called, life.doubtful.index));
    shown.setAttribute('aria-label', strings.show(called));
    colour.setAttribute('aria-label', strings.colourOf(called));
    solo.setAttribute('aria-label', strings.soloOf(called));
  };
}
