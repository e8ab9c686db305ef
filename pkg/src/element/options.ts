// What is written in the element's attributes, as options. It goes to the core as it is, which says what is wrong with it.

import type { SegmentOptions } from '../../types/index.js';

export function optionsOf(attribute: (name: string) => string | null): SegmentOptions {
  const options: Record<string, unknown> = {};
  for (const name of ['motions', 'quality']) {
    const value = attribute(name);
    if (value !== null && value !== '') options[name] = name === 'quality' || value === 'auto' ? value : Number(value);
  }
  return options;
}
