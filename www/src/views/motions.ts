//! The list of masks: colour, name, share and motion of each, with its actions.

import { nameOf } from '../common/naming.js';
import { strings } from '../common/strings.js';
import { colourOfMask, isShown } from '../drawing/paint.js';
import { colourFromHex, cssColour, hexColour } from '../drawing/palette.js';
import { centreOf, partsOf, visibleParts } from '../result/describe.js';
import { UNLABELLED, type Mask, masksOf } from '../result/masks.js';
import { NOTATIONS } from '../result/matrices.js';
import { isMerged } from '../session/correcting.js';
import type { Session } from '../session/session.js';
import { type Look, type Result, type State, type Store, isAwaited } from '../state/state.js';
import { copyText } from './clipboard.js';
import { element, find } from './markup.js';

type Segmentation = Result['segmentation'];

/** Updates one row. */
type Refresh = (look: Look) => void;

export function mountMotions(root: ParentNode, store: Store, session: Session): void {
  const list = find(root, '#motions', HTMLOListElement);
  const empty = find(root, '#motions-empty', HTMLElement);
  const template = find(root, '#motion-row', HTMLTemplateElement);
  let rows: Refresh[] = [];

  store.subscribe((now, before) => {
    const { result, look, live, run } = now;
    const renamed = look.names !== before.look.names;
    const awaited = isAwaited(now);
    const other = result !== before.result || look.kind !== before.look.kind || live !== before.live || isAwaited(before);
    list.hidden = look.kind === 'objects';
    list.inert = awaited;
    list.ariaBusy = awaited ? 'true' : null;
    if (other || run.phase !== before.run.phase) {
      empty.hidden = look.kind === 'objects' || (live === null && (result !== null || (awaited && rows.length > 0)));
      empty.textContent = live === null ? whyNone(run) : strings.liveMasks(result?.segmentation.count ?? 0);
    }
    if (awaited) return;
    if (other) {
      const typed = typedName(list, before.look.kind);
      list.replaceChildren();
      rows = result === null || live !== null || look.kind === 'objects' ? [] : fillList(list, template, now, result.segmentation, store, session);
      if (result?.pair.first === before.result?.pair.first) typed?.(list, now);
    }
    if (other || look !== before.look) for (const refresh of rows) refresh(look);
    if (renamed && !other) for (const option of list.querySelectorAll('option[data-mask]')) nameOption(option, look);
  });
}

function whyNone({ phase }: State['run']): string {
  return phase === 'failed' || phase === 'cancelled' ? strings.noMasks[phase] : strings.noMasksYet;
}

/** Carries a name that is being typed over to the new list; `null` if none is. */
function typedName(list: HTMLElement, kind: Look['kind']): ((list: HTMLElement, now: State) => void) | null {
  const field = document.activeElement;
  if (!(field instanceof HTMLInputElement) || !field.matches('.motion-name') || !list.contains(field)) return null;
  const mask = field.closest<HTMLElement>('[data-mask]')?.dataset.mask;
  const { value, selectionStart, selectionEnd } = field;
  return (filled, { look }) => {
    const same = filled.querySelector<HTMLInputElement>(`[data-mask="${mask}"] .motion-name`);
    if (same === null || look.kind !== kind) return;
    same.focus({ preventScroll: true });
    same.value = value;
    same.setSelectionRange(selectionStart, selectionEnd);
  };
}

function fillList(list: HTMLElement, template: HTMLTemplateElement, { look }: State, segmentation: Segmentation, store: Store, session: Session): Refresh[] {
  const masks = masksOf(segmentation, look.kind);
  return masks.map((mask) => {
    const row = find(document.importNode(template.content, true), 'li', HTMLElement);
    row.style.setProperty('--share', String(mask.share));
    row.dataset.mask = String(mask.id);
    find(row, '.motion-share', HTMLElement).textContent = strings.percent(mask.share);
    const [main] = mask.motions;
    if (main === undefined) {
      find(row, '.motion-words', HTMLElement).textContent = strings.unknownWords;
      for (const selector of ['.motion-facts', '[data-action=stabilise]', '.more']) find(row, selector, HTMLElement).remove();
    } else {
      const [, , width, height] = main.bbox;
      const parts = visibleParts(partsOf(main.matrix, centreOf(segmentation, main.label)), Math.hypot(width, height) / 2);
      find(row, '.motion-words', HTMLElement).textContent = strings.motion(parts);
      find(row, '.motion-facts', HTMLElement).textContent = factsOf(mask, look, segmentation);
      fillMore(row, mask, masks, store, session);
    }
    list.append(row);
    return wire(row, mask, store, session);
  });
}

function factsOf({ id, motions }: Mask, { kind }: Look, { motions: all }: Segmentation): string {
  const facts = [strings.residual(motions[0]!.residual)];
  if (kind === 'groups' && motions.length > 1) facts.push(strings.severalMotions(motions.length));
  const fellows = all.filter(({ group, label }) => group === motions[0]!.group && label !== id);
  if (kind === 'motions' && fellows.length > 0) facts.push(strings.groupWith(fellows.map(({ label }) => label)));
  return facts.join(' · ');
}

