//! The settings form.

import type { Session } from '../session/session.js';
import { type Settings, settingFrom } from '../state/settings.js';
import type { Store } from '../state/state.js';

export function mountOptions(form: HTMLFormElement, store: Store, session: Session): void {
  const fields = [...form.querySelectorAll<HTMLInputElement | HTMLSelectElement>('[name]')];
  for (const field of fields) {
    field.addEventListener('change', () => {
      const text = field.type === 'checkbox' ? String(field.checked) : field.value;
      session.pair.change(settingFrom(field.name, text) ?? {});
    });
  }
  form.addEventListener('submit', (event) => event.preventDefault());
  const render = ({ settings }: { readonly settings: Settings }): void => {
    for (const field of fields) {
      const text = String(settings[field.name as keyof Settings]);
      if (field instanceof HTMLSelectElement) field.value = text;
      else field.checked = text === (field.type === 'radio' ? field.value : 'true');
    }
  };
  store.subscribe((now, before) => {
    if (now.settings !== before.settings) render(now);
  });
  render(store.get());
}
