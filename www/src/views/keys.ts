//! Handles keyboard shortcuts and lists them in a dialogue that `?` opens. Single-key shortcuts can be disabled there, because speech
//! input triggers them.

import type { Store } from '../state/state.js';
import { Peek } from './blink.js';
import { element, find, isDialogueOpen, takesArrows, takesText } from './markup.js';
import type { Key } from './shortcuts.js';

export function mountKeys(dialog: HTMLDialogElement, open: HTMLElement, store: Store, keys: readonly Key[]): void {
  const single = find(dialog, '#single-keys', HTMLInputElement);
  const list = find(dialog, 'dl', HTMLDListElement);
  const peek = new Peek(store);
  listKeys(list, keys);
  const show = (): void => {
    if (!dialog.open) dialog.showModal();
    // From the top, which the first control may be far from.
    dialog.focus();
    dialog.scrollTop = 0;
  };
  open.addEventListener('click', show);
  find(dialog, '[data-action=close]', HTMLButtonElement).addEventListener('click', () => dialog.close());
  dialog.addEventListener('click', (event) => {
    if (event.target === dialog) dialog.close(); // a click on the backdrop
  });

  document.addEventListener('keydown', (event) => {
    if (event.defaultPrevented || event.altKey || isDialogueOpen() || takesText(event.target)) return;
    const name = event.key.toLowerCase();
    const command = event.ctrlKey || event.metaKey;
    if (!command && !single.checked && name !== 'escape') return;
    if (!command && name === '?') return show();
    if (!command && name === 'b') return peek.press();
    const key = keys.find((one) => one.keys.includes(name) && (one.command ?? false) === command && (one.shift ?? event.shiftKey) === event.shiftKey);
    if (key === undefined || (key.arrows && (store.get().viewport.zoom <= 1 || takesArrows(event.target)))) return;
    if (name !== 'escape') event.preventDefault();
    key.run(name);
  });
  document.addEventListener('keyup', (event) => {
    if (event.key.toLowerCase() === 'b') peek.release();
  });
  window.addEventListener('blur', () => peek.release());
}

/** Fills the list. Keys without words are other ones for what the key before them does. */
function listKeys(list: HTMLDListElement, keys: readonly Key[]): void {
  for (const { shown, does } of keys) {
    if (does === '') {
      list.lastElementChild?.firstElementChild?.append(' ', element('kbd', shown));
      continue;
    }
    const row = element('div');
    const term = element('dt');
    term.append(element('kbd', shown));
    row.append(term, element('dd', does));
    list.append(row);
  }
}
