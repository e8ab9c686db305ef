//! Every sentence that the code says, in one place. What never changes stands in `index.html`.

import type { MotionParts } from './describe.js';
import type { Slot } from './state.js';

const decimals = (digits: number): Intl.NumberFormat => new Intl.NumberFormat('en', { maximumFractionDigits: digits });
const tenths = decimals(1);
const hundredths = decimals(2);
const whole = decimals(0);

/** Keeps a number and its unit on one line. */
const NBSP = '\u00a0';

/** Two digits below one, one digit above: as exact as anybody reads. */
function amount(value: number): string {
  const size = Math.abs(value);
  return (size < 1 ? hundredths : tenths).format(size);
}

const STAGES: Readonly<Record<string, string>> = {
  frames: 'Reading the frames',
  dominant: 'Finding the largest motion',
  measurements: 'Measuring',
  algebra: 'Solving the multibody polynomial',
  selection: 'Choosing the motions',
  refinement: 'Refining the motions',
  labels: 'Labelling the pixels',
  masks: 'Enlarging the masks',
};

/** A stage's name in words; one not in the table has its camelCase name taken apart. */
function stage(name: string): string {
  const words = name.replace(/([a-z0-9])([A-Z])/g, '$1 $2').toLowerCase();
  return STAGES[name] ?? words.charAt(0).toUpperCase() + words.slice(1);
}

/** "moves 4.1 px right, 0.2 px up; turns 1.2° clockwise; grows 0.5 %". */
function motion(parts: MotionParts): string {
  const said: string[] = [];
  const moves: string[] = [];
  if (parts.right !== 0) moves.push(`${amount(parts.right)}${NBSP}px ${parts.right > 0 ? 'right' : 'left'}`);
  if (parts.down !== 0) moves.push(`${amount(parts.down)}${NBSP}px ${parts.down > 0 ? 'down' : 'up'}`);
  if (moves.length > 0) said.push(`moves ${moves.join(', ')}`);
  if (parts.turn !== 0) said.push(`turns ${amount(parts.turn)}° ${parts.turn > 0 ? 'clockwise' : 'anticlockwise'}`);
  if (parts.growth !== 0) said.push(`${parts.growth > 0 ? 'grows' : 'shrinks'} ${amount(parts.growth * 100)}${NBSP}%`);
  if (parts.stretch !== 0) said.push(`stretches ${amount(parts.stretch * 100)}${NBSP}%`);
  return said.length > 0 ? said.join('; ') : 'stands still';
}

export const strings = {
  slot: { first: 'First frame', second: 'Second frame' } satisfies Record<Slot, string>,
  size: (width: number, height: number): string => `${width}${NBSP}×${NBSP}${height}`,
  percent: (share: number): string => `${tenths.format(share * 100)}${NBSP}%`,
  milliseconds: (ms: number): string => `${ms < 10 ? tenths.format(ms) : whole.format(ms)} ms`,
  stage,

  empty: 'none yet',
  heldStill: (name: string): string => `, ${name} held still`,

  motion,
  motionName: (label: number): string => `Motion ${label}`,
  largest: 'largest',
  group: (group: number): string => `group ${group}`,
  residual: (grey: number): string => `residual ${tenths.format(grey)} grey levels`,
  unknownName: 'Cannot tell',
  unknownWords: 'no motion explains these pixels',
  entry: (value: number): string => (Math.abs(value) < 1 ? value.toFixed(6) : value.toFixed(3)),
  show: (name: string): string => `Show ${name}`,
  soloOf: (name: string): string => `Solo: show only ${name}`,
  stillOf: (name: string): string => `Hold still: show the second frame with ${name} held still`,
  copyOf: (name: string): string => `Copy matrix of ${name}`,
  copied: (name: string): string => `The matrix of ${name} is on the clipboard.`,

  timings: {
    decode: (name: string): string => `Decoding ${name}`,
    total: 'All stages',
    waited: 'Request to answer',
  },

  status: {
    idle: 'Open two frames to begin.',
    opening: 'Opening…',
    waiting: (slot: Slot): string => (slot === 'second' ? 'Now add the second frame.' : 'Now add the first frame.'),
    working: (name: string, index: number, of: number): string => (of > 0 ? `${stage(name)} (${index + 1} of ${of})` : 'Starting…'),
    done: (count: number, waited: number): string =>
      `${count === 1 ? 'One motion' : `${count} motions`} found in ${whole.format(waited)} ms.`,
    cancelled: 'Cancelled.',
    failed: 'Nothing was segmented.',
  },

  notices: {
    someUnused: (count: number, first: string, second: string): string =>
      `${count} files were given; the first two by name are used: ${first} and ${second}.`,
    noFiles: 'There was no image in what you gave.',
  },

  errors: {
    unreadable: (name: string): string => `“${name}” is not an image that this browser can read.`,
    unreachable: (name: string): string => `“${name}” could not be loaded.`,
    tooLarge: (name: string, width: number, height: number): string => `“${name}” is too large: ${width} × ${height} pixels.`,
    noCanvas: 'This browser gives no canvas to read pixels from.',
    noClipboard: 'The browser did not let the page write to the clipboard.',
    wholeNumber: (name: string, min: number, max: number): string => `${name} must be a whole number from ${min} to ${max}.`,
  },
} as const;
