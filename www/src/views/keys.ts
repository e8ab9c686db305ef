//! Handles keyboard shortcuts, and opens the list of them with `?`. Single-key shortcuts can be disabled there, because speech
//! input triggers them.

import { imported } from '../common/loaded.js';
import { strings } from '../common/strings.js';
import type { Session } from '../session/session.js';
import type { Store } from '../state/state.js';
import { Peek } from './blink.js';
import { takesText } from './focused.js';
import { find, isDialogueOpen } from './markup.js';
import type { Key } from './shortcuts.js';

export function mountKeys(dialog: HTMLDialogElement, open: HTMLElement, store: Store, session: Session, keys: readonly Key[]): void {
  const single = find(dialog, '#single-keys', HTMLInputElement);
  const list = find(dialog, '.shortcuts', HTMLElement);
  const peek = new Peek(store);
  const show = (): void => {
    if (!dialog.open) dialog.showModal();
    if (list.childElementCount === 0) imported(() => import('./key-list.js')).then(({ listKeys }) => listKeys(list), () => session.say(strings.errors.notLoaded, 'not-loaded'));
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
    if (!command && name === 'f' && !event.shiftKey) return peek.press();
    const isMeant = (key: Key): boolean => (key.command ?? false) === command && (key.shift ?? event.shiftKey) === event.shiftKey && (key.when?.(event.target) ?? true);
    const key = keys.find((one) => one.keys.includes(name) && isMeant(one));
    if (key === undefined) return;
    if (name !== 'escape') event.preventDefault();
    key.run(name);
  });
  document.addEventListener('keyup', (event) => {
    if (event.key.toLowerCase() === 'f') peek.release();
  });
  window.addEventListener('blur', () => peek.release());
}
