//! The question which of several folders has the frames.

import { strings } from '../common/strings.js';
import type { Store } from '../state/state.js';
import { element, find } from './markup.js';

export function mountFolders(dialog: HTMLDialogElement, store: Store): void {
  const choices = find(dialog, '.choices', HTMLElement);
  dialog.addEventListener('close', () => store.get().question?.answer(null));
  store.subscribe(({ question }, before) => {
    if (question === before.question) return;
    if (question === null) return dialog.close();
    const button = (text: string, images: readonly File[]): HTMLElement => {
      const made = element('button', text, 'button');
      made.type = 'button';
      made.addEventListener('click', () => question.answer(images));
      return made;
    };
    choices.replaceChildren(
      ...question.folders.map(({ path, images }) => button(strings.imagesIn(path, images.length), images)),
      button(strings.allImages(question.images.length), question.images),
    );
    dialog.showModal();
  });
}
