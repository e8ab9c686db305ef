//! Several files as one zip archive.

import { zipSync } from 'fflate';

/** A zip archive. PNG files are compressed already and only stored. */
export function zipped(files: Record<string, Uint8Array>): Uint8Array<ArrayBuffer> {
  const entries = Object.entries(files).map(([name, bytes]) => [name, [bytes, { level: name.endsWith('.png') ? 0 : 6 }]]);
  return new Uint8Array(zipSync(Object.fromEntries(entries)));
}
