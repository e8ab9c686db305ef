//! The notice: an error as a sentence with its code in small, or something that needs saying.

import type { Store } from '../state.js';
import { find } from './markup.js';

export function mountToast(root: HTMLElement, store: Store): void {
  const sentence = find(root, '#notice-sentence', HTMLElement);
  const code = find(root, '#notice-code', HTMLElement);
  find(root, '#notice-close', HTMLButtonElement).addEventListener('click', () => store.set({ notice: null }));

  store.subscribe(({ notice }, before) => {
    if (notice === before.notice) return;
    root.hidden = notice === null;
    root.classList.toggle('error', notice?.code != null);
    sentence.textContent = notice === null ? '' : asSentence(notice.sentence);
    code.textContent = notice?.code ?? '';
  });
}

/** The package's messages begin in lower case and end without a full stop, as messages on a command line do. */
function asSentence(message: string): string {
  const ended = /[.!?]$/.test(message) ? message : `${message}.`;
  return ended.charAt(0).toUpperCase() + ended.slice(1);
}
