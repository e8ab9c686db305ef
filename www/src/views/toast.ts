//! The notice over the page: a message, or an error with its code. Messages disappear by themselves; errors and what can be chosen stay.

import type { Store } from '../state/state.js';
import { element, find } from './markup.js';

/** How long a message stays, milliseconds. */
const SEEN = 6000;

export function mountToast(root: HTMLElement, store: Store): void {
  const sentence = find(root, '#notice-sentence', HTMLElement);
  const code = find(root, '#notice-code', HTMLElement);
  const choices = find(root, '#notice-choices', HTMLElement);
  let going = 0;
  const close = (): void => store.set({ notice: null });
  find(root, '#notice-close', HTMLButtonElement).addEventListener('click', close);

  const goSoon = (): void => {
    clearTimeout(going);
    const { notice } = store.get();
    if (notice?.code === null && notice.choices.length === 0) going = window.setTimeout(close, SEEN);
  };
  // Not while it is hovered or focused.
  for (const event of ['pointerenter', 'focusin']) root.addEventListener(event, () => clearTimeout(going));
  for (const event of ['pointerleave', 'focusout']) root.addEventListener(event, goSoon);

  store.subscribe(({ notice }, before) => {
    if (notice === before.notice) return;
    // Shown again to be in front of what was opened meanwhile.
    root.hidePopover();
    if (notice !== null) root.showPopover();
    root.classList.toggle('error', notice?.code != null);
    sentence.replaceChildren(...(notice === null ? [] : written(asSentence(notice.sentence))));
    code.textContent = notice?.code ?? '';
    choices.replaceChildren(...(notice?.choices ?? []).map(({ label, choose }) => {
      const button = Object.assign(element('button', label, 'button small'), { type: 'button' });
      button.addEventListener('click', () => {
        close();
        choose();
      });
      return button;
    }));
    goSoon();
  });
}

/** Text between backticks becomes code. */
function written(text: string): (string | HTMLElement)[] {
  return text.split('`').map((part, k) => (k % 2 === 1 ? element('code', part) : part));
}

/** The package's messages start in lower case and have no full stop, as usual on a command line. */
function asSentence(message: string): string {
  const ended = /[.!?]$/.test(message) ? message : `${message}.`;
  return ended.charAt(0).toUpperCase() + ended.slice(1);
}
