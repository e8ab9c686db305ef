// The table of docs/sizes.md.

import { fixed, table } from './table.mjs';

export const PARTS = { sizes: ['sizes', sizes] };

function sizes({ date, version, entries }) {
  const kilobytes = (bytes) => (bytes === undefined ? '' : fixed(bytes / 1024, 0));
  const rows = entries.map(({ entry, files, raw, gzip, brotli }) => [entry, files, ...[raw, gzip, brotli].map(kilobytes)]);
  return `Version ${version}, ${date}.\n\n${table(['', 'files', 'raw', 'gzip', 'brotli'], rows)}`;
}
