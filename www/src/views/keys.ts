//! Handles keyboard shortcuts and lists them in a dialogue that `?` opens. Single-key shortcuts can be disabled there, because speech
//! input triggers them.

import { strings } from '../common/strings.js';
import type { Session } from '../session/session.js';
import type { Store } from '../state/state.js';
import { Peek } from './blink.js';
import { find, isDialogueOpen, takesArrows, takesText } from './markup.js';
import type { Key } from './shortcuts.js';

export function mountKeys(dialog: HTMLDialogElement, open: HTMLElement, store: Store, session: Session, keys: readonly Key[]): void {
  const single = find(dialog, '#single-keys', HTMLInputElement);
  const list = find(dialog, 'dl', HTMLDListElement);
  const peek = new Peek(store);
  const show = async (): Promise<void> => {
    if (list.childElementCount === 0) {
      try {
        const { listKeys } = await import('./key-list.js');
        if (list.childElementCount === 0) listKeys(list, keys);
      } catch {
        return session.say(strings.errors.notLoaded, 'not-loaded');
      }
    }
    if (!dialog.open) dialog.showModal();
    // From the top, which the first control may be far from.
    dialog.focus();
    dialog.scrollTop = 0;
  };
  open.addEventListener('click', () => void show());
  find(dialog, '[data-action=close]', HTMLButtonElement).addEventListener('click', () => dialog.close());
  dialog.addEventListener('click', (event) => {
    if (event.target === dialog) dialog.close(); // a click on the backdrop
  });

  document.addEventListener('keydown', (event) => {
    if (event.defaultPrevented || event.altKey || isDialogueOpen() || takesText(event.target)) return;
    const name = event.key.toLowerCase();
    const command = event.ctrlKey || event.metaKey;
    if (!command && !single.checked && name !== 'escape') return;
    if (!command && name === '?') return void show();
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
