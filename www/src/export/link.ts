//! Settings and the sample in the page's address, read and written. Values that are not among the choices are ignored.

import { SAMPLES, type Sample, sampleCalled } from '../frames/samples.js';
import { DEFAULT_SETTINGS, type Settings, settingFrom } from '../state/settings.js';
import type { State } from '../state/state.js';

export interface Linked {
  readonly settings: Partial<Settings>;
  readonly sample: Sample | null;
  /** Whether clips are segmented as soon as they are opened; `null` if the link does not say so. */
  readonly automatic: boolean | null;
}

export function settingsFromHash(hash: string): Linked {
  const values = new URLSearchParams(hash.replace(/^#/, ''));
  const settings: Partial<Settings> = Object.assign({}, ...Object.keys(DEFAULT_SETTINGS).map((name) => settingFrom(name, values.get(name))));
  return {
    settings,
    sample: sampleCalled(values.get('sample')),
    automatic: values.get('segment') === 'asked' ? false : null,
  };
}

/** The page's address with the sample and the settings after the `#`, which is never sent to a server. */
export function linkFor({ settings, tracked, automatic }: Pick<State, 'settings' | 'tracked' | 'automatic'>, address: string): string {
  const values = new URLSearchParams();
  const sample = tracked?.clip.sample;
  // The first needs none: the page opens with it.
  if (sample !== undefined && sample !== SAMPLES[0]) values.set('sample', sample.id);
  for (const [name, value] of Object.entries(settings)) {
    if (value !== DEFAULT_SETTINGS[name as keyof Settings]) values.set(name, String(value));
  }
  if (!automatic) values.set('segment', 'asked');
  const url = new URL(address);
  url.hash = values.toString();
  return url.href;
}
