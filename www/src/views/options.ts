//! The settings form, drawn from `controls.ts`.

import { CONTROLS, type Control } from '../controls.js';
import type { Session } from '../session.js';
import type { Store } from '../state.js';
import { strings } from '../strings.js';

export function mountOptions(form: HTMLFormElement, store: Store, session: Session): void {
  form.append(...CONTROLS.map((control) => field(control, store, session)));
  form.addEventListener('submit', (event) => event.preventDefault());
}

function field(control: Control, store: Store, session: Session): HTMLElement {
  const box = control.kind === 'radio' ? element('fieldset') : element('div');
  box.className = `field field-${control.kind}`;
  const help = element('p', control.help);
  help.className = 'help faint';
  help.id = `help-${control.name}`;
  box.append(...inputs(control, help.id, store, session), help);
  return box;
}

function inputs(control: Control, helpId: string, store: Store, session: Session): HTMLElement[] {
  const id = `setting-${control.name}`;
  const current = store.get().settings[control.name];
  switch (control.kind) {
    case 'select': {
      const select = element('select');
      select.append(...control.choices.map(({ value, label }) => new Option(label, String(value), value === control.initial, value === current)));
      select.addEventListener('change', () => {
        const choice = control.choices[select.selectedIndex];
        if (choice !== undefined) session.change({ [control.name]: choice.value });
      });
      return [labelFor(identified(select, id, control.name, helpId), control.label), select];
    }
    case 'radio': {
      const group = element('div');
      group.className = 'segmented';
      for (const { value, label } of control.choices) {
        const input = element('input');
        input.type = 'radio';
        input.checked = value === current;
        input.value = String(value);
        input.addEventListener('change', () => session.change({ [control.name]: value }));
        const wrapping = element('label');
        wrapping.append(identified(input, `${id}-${String(value)}`, control.name, helpId), element('span', label));
        group.append(wrapping);
      }
      return [element('legend', control.label), group];
    }
    case 'switch': {
      const input = element('input');
      input.type = 'checkbox';
      input.checked = current === true;
      input.addEventListener('change', () => session.change({ [control.name]: input.checked }));
      const label = element('label');
      label.className = 'check';
      label.append(identified(input, id, control.name, helpId), control.label);
      return [label];
    }
    case 'number': {
      const input = element('input');
      input.type = 'number';
      input.min = String(control.min);
      input.max = String(control.max);
      input.step = '1';
      input.required = true;
      input.value = String(current);
      input.addEventListener('change', () => {
        if (input.checkValidity()) session.change({ [control.name]: input.valueAsNumber });
        else {
          session.say(strings.errors.wholeNumber(control.label, control.min, control.max), 'invalid-option');
          input.value = String(store.get().settings[control.name]);
        }
      });
      return [labelFor(identified(input, id, control.name, helpId), control.label), input];
    }
  }
}

function element<T extends keyof HTMLElementTagNameMap>(tag: T, text = ''): HTMLElementTagNameMap[T] {
  const made = document.createElement(tag);
  made.textContent = text;
  return made;
}

function identified<E extends HTMLInputElement | HTMLSelectElement>(input: E, id: string, name: string, helpId: string): E {
  input.id = id;
  input.name = name;
  input.setAttribute('aria-describedby', helpId);
  return input;
}

function labelFor(input: HTMLElement, text: string): HTMLLabelElement {
  const label = element('label', text);
  label.htmlFor = input.id;
  return label;
}
