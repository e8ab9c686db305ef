//! The list of the masks of a pair: share and motion of each, with what can be seen of it.

import { nameOf } from '../common/naming.js';
import { strings } from '../common/strings.js';
import { centreOf, partsOf, visibleParts } from '../result/describe.js';
import { type Mask, masksOf } from '../result/masks.js';
import { NOTATIONS } from '../result/matrices.js';
import type { Session } from '../session/session.js';
import { type Look, type Result, type State, type Store, isAwaited } from '../state/state.js';
import { copyText } from './clipboard.js';
import { element, find, prefersStillness } from './markup.js';
import { focusRow, heldRow, maskRow } from './mask-row.js';
import { drawThumbnail } from './thumbnail.js';

type Segmentation = Result['segmentation'];

/** Updates one row. */
type Refresh = (look: Look) => void;

export function mountMotions(root: ParentNode, store: Store, session: Session): void {
  const list = find(root, '#motions', HTMLOListElement);
  const empty = find(root, '#motions-empty', HTMLElement);
  let rows: Refresh[] = [];

  store.subscribe((now, before) => {
    const { result, look, live, run } = now;
    const awaited = isAwaited(now);
    const other = result !== before.result || look.kind !== before.look.kind || live !== before.live || isAwaited(before);
    list.hidden = look.kind === 'objects';
    list.inert = awaited;
    list.ariaBusy = awaited ? 'true' : null;
    if (other || run.phase !== before.run.phase) {
      empty.hidden = look.kind === 'objects' || (live === null && (result !== null || (awaited && rows.length > 0)));
      empty.textContent = live === null ? whyNone(run) : strings.liveMasks((result?.second?.count ?? 1) - 1);
    }
    if (awaited) return;
    if (other) {
      const held = heldRow(list);
      list.replaceChildren();
      rows = result === null || live !== null || look.kind === 'objects' ? [] : fillList(list, look, result, store, session);
      if (held !== null) focusRow(list, held, look);
    }
    if (other || look !== before.look) for (const refresh of rows) refresh(look);
  });
}

function whyNone({ phase }: State['run']): string {
  return phase === 'failed' || phase === 'cancelled' ? strings.noMasks[phase] : strings.noMasksYet;
}

function fillList(list: HTMLElement, look: Look, result: Result, store: Store, session: Session): Refresh[] {
  const { segmentation } = result;
  const masks = masksOf(segmentation, look.kind);
  return masks.map((mask) => {
    const { element: row, refresh } = maskRow('pair', mask.id, store, session);
    row.style.setProperty('--share', String(mask.share));
    find(row, '.motion-share', HTMLElement).textContent = strings.percent(mask.share);
    drawThumbnail(find(row, '.thumbnail', HTMLCanvasElement), result, mask.motions.map(({ label }) => label));
    list.append(row);
    const [main] = mask.motions;
    if (main === undefined) {
      find(row, '.words', HTMLElement).textContent = strings.unknownWords;
      for (const selector of ['.direction', '[data-action=stabilise]', '[data-action=take]', '.more']) find(row, selector, Element).remove();
      return refresh;
    }
    describe(row, mask, look, segmentation);
    const refreshMore = fillMore(row, mask, store, session);
    return (now) => {
      refresh(now);
      refreshMore(now);
    };
  });
}

/** The motion of a mask: an arrow and a few words, with everything else in the details. */
function describe(row: HTMLElement, mask: Mask, look: Look, segmentation: Segmentation): void {
  const [main] = mask.motions as [Mask['motions'][number]];
  const [, , width, height] = main.bbox;
  const parts = visibleParts(partsOf(main.matrix, centreOf(segmentation, main.label)), Math.hypot(width, height) / 2);
  const direction = find(row, '.direction', SVGSVGElement);
  direction.toggleAttribute('hidden', parts.right === 0 && parts.down === 0);
  direction.style.rotate = `${Math.atan2(parts.down, parts.right)}rad`;
  find(row, '.words', HTMLElement).textContent = strings.displacement(parts);
  find(row, '.motion-facts', HTMLElement).textContent = [strings.motion(parts), ...factsOf(mask, look, segmentation)].join(' · ');
}

function factsOf({ id, motions }: Mask, { kind }: Look, { motions: all }: Segmentation): string[] {
  const facts = [strings.residual(motions[0]!.residual)];
  if (kind === 'groups' && motions.length > 1) facts.push(strings.severalMotions(motions.length));
  const fellows = all.filter(({ group, label }) => group === motions[0]!.group && label !== id);
  if (kind === 'motions' && fellows.length > 0) facts.push(strings.groupWith(fellows.map(({ label }) => label)));
  return facts;
}

/** Alternates between the first frame and the second warped back by the mask's motion: what stays in place belongs to the mask. */
export function toggleStabilised(store: Store, id: number): void {
  const { look } = store.get();
  if (look.stabilised === id) store.look({ stabilised: null, blinking: false, view: 'first' });
  else store.look({ stabilised: id, view: look.view === 'split' ? 'split' : 'second', blinking: look.view !== 'split' && !prefersStillness() });
}

/** Connects what only masks of a pair have: the motion to copy, stabilising, and becoming an object. */
function fillMore(row: HTMLElement, { id, motions }: Mask, store: Store, session: Session): Refresh {
  const { matrix } = motions[0]!;
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
    button.addEventListener('click', () => copyText(write(matrix), strings.copied(title, nameOf(store.get().look, id)), session));
    copies.append(button);
  }
  const stabilise = find(row, '[data-action=stabilise]', HTMLButtonElement);
  stabilise.addEventListener('click', () => toggleStabilised(store, id));
  const take = find(row, '[data-action=take]', HTMLButtonElement);
  take.hidden = id === 0;
  take.addEventListener('click', async () => {
    const selected = await session.objects.take(id);
    if (selected === null) return;
    session.shown.choose('objects');
    store.look({ selected });
  });
  return (look) => {
    take.setAttribute('aria-label', strings.takeOf(nameOf(look, id)));
    stabilise.setAttribute('aria-pressed', String(look.stabilised === id));
    stabilise.setAttribute('aria-label', strings.stabiliseOf(nameOf(look, id)));
  };
}
