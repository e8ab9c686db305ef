//! Settings and the sample out of the page's address. What is not one of the choices is left out: a link can set nothing else.

import { CONTROLS } from './controls.js';
import type { Kind } from './masks.js';
import { type Sample, sampleCalled } from './samples.js';
import type { Settings } from './state.js';

export interface Linked {
  readonly settings: Partial<Settings>;
  readonly kind: Kind | null;
  readonly sample: Sample | null;
  readonly swapped: boolean;
}

export function settingsFromHash(hash: string): Linked {
  const values = new URLSearchParams(hash.replace(/^#/, ''));
  const settings: Record<string, unknown> = {};
  for (const control of CONTROLS) {
    const text = values.get(control.name);
    if (text === null) continue;
    if (control.kind === 'switch') {
      if (text === 'true' || text === 'false') settings[control.name] = text === 'true';
    } else if (control.kind === 'number') {
      const value = Number(text);
      if (/^\d+$/.test(text) && value >= control.min && value <= control.max) settings[control.name] = value;
    } else {
      const choice = control.choices.find(({ value }) => String(value) === text);
      if (choice !== undefined) settings[control.name] = choice.value;
    }
  }
  const kind = values.get('masks');
  return {
    settings,
    kind: kind === 'motions' || kind === 'groups' ? kind : null,
    sample: sampleCalled(values.get('sample')),
    swapped: values.get('swapped') === 'true',
  };
}
