//! Classes of objects: the field in each row, what it offers, and the dialogue with the list.

import { sentenceOf } from '../common/errors.js';
import { nameOf } from '../common/naming.js';
import { strings } from '../common/strings.js';
import { importClasses, keepClasses, namesIn } from '../session/class-list.js';
import type { Session } from '../session/session.js';
import type { State, Store } from '../state/state.js';
import { objectsOf } from '../state/tracked.js';
import { find } from './markup.js';

export function mountClasses(root: ParentNode, store: Store, session: Session): void {
  const list = find(root, '#objects', HTMLOListElement);
  const offered = find(root, '#class-names', HTMLDataListElement);
  const dialog = find(root, '#class-list', HTMLDialogElement);
  const text = find(dialog, 'textarea', HTMLTextAreaElement);
  const file = find(dialog, 'input', HTMLInputElement);
  const status = find(dialog, '[role=status]', HTMLElement);
  keepClasses(store);

  const connected = new WeakSet<HTMLInputElement>();
  const render = ({ tracked, look, classList }: State, before: State | null): void => {
    if (classList !== before?.classList) {
      offered.replaceChildren(...classList.map((name) => new Option(name)));
      text.value = classList.join('\n');
    }
    const objects = tracked === null ? new Map() : objectsOf(tracked);
    for (const row of list.querySelectorAll<HTMLElement>(':scope > li')) {
      const id = Number(row.dataset.mask);
      const field = find(row, '.class', HTMLInputElement);
      if (!connected.has(field)) onClass(field, (name) => session.objects.setClasses(new Map([[id, name]])));
      connected.add(field);
      field.setAttribute('aria-label', strings.classOf(nameOf(look, id)));
      if (document.activeElement !== field) field.value = objects.get(id)?.class ?? '';
    }
  };
  store.subscribe((now, before) => {
    if (now.tracked !== before.tracked || now.look !== before.look || now.classList !== before.classList) render(now, before);
  });
  render(store.get(), null);

  find(root, '#open-classes', HTMLButtonElement).addEventListener('click', () => dialog.showModal());
  const take = (): void => store.set({ classList: namesIn(text.value) });
  text.addEventListener('change', take);
  file.addEventListener('change', async () => {
    const files = [...(file.files ?? [])];
    file.value = ''; // so that choosing the same file again is a change
    // Here, because what is behind the dialogue is not read out.
    status.textContent = await importClasses(files, store, true).catch(sentenceOf);
  });
  find(dialog, 'button', HTMLButtonElement).addEventListener('click', () => dialog.close());
  dialog.addEventListener('click', (event) => {
    if (event.target === dialog) dialog.close(); // a click on the backdrop
  });
  dialog.addEventListener('close', () => {
    take();
    status.textContent = '';
  });
}

/** Takes what is typed or chosen in a field for a class. */
export function onClass(field: HTMLInputElement, take: (name: string) => void): void {
  let before = '';
  field.addEventListener('focus', () => (before = field.value));
  field.addEventListener('change', () => take(field.value.trim()));
  field.addEventListener('keydown', (event) => {
    if (event.key === 'Escape') field.value = before;
    if (event.key === 'Enter' || event.key === 'Escape') field.blur();
    if (event.key === 'Escape') event.stopPropagation();
  });
}
