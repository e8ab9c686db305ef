//! The settings form. Whether clips are segmented by themselves is kept for the next visit.

import { type Settings, settingFrom } from '../state/settings.js';
import type { State, Store } from '../state/state.js';
import { find } from './markup.js';

/** Where the browser keeps that clips wait until a person asks for their masks. */
const KEY = 'veronese-segment';
const ASKED = 'asked';

export function mountOptions(form: HTMLFormElement, store: Store): void {
  const fields = [...form.querySelectorAll<HTMLInputElement | HTMLSelectElement>('[name]:not([name=automatic])')];
  const automatic = find(form, '[name=automatic]', HTMLInputElement);
  for (const field of fields) {
    field.addEventListener('change', () => {
      const text = field.type === 'checkbox' ? String(field.checked) : field.value;
      store.set({ settings: { ...store.get().settings, ...settingFrom(field.name, text) } });
    });
  }
  automatic.addEventListener('change', () => {
    store.set({ automatic: automatic.checked });
    try {
      if (automatic.checked) localStorage.removeItem(KEY);
      else localStorage.setItem(KEY, ASKED);
    } catch {
      // It holds until the page is left.
    }
  });
  form.addEventListener('submit', (event) => event.preventDefault());
  const render = ({ settings, automatic: isAutomatic }: Pick<State, 'settings' | 'automatic'>): void => {
    automatic.checked = isAutomatic;
    for (const field of fields) {
      const text = String(settings[field.name as keyof Settings]);
      if (field instanceof HTMLSelectElement) field.value = text;
      else field.checked = text === (field.type === 'radio' ? field.value : 'true');
    }
  };
  store.subscribe((now, before) => {
    if (now.settings !== before.settings || now.automatic !== before.automatic) render(now);
  });
  try {
    store.set({ automatic: localStorage.getItem(KEY) !== ASKED });
  } catch {
    // A browser that keeps nothing begins as it always does.
  }
  render(store.get());
}
