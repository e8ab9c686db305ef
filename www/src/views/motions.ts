//! The list of motions: each in words and numbers, with its colour, its share, and ways to look at it alone.

import { centresOf, partsOf, visibleParts } from '../describe.js';
import { UNLABELLED, classOf, isShown } from '../paint.js';
import { UNKNOWN_COLOUR, colourOf, cssColour } from '../palette.js';
import type { Session } from '../session.js';
import type { Look, Result, State, Store } from '../state.js';
import { strings } from '../strings.js';
import { find } from './markup.js';

type Motion = Result['segmentation']['motions'][number];

/** Brings one row up to date with the state. */
type Refresh = (state: State) => void;

export function mountMotions(root: ParentNode, store: Store, session: Session): void {
  const list = find(root, '#motions', HTMLOListElement);
  const empty = find(root, '#motions-empty', HTMLElement);
  const template = find(root, '#motion-row', HTMLTemplateElement);
  let rows: Refresh[] = [];

  store.subscribe((now, before) => {
    if (now.result !== before.result) {
      empty.hidden = now.result !== null;
      list.replaceChildren();
      rows = now.result === null ? [] : fillList(list, template, now.result, store, session);
    }
    if (now.result !== before.result || now.look !== before.look) for (const refresh of rows) refresh(now);
  });
}

function fillList(list: HTMLElement, template: HTMLTemplateElement, { segmentation }: Result, store: Store, session: Session): Refresh[] {
  const centres = centresOf(segmentation);
  const total = segmentation.width * segmentation.height;
  const refreshers = segmentation.motions.map((motion, i) => {
    const row = newRow(template, strings.motionName(motion.label), motion.share);
    const [, , width, height] = motion.bbox;
    const parts = visibleParts(partsOf(motion.matrix, centres[i] ?? [0, 0]), Math.hypot(width, height) / 2);
    find(row, '.motion-note', HTMLElement).textContent = motion.label === 0 ? strings.largest : '';
    find(row, '.motion-words', HTMLElement).textContent = strings.motion(parts);
    find(row, '.motion-facts', HTMLElement).textContent = `${strings.residual(motion.residual)} · ${strings.group(motion.group)}`;
    fillMatrix(row, motion, session);
    list.append(row);
    return wire(row, motion.label, store, (look) => colourOf(classOf(motion.label, segmentation, look.colouring)));
  });
  if (segmentation.unlabelled > 0) {
    const row = newRow(template, strings.unknownName, segmentation.unlabelled / total);
    find(row, '.motion-words', HTMLElement).textContent = strings.unknownWords;
    for (const selector of ['.motion-facts', '[data-action=still]', '.matrix']) find(row, selector, HTMLElement).remove();
    list.append(row);
    refreshers.push(wire(row, UNLABELLED, store, () => UNKNOWN_COLOUR));
  }
  return refreshers;
}

function newRow(template: HTMLTemplateElement, name: string, share: number): HTMLElement {
  const row = find(document.importNode(template.content, true), 'li', HTMLElement);
  find(row, '.motion-name', HTMLElement).textContent = name;
  find(row, '.motion-share', HTMLElement).textContent = strings.percent(share);
  find(row, 'input', HTMLElement).setAttribute('aria-label', strings.show(name));
  find(row, '[data-action=solo]', HTMLElement).setAttribute('aria-label', strings.soloOf(name));
  find(row, '[data-action=still]', HTMLElement).setAttribute('aria-label', strings.stillOf(name));
  row.style.setProperty('--share', String(share));
  return row;
}

/** Connects a row's checkbox and buttons to the state. */
function wire(row: HTMLElement, label: number, store: Store, colour: (look: Look) => Parameters<typeof cssColour>[0]): Refresh {
  const shown = find(row, 'input', HTMLInputElement);
  const solo = find(row, '[data-action=solo]', HTMLButtonElement);
  const still = row.querySelector('[data-action=still]');

  shown.addEventListener('change', () => {
    const { look } = store.get();
    const hidden = new Set(look.hidden);
    if (shown.checked) hidden.delete(label);
    else hidden.add(label);
    store.look({ hidden, solo: null });
  });
  solo.addEventListener('click', () => store.look({ solo: store.get().look.solo === label ? null : label }));
  still?.addEventListener('click', () => {
    const { look } = store.get();
    store.look(look.still === label ? { still: null } : { still: label, frame: 'second' });
  });

  return ({ look }) => {
    row.style.setProperty('--colour', cssColour(colour(look)));
    shown.checked = isShown(label, look);
    row.classList.toggle('away', !shown.checked);
    solo.setAttribute('aria-pressed', String(look.solo === label));
    still?.setAttribute('aria-pressed', String(look.still === label));
  };
}

function fillMatrix(row: HTMLElement, motion: Motion, session: Session): void {
  const name = strings.motionName(motion.label);
  const body = find(row, 'tbody', HTMLElement);
  for (const entries of [motion.matrix.slice(0, 3), motion.matrix.slice(3, 6)]) {
    const line = document.createElement('tr');
    for (const entry of entries) line.insertCell().textContent = strings.entry(entry);
    body.append(line);
  }
  const copy = find(row, '[data-action=copy]', HTMLButtonElement);
  copy.setAttribute('aria-label', strings.copyOf(name));
  copy.addEventListener('click', () => {
    navigator.clipboard.writeText(JSON.stringify(motion.matrix)).then(
      () => session.say(strings.copied(name)),
      () => session.say(strings.errors.noClipboard, 'no-clipboard'),
    );
  });
}
