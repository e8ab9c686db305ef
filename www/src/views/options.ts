//! The settings form, made from `state/settings.ts`.

import type { Session } from '../session/session.js';
import { CONTROLS, type Control, type Settings } from '../state/settings.js';
import type { Store } from '../state/state.js';
import { element } from './markup.js';

/** The elements of a field, and a function that shows the current settings in them. */
interface Field {
  readonly elements: HTMLElement[];
  readonly show: (settings: Settings) => void;
}

export function mountOptions(form: HTMLFormElement, store: Store, session: Session): void {
  const [common, advanced] = form.querySelectorAll('.fields');
  const shows = CONTROLS.filter(({ kind }) => kind !== 'scores').map((control) => {
    const box = element(control.kind === 'radio' ? 'fieldset' : 'div', '', `field field-${control.kind}`);
    const help = element('p', control.help, 'help faint');
    help.id = `help-${control.name}`;
    const { elements, show } = field(control, help.id, session);
    box.append(...elements, help);
    (control.advanced ? advanced : common)?.append(box);
    return show;
  });
  form.addEventListener('submit', (event) => event.preventDefault());
  const render = (): void => shows.forEach((show) => show(store.get().settings));
  store.subscribe((now, before) => {
    if (now.settings !== before.settings) render();
  });
  render();
}

function field(control: Control, helpId: string, session: Session): Field {
  const id = `setting-${control.name}`;
  const identified = <E extends HTMLInputElement | HTMLSelectElement>(input: E, suffix = ''): E => {
    input.id = `${id}${suffix}`;
    input.name = control.name;
    input.setAttribute('aria-describedby', helpId);
    return input;
  };
  const labelFor = (input: HTMLElement): HTMLLabelElement => {
    const label = element('label', control.label);
    label.htmlFor = input.id;
    return label;
  };
  switch (control.kind) {
    case 'scores':
    case 'select': {
      const select = identified(element('select'));
      select.append(...control.choices.map(({ value, label }) => new Option(label, String(value))));
      select.addEventListener('change', () => {
        const choice = control.choices[select.selectedIndex];
        if (choice !== undefined) session.pair.change({ [control.name]: choice.value });
      });
      return { elements: [labelFor(select), select], show: (settings) => (select.value = String(settings[control.name])) };
    }
    case 'radio': {
      const group = element('div', '', 'segmented');
      const inputs = control.choices.map(({ value, label }) => {
        const input = identified(element('input'), `-${String(value)}`);
        input.type = 'radio';
        input.value = String(value);
        input.addEventListener('change', () => session.pair.change({ [control.name]: value }));
        const wrapping = element('label');
        wrapping.append(input, element('span', label));
        group.append(wrapping);
        return input;
      });
      const show = (settings: Settings): void => inputs.forEach((input) => (input.checked = input.value === String(settings[control.name])));
      return { elements: [element('legend', control.label), group], show };
    }
    case 'switch': {
      const input = identified(element('input'));
      input.type = 'checkbox';
      input.addEventListener('change', () => session.pair.change({ [control.name]: input.checked }));
      const label = element('label', '', 'check');
      label.append(input, control.label);
      return { elements: [label], show: (settings) => (input.checked = settings[control.name] === true) };
    }
  }
}
