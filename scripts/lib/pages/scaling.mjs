// The table of docs/scaling.md.

import { amount, fixed, origin, table } from './table.mjs';

/** Of the video that is counted. */
const FRAMES_PER_SECOND = 25;

export const PARTS = { costs: ['scaling', costs] };

function costs({ frames, ...figures }) {
  const ms = (seconds) => amount(1000 * seconds);
  const kb = (bytes) => amount(bytes / 1000);
  const rows = Object.entries(frames).flatMap(([size, byQuality]) =>
    Object.entries(byQuality).map(([quality, { pair, track, label, decode, encode, file, pairs, saved, png, memory }]) => [
      size,
      quality,
      ...[pair, track, label, decode, encode].map(ms),
      ...[file, pairs, saved, png].map(kb),
      fixed(memory / 2 ** 20, 0),
      amount(FRAMES_PER_SECOND * (pair + track + label + decode * 2 + encode)),
    ]),
  );
  const head = [
    'frames',
    'quality',
    'pair',
    'objects',
    'labels',
    'JPEG',
    'PNG',
    'JPEG, kB',
    'pair, kB',
    'saved, kB',
    'PNG, kB',
    'memory, MiB',
    'core-hours',
  ];
  return `${origin(figures)}\n\n${table(head, rows)}`;
}
