//! The question which of several folders has the frames.

import { type VNode, render } from 'preact';
import { strings } from '../common/strings.js';
import type { Store } from '../state/state.js';
import { usePart } from './component.js';
import { find } from './markup.js';

export function mountFolders(dialog: HTMLDialogElement, store: Store): void {
  render(<Choices store={store} />, find(dialog, '.choices', HTMLElement));
  dialog.addEventListener('close', () => store.get().question?.answer(null));
  store.subscribe(({ question }, before) => {
    if (question === before.question) return;
    if (question === null) dialog.close();
    else dialog.showModal();
  });
}

function Choices({ store }: { store: Store }): VNode {
  const question = usePart(store, (state) => state.question);
  const choices = question === null ? [] : [...question.folders.map(({ path, images }) => [strings.imagesIn(path, images.length), images] as const), [strings.allImages(question.images.length), question.images] as const];
  return (
    <>
      {choices.map(([text, images]) => (
        <button key={text} type="button" class="button" onClick={() => question?.answer(images)}>
          {text}
        </button>
      ))}
    </>
  );
}
