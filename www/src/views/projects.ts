//! The projects: whether the work is kept, saving it as a file, and the list of those that this browser keeps. Loaded with the panel.

import { strings } from '../common/strings.js';
import { codeOf, sentenceOf } from '../common/errors.js';
import { type Listed, list, watch } from '../projects/shelf.js';
import type { Session } from '../session/session.js';
import type { State, Store } from '../state/state.js';
import { element, find } from './markup.js';
import { showRows } from './rows.js';
import { saveProject } from './save-project.js';

export function mountProjects(panel: HTMLElement, store: Store, session: Session): void {
  const root = find(panel, '#project', HTMLElement);
  const status = find(root, '#project-status', HTMLElement);
  const all = find(root, 'details', HTMLDetailsElement);
  const summary = find(all, 'summary', HTMLElement);
  const rows = find(all, '#projects', HTMLUListElement);

  const show = ({ keeping }: State): void => void (status.textContent = strings.projects.keeping(keeping));

  let refreshed: Promise<void> = Promise.resolve();
  const refresh = (): Promise<void> => (refreshed = refreshed.then(update));

  const update = async (): Promise<void> => {
    const listed = await list().catch((): Listed[] => []);
    all.hidden = listed.length === 0;
    summary.textContent = strings.projects.summary(listed.length);
    showRows([[rows, listed.map((one) => rowOf(one, () => void forget(one)))]]);
  };

  const forget = async (listed: Listed): Promise<void> => {
    try {
      await session.projects.forget(listed);
      session.say(strings.projects.forgotten(listed.header.name));
    } catch (error) {
      session.say(sentenceOf(error), codeOf(error));
    }
    await refresh();
    (rows.querySelector('button') ?? summary).focus();
  };

  const button = find(root, '#save-project', HTMLButtonElement);
  button.addEventListener('click', () => void saveProject(session));

  panel.addEventListener('toggle', () => void refresh());
  watch(() => void (panel.matches(':popover-open') && refresh()));
  store.subscribe((now, before) => {
    if (now.keeping !== before.keeping) show(now);
  });
  show(store.get());
  button.disabled = false;
  void refresh();
}

function rowOf({ header: { of, name, frames, saved }, bytes }: Listed, forget: () => void): HTMLElement {
  const row = element('li');
  row.dataset['of'] = of;
  const text = element('div');
  text.append(element('strong', name), element('span', strings.projects.facts(frames, bytes, new Date(saved)), 'faint'));
  const button = element('button', strings.projects.forget, 'button small quiet');
  button.type = 'button';
  button.setAttribute('aria-label', strings.projects.forgetOf(name));
  button.addEventListener('click', forget);
  row.append(text, button);
  return row;
}