/** Connects the controls of a row to the state. */
function wire(row: HTMLElement, { id }: Mask, store: Store, session: Session): Refresh {
  const shown = find(row, '[data-action=show]', HTMLInputElement);
  const colour = find(row, '[data-action=colour]', HTMLInputElement);
  const name = find(row, '.motion-name', HTMLInputElement);
  const solo = find(row, '[data-action=solo]', HTMLButtonElement);
  const stabilise = row.querySelector<HTMLButtonElement>('[data-action=stabilise]');

  shown.addEventListener('change', () => {
    const { look } = store.get();
    const hidden = new Set(look.hidden);
    if (shown.checked) hidden.delete(id);
    else hidden.add(id);
    store.look({ hidden, solo: null });
  });
  colour.addEventListener('input', () => {
    session.correcting.setAppearance(id, { colour: colourFromHex(colour.value) });
  });
  name.addEventListener('change', () => {
    session.correcting.setAppearance(id, { name: name.value.trim() });
  });
  name.addEventListener('keydown', (event) => {
    if (event.key === 'Enter') name.blur();
  });
  solo.addEventListener('click', () => store.look({ solo: store.get().look.solo === id ? null : id }));
  stabilise?.addEventListener('click', () => toggleStabilised(store, id));
  row.addEventListener('focusin', () => session.select(id));
  row.addEventListener('pointerdown', () => session.select(id));
  // The background cannot be hidden: it is not painted.
  for (const control of [shown, colour, solo]) control.hidden = id === 0;

  return (look) => {
    const called = nameOf(look, id);
    const own = colourOfMask(id, look);
    row.style.setProperty('--colour', cssColour(own));
    colour.value = hexColour(own);
    if (document.activeElement !== name) name.value = called;
    shown.checked = isShown(id, look);
    row.classList.toggle('away', !shown.checked);
    row.classList.toggle('selected', look.selected === id);
    solo.setAttribute('aria-pressed', String(look.solo === id));
    stabilise?.setAttribute('aria-pressed', String(look.stabilised === id));
    shown.setAttribute('aria-label', strings.show(called));
    colour.setAttribute('aria-label', strings.colourOf(called));
    name.setAttribute('aria-label', strings.nameOf(called));
    solo.setAttribute('aria-label', strings.soloOf(called));
    stabilise?.setAttribute('aria-label', strings.stabiliseOf(called));
  };
}

/** Alternates between the first frame and the second warped back by the mask's motion: what stays in place belongs to the mask. */
export function toggleStabilised(store: Store, id: number): void {
  const { look } = store.get();
  if (look.stabilised === id) store.look({ stabilised: null, blinking: false, view: 'first' });
  else store.look({ stabilised: id, view: look.view === 'split' ? 'split' : 'second', blinking: look.view !== 'split' && !matchMedia('(prefers-reduced-motion: reduce)').matches });
}

/** Fills in the matrix, the buttons that copy it, and the masks to merge with. */
function fillMore(row: HTMLElement, mask: Mask, masks: readonly Mask[], store: Store, session: Session): void {
  const matrix = mask.motions[0]!.matrix;
  const body = find(row, 'tbody', HTMLElement);
  for (const entries of [matrix.slice(0, 3), matrix.slice(3, 6)]) {
    const line = element('tr');
    for (const entry of entries) line.insertCell().textContent = strings.entry(entry);
    body.append(line);
  }
  const copies = find(row, '.copies', HTMLElement);
  for (const { title, write } of NOTATIONS) {
    const button = element('button', title, 'button small quiet');
    button.type = 'button';
    button.addEventListener('click', () => copyText(write(matrix), strings.copied(title, nameOf(store.get().look, mask.id)), session));
    copies.append(button);
  }
  const merge = find(row, '[data-action=merge]', HTMLSelectElement);
  const { look } = store.get();
  for (const { id } of masks) {
    if (id === mask.id || id === UNLABELLED) continue;
    const option = new Option('', String(id));
    option.dataset.mask = String(id);
    nameOption(option, look);
    merge.append(option);
  }
  merge.hidden = merge.options.length < 2;
  merge.setAttribute('aria-label', strings.mergeOf(nameOf(look, mask.id)));
  merge.addEventListener('change', () => session.correcting.merge(mask.id, Number(merge.value)));
  const ungroup = find(row, '[data-action=ungroup]', HTMLButtonElement);
  ungroup.hidden = !isMerged(look.kind, mask.motions);
  ungroup.addEventListener('click', () => session.correcting.ungroup(mask.id));
}

function nameOption(option: Element, look: Look): void {
  if (option instanceof HTMLOptionElement) option.textContent = nameOf(look, Number(option.dataset.mask));
}
