//! Work that the browser keeps, to go on with: the newest in the place of the first words, the others behind it.

import { strings } from '../common/strings.js';
import { sampleCalled } from '../frames/samples.js';
import { type Listed, framesOf, list, watch } from '../projects/shelf.js';
import type { Session } from '../session/session.js';
import type { Store } from '../state/state.js';
import { element, find } from './markup.js';
import { showRows } from './rows.js';

export function mountContinuing(root: HTMLElement, store: Store, session: Session): void {
  const title = find(root, 'summary', HTMLElement);
  const words = find(root, '.beginning > p', HTMLElement);
  const section = find(root, '#continue', HTMLElement);
  const [newest, others] = section.querySelectorAll('ul');
  const more = find(section, 'details', HTMLDetailsElement);
  const open = (): string | undefined => store.get().tracked?.clip.fingerprint;

  const update = async (): Promise<void> => {
    const listed = await list().catch((): Listed[] => []);
    const rows = listed.filter(({ header }) => header.of !== open()).map((one) => rowOf(one, session));
    const nothing = rows.length === 0;
    title.textContent = nothing ? strings.projects.welcome : strings.projects.continue;
    words.hidden = !nothing;
    section.hidden = nothing;
    more.hidden = rows.length < 2;
    find(more, 'summary', HTMLElement).textContent = strings.projects.more(rows.length - 1);
    showRows([[newest!, rows.slice(0, 1)], [others!, rows.slice(1)]]);
  };
  let updated: Promise<void> = Promise.resolve();
  const refresh = (): void => void (updated = updated.then(update));

  watch(refresh);
  let of = open();
  store.subscribe(() => {
    if (open() === of) return;
    of = open();
    refresh();
  });
  refresh();
}

function rowOf({ header: { of, name, frames, saved, sample, thumbnail }, hasFrames }: Listed, session: Session): HTMLElement {
  const known = sample === undefined ? null : sampleCalled(sample);
  const facts = strings.projects.left(frames, new Date(saved), known !== null || hasFrames);
  const button = element('button', '', 'work');
  button.type = 'button';
  button.title = name;
  const picture = element('img');
  picture.alt = '';
  picture.hidden = thumbnail === undefined;
  if (thumbnail !== undefined) picture.src = thumbnail;
  const text = element('span');
  text.append(element('strong', name), element('span', facts, 'faint'));
  button.append(picture, text);
  button.addEventListener('click', () => {
    if (known !== null) void session.open.sample(known);
    else if (hasFrames) void session.open.files(framesOf(of));
    // Their project is found when they are opened.
    else find(document, '#open-pair', HTMLInputElement).click();
  });
  const row = element('li');
  row.dataset['of'] = of;
  row.append(button);
  return row;
}
