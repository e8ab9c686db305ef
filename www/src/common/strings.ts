//! Every sentence that the code says, in one place. What never changes stands in `index.html`.

import type { MotionParts } from '../result/describe.js';
import type { Kind } from '../result/masks.js';

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

const size = (width: number, height: number): string => `${width}${NBSP}×${NBSP}${height}`;
const percent = (share: number): string => `${tenths.format(share * 100)}${NBSP}%`;
const motions = (count: number): string => (count === 1 ? 'One motion' : `${count} motions`);

export const strings = {
  slot: { first: 'First frame', second: 'Second frame' },
  split: 'First | second',
  camera: 'Camera',
  cameraFrame: 'camera',
  openCamera: 'Camera',
  closeCamera: 'Stop camera',
  size,
  percent,
  milliseconds: (ms: number): string => `${ms < 10 ? tenths.format(ms) : whole.format(ms)} ms`,
  stage,
  zoomValue: (value: string): string => `Size ${value}: show at 100 %`,
  magnified: (times: number): string => `arrows ×${times}`,

  empty: 'none yet',
  frameOf: (name: string, width: number, height: number): string => `${name}, ${size(width, height)}`,
  heldStill: (name: string): string => `, ${name} held still`,

  film: (name: string, count: number, width: number, height: number): string => `${name}, ${whole.format(count)} frames, ${size(width, height)}`,
  anotherFile: 'another file',
  frameAt: (index: number, seconds: number | null): string => (seconds === null ? `#${index}` : `#${index}, ${seconds.toFixed(3)} s`),

  motion,
  maskName: (kind: Kind, id: number): string => `${kind === 'groups' ? 'Group' : 'Motion'} ${id}`,
  noMasksYet: 'They are listed here as soon as they are found.',
  noMasks: { failed: 'There are none: nothing was segmented.', cancelled: 'There are none: the work was cancelled.' },
  liveMasks: (count: number): string => `${motions(count)} at the moment. They are listed when the camera stops.`,
  residual: (grey: number): string => `residual ${tenths.format(grey)} grey levels`,
  severalMotions: (count: number): string => `${count} motions that continue each other`,
  groupWith: (labels: readonly number[]): string => `one surface with ${labels.map((label) => `Motion ${label}`).join(', ')}`,
  unknownName: 'Cannot tell',
  unknownWords: 'no motion explains these pixels',
  entry: (value: number): string => (Math.abs(value) < 1 ? value.toFixed(6) : value.toFixed(3)),
  show: (name: string): string => `Show ${name}`,
  colourOf: (name: string): string => `Colour of ${name}`,
  nameOf: (name: string): string => `Name of ${name}`,
  soloOf: (name: string): string => `Solo: show only ${name}`,
  stillOf: (name: string): string => `Hold still: both frames in turn with ${name} held still`,
  mergeOf: (name: string): string => `Merge ${name} with another`,
  copied: (what: string, name: string): string => `The motion of ${name} is on the clipboard as ${what}.`,
  copiedText: (what: string): string => `The ${what} is on the clipboard.`,

  insistOn: (count: number, above: number): string => `${count} ${count === 1 ? 'motion' : 'motions'}: insist on it; its score is ${whole.format(above)} above the lowest`,
  scoreAbove: (above: number): string => (above === 0 ? 'lowest score' : `${whole.format(above)} above the lowest`),

  toolHelp: {
    look: '',
    brush: 'Paint what belongs to the chosen mask; the rest follows.',
    eraser: 'Paint what does not belong to the chosen mask.',
  },

  timings: {
    decode: (name: string): string => `Decoding ${name}`,
    total: 'All stages',
    waited: 'Request to answer',
  },

  status: {
    idle: 'Open two frames or a video to begin.',
    opening: 'Opening…',
    waiting: (slot: 'first' | 'second'): string => (slot === 'second' ? 'Now add the second frame.' : 'Now add the first frame.'),
    working: (name: string, index: number, of: number): string => (of > 0 ? `${stage(name)} (${index + 1} of ${of})` : 'Starting…'),
    /** `asked`: the number that was set, null where it was to be found. */
    found: (count: number, groups: number, asked: number | null, waited: number): string => {
      const among = groups === count ? '' : groups === 1 ? ' in one group' : ` in ${groups} groups`;
      const set = asked === null ? '' : count < asked ? `, fewer than the ${asked} asked for: no more could be told apart` : ', as many as asked for';
      return `${motions(count)}${among} found in ${whole.format(waited)} ms${set}.`;
    },
    /** So many of all strokes speak of masks that are there. */
    held: (held: number, all: number): string => {
      if (held === all) return all === 1 ? 'Your stroke holds.' : `Your ${all} strokes hold.`;
      if (all === 1) return 'Your stroke has no say: its mask is not among these.';
      const others = all - held === 1 ? 'mask of the other is' : 'masks of the others are';
      return held === 0 ? `Your ${all} strokes have no say: their masks are not among these.` : `${held} of your ${all} strokes ${held > 1 ? 'hold' : 'holds'}: the ${others} not among these.`;
    },
    solved: (strokes: number, waited: number): string => `Solved again under your ${strokes === 1 ? 'stroke' : 'strokes'} in ${whole.format(waited)} ms.`,
    undone: 'Undone.',
    redone: 'Done again.',
    merged: 'Merged.',
    apart: 'Taken apart.',
    restored: 'Your corrections of these frames are back.',
    live: (rate: number, count: number): string => `Live: ${tenths.format(rate)} per second, ${motions(count).toLowerCase()}.`,
    cancelled: 'Cancelled.',
    cancelledBefore: 'Cancelled. The masks are the last that were found.',
    cancelledStrokes: 'Cancelled. Your strokes are kept, but not all are solved.',
    failed: 'Nothing was segmented.',
    failedBefore: 'That failed. The masks are the last that were found.',
    failedStrokes: 'That failed. Your strokes are kept, but not all are solved.',
  },

  notices: {
    noFiles: 'There was no image or video in what you gave.',
    noMasks: 'There are no masks to paint yet.',
    chooseMask: 'Choose a mask in the list first: the brush paints it.',
    nothingElse: 'There is no other mask that it could belong to.',
    notPainted: 'The brush paints motions: choose one of them in the list, or erase this.',
  },

  errors: {
    unreadable: (name: string): string => `“${name}” is not an image that this browser can read.`,
    unreachable: (name: string): string => `“${name}” could not be loaded.`,
    tooLarge: (name: string, width: number, height: number): string => `“${name}” is too large: ${width} × ${height} pixels.`,
    unreadableVideo: (name: string): string => `“${name}” is not a video that this browser can read.`,
    unreadableFolder: (name: string): string => `The folder “${name}” cannot be read.`,
    unsupportedCodec: (name: string, codec: string, command: string): string =>
      `“${name}” is ${codec}, which this browser cannot decode. Convert it to H.264 or VP9, e.g. with \`${command}\`, or open it in a browser that plays it.`,
    slowVideo: 'The video does not answer.',
    inexactFrame: (name: string, index: number): string => `Frame ${index} of “${name}” cannot be read exactly.`,
    noCamera: 'There is no camera, or the page may not use it.',
    noCanvas: 'This browser gives no canvas to read pixels from.',
    noClipboard: 'The browser did not let the page write to the clipboard.',
    notWritten: (what: string): string => `${what} could not be made.`,
    wholeNumber: (name: string, min: number, max: number): string => `${name} must be a whole number from ${min} to ${max}.`,
  },

  keys: {
    look: {
      peek: 'The other frame, while held',
      blink: 'Both frames in turn',
      split: 'Both frames side by side, with a line to move',
      kind: 'Groups or single motions',
      outlines: 'Outlines',
      arrows: 'Arrows of the flow',
      residual: 'What the motions leave unexplained',
      zoomIn: 'Larger',
      zoomOut: 'Smaller',
      whole: 'The whole picture',
      actual: 'At 100 %: one pixel of the frame on one of the screen',
      pan: 'Move the enlarged picture',
      stepBack: 'Film: both frames one back',
      stepOn: 'Film: both frames one on',
      look: 'Look',
      brush: 'Brush: this mask',
      eraser: 'Eraser: not this mask',
      stroke: 'With the picture in focus: begin or end a stroke; arrow keys move the brush',
      thinner: 'Smaller brush',
      thicker: 'Larger brush',
      undo: 'Undo',
      redo: 'Redo',
      cancel: 'Cancel what is under way',
      keys: 'This list',
    },
  },
} as const;
