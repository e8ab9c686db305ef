//! Handles keyboard shortcuts and lists them in a dialogue that `?` opens. Single-key shortcuts can be disabled there, because speech
//! input triggers them.

import type { Store } from '../state/state.js';
import { Peek } from './blink.js';
import { takesText } from './focused.js';
import { element, find, isDialogueOpen } from './markup.js';
import type { Group } from './shortcuts.js';

export function mountKeys(dialog: HTMLDialogElement, open: HTMLElement, store: Store, groups: readonly Group[]): void {
  const keys = groups.flatMap((group) => group.keys);
  const single = find(dialog, '#single-keys', HTMLInputElement);
  const list = find(dialog, '.shortcuts', HTMLElement);
  const peek = new Peek(store);
  list.append(...groups.map(sectionOf));
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
    if (!command && name === 'f' && !event.shiftKey) return peek.press();
    const isMeant = (key: Group['keys'][number]): boolean => (key.command ?? false) === command && (key.shift ?? event.shiftKey) === event.shiftKey && (key.when?.(event.target) ?? true);
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

/** A part of the list. Keys without words are other ones for what the key before them does. */
function sectionOf({ title, keys }: Group): HTMLElement {
  const section = element('section');
  const list = element('dl');
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
  section.append(element('h3', title), list);
  return section;
}
