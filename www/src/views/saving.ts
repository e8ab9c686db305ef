//! Whether the work on screen is saved, since when, or why not, with a button that saves it as a file. Screen readers announce it
//! once, and a refusal is a notice, which they announce as well.

import { strings } from '../common/strings.js';
import type { Session } from '../session/session.js';
import type { State, Store } from '../state/state.js';
import { element, find } from './markup.js';
import { saveProject } from './save-project.js';

export function mountSaving(root: HTMLElement, store: Store, session: Session): void {
  const button = find(root, 'button', HTMLButtonElement);
  const sentence = find(button, 'span', HTMLElement);
  const status = find(root, '[role=status]', HTMLElement);
  button.addEventListener('click', () => void saveProject(session));

  const show = ({ keeping }: State): void => {
    button.hidden = keeping.is === 'nothing';
    button.classList.toggle('refused', keeping.is === 'refused');
    if (keeping.is === 'nothing') return;
    button.ariaBusy = String(keeping.is === 'kept' && keeping.waits);
    const [what, where, more] = keeping.is === 'kept' ? strings.projects.savedHere(keeping.at, keeping.without) : strings.projects.notSaved[keeping.code];
    sentence.replaceChildren(what!, element('span', where, 'in-full'), more!);
    button.title = strings.projects.keeping(keeping);
    if (keeping.is === 'kept' && status.textContent === '') status.textContent = strings.projects.firstSaved;
  };
  store.subscribe((now, before) => {
    if (now.keeping !== before.keeping) show(now);
  });
  show(store.get());
}
