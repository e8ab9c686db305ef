//! The list of classes: what fields offer, and the dialogue in which it is changed.

import { type Signal, signal } from '@preact/signals';
import { type VNode, render } from 'preact';
import { sentenceOf } from '../common/errors.js';
import { importClasses, keepClasses, namesIn } from '../session/class-list.js';
import type { Store } from '../state/state.js';
import { usePart } from './component.js';
import { find } from './markup.js';

export function mountClasses(root: ParentNode, store: Store): void {
  const offered = find(root, '#class-names', HTMLDataListElement);
  const dialog = find(root, '#class-list', HTMLDialogElement);
  keepClasses(store);
  render(<Names store={store} />, offered);
  const told = signal('');
  const take = (): void => store.set({ classList: namesIn(find(dialog, 'textarea', HTMLTextAreaElement).value) });
  render(<List dialog={dialog} told={told} take={take} store={store} />, dialog);
  find(root, '#open-classes', HTMLButtonElement).addEventListener('click', () => dialog.showModal());
  dialog.addEventListener('click', (event) => {
    if (event.target === dialog) dialog.close(); // a click on the backdrop
  });
  dialog.addEventListener('close', () => {
    take();
    told.value = '';
  });
}

function Names({ store }: { store: Store }): VNode {
  const names = usePart(store, ({ classList }) => classList);
  return (
    <>
      {names.map((name) => (
        <option key={name}>{name}</option>
      ))}
    </>
  );
}

function List({ dialog, told, take, store }: { dialog: HTMLDialogElement; told: Signal<string>; take: () => void; store: Store }): VNode {
  const names = usePart(store, ({ classList }) => classList);
  const read = async (input: HTMLInputElement): Promise<void> => {
    const files = [...(input.files ?? [])];
    input.value = ''; // so that choosing the same file again is a change
    // Here, because what is behind the dialogue is not read out.
    told.value = await importClasses(files, store, true).then((added) => added ?? '', sentenceOf);
  };
  return (
    <>
      <h2 id="class-list-title">Classes</h2>
      <textarea
        rows={12}
        spellcheck={false}
        aria-labelledby="class-list-title"
        aria-describedby="class-list-help"
        autofocus
        value={names.join('\n')}
        onChange={take}
      />
      <div>
        <p id="class-list-help" class="help faint">
          One a line, in the order of their numbers in files. The list is kept for the next clip. Import a text file, labels of CVAT or categories of COCO, here or by a drop
          on the page.
        </p>
        <p class="help" role="status">
          {told.value}
        </p>
      </div>
      <div class="copies">
        <label class="button small">
          <input type="file" class="file" accept=".txt,.json" multiple onChange={({ currentTarget }) => void read(currentTarget)} />
          Import…
        </label>
        <button type="button" class="button small primary" onClick={() => dialog.close()}>
          Done
        </button>
      </div>
    </>
  );
}
