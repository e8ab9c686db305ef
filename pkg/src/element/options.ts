// The element's attributes as options. They go to the core as they are, which refuses what is wrong.

import type { SegmentOptions } from '../../types/index.js';

export function optionsOf(attribute: (name: string) => string | null): SegmentOptions {
  const options: Record<string, unknown> = {};
  for (const name of ['motions', 'quality']) {
    const value = attribute(name);
    if (value) options[name] = /^\d+$/.test(value) ? Number(value) : value;
  }
  if (attribute('subject') !== null) options['subject'] = true;
  return options;
}
