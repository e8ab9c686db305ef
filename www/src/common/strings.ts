//! The texts that say what is so now. Labels that do not change stand in the components and in `index.html`, and texts about masks that are
//! imported with what reads them, which is loaded later.

import type { Note } from 'veronese';
import type { MotionParts } from '../result/describe.js';

const decimals = (digits: number): Intl.NumberFormat => new Intl.NumberFormat('en', { maximumFractionDigits: digits });
const tenths = decimals(1);
const hundredths = decimals(2);
const whole = decimals(0);

/** Keeps a number and its unit on one line. */
const NBSP = '\u00a0';

/** Two decimals below one, one decimal above. */
function amount(value: number): string {
  const size = Math.abs(value);
  return (size < 1 ? hundredths : tenths).format(size);
}

/** "moves 4.1 px right, 0.2 px up; turns 1.2° clockwise; grows 0.5 %". */
function motion(parts: MotionParts): string {
  const words: string[] = [];
  const moves: string[] = [];
  if (parts.right !== 0) moves.push(`${amount(parts.right)}${NBSP}px ${parts.right > 0 ? 'right' : 'left'}`);
  if (parts.down !== 0) moves.push(`${amount(parts.down)}${NBSP}px ${parts.down > 0 ? 'down' : 'up'}`);
  if (moves.length > 0) words.push(`moves ${moves.join(', ')}`);
  if (parts.turn !== 0) words.push(`turns ${amount(parts.turn)}° ${parts.turn > 0 ? 'clockwise' : 'anticlockwise'}`);
  if (parts.growth !== 0) words.push(`${parts.growth > 0 ? 'grows' : 'shrinks'} ${amount(parts.growth * 100)}${NBSP}%`);
  if (parts.stretch !== 0) words.push(`stretches ${amount(parts.stretch * 100)}${NBSP}%`);
  return words.length > 0 ? words.join('; ') : 'stands still';
}

/** From right, clockwise. */
const DIRECTIONS = ['right', 'to the lower right', 'down', 'to the lower left', 'left', 'to the upper left', 'up', 'to the upper right'];

/** "14 px down"; for what stays in place, what else it does. */
function displacement(parts: MotionParts): string {
  const { right, down } = parts;
  if (right === 0 && down === 0) return motion(parts);
  const length = Math.hypot(right, down);
  const eighth = Math.round((Math.atan2(down, right) * 4) / Math.PI);
  return `${length < 10 ? amount(length) : whole.format(length)}${NBSP}px ${DIRECTIONS[(eighth + 8) % 8]}`;
}

const frames = (count: number): string => (count === 1 ? 'one frame' : `${whole.format(count)} frames`);

const images = (count: number): string => (count === 1 ? 'one image' : `${whole.format(count)} images`);

interface Size {
  readonly width: number;
  readonly height: number;
}

/** ", about 20 s left"; nothing if it is not known. */
function remaining(seconds: number | null): string {
  if (seconds === null) return '';
  return seconds < 90 ? `, about ${whole.format(Math.max(1, seconds))}${NBSP}s left` : `, about ${whole.format(seconds / 60)}${NBSP}min left`;
}

const size = (width: number, height: number): string => `${width}${NBSP}×${NBSP}${height}`;
const percent = (share: number): string => `${tenths.format(share * 100)}${NBSP}%`;
const duration = (ms: number): string => (ms < 1000 ? `${whole.format(ms)}${NBSP}ms` : `${tenths.format(ms / 1000)}${NBSP}s`);
const motions = (count: number): string => (count === 1 ? 'One motion' : `${count} motions`);
const objects = (count: number): string => (count === 0 ? 'No objects' : count === 1 ? 'One object' : `${count} objects`);

const date = new Intl.DateTimeFormat('en-GB', { dateStyle: 'medium', timeStyle: 'short' });
const day = new Intl.DateTimeFormat('en-GB', { day: 'numeric', month: 'short' });
const time = new Intl.DateTimeFormat('en-GB', { timeStyle: 'short' });

/** "10:31" of today, "26 Nov" of another day. */
function when(at: Date): string {
  return at.toDateString() === new Date().toDateString() ? time.format(at) : day.format(at).replaceAll(' ', NBSP);
}

function fileSize(bytes: number): string {
  if (bytes < 1000) return `${bytes}${NBSP}B`;
  return bytes < 1e6 ? `${tenths.format(bytes / 1e3)}${NBSP}kB` : `${tenths.format(bytes / 1e6)}${NBSP}MB`;
}

const descriptionOf = (longer: number): string => (longer === 0 ? 'shortest description' : `description ${whole.format(longer)} longer than the shortest`);

/** An answer, and what the package has to say of it. */
export function withNotes(answer: string, notes: readonly Pick<Note, 'message'>[] = []): string {
  return [answer, ...notes.map(({ message }) => `${message.charAt(0).toUpperCase()}${message.slice(1)}.`)].join(' ');
}

const TOOLS = {
  brush: 'Paint what belongs to the selected object.',
  eraser: 'Paint what does not belong to the selected object.',
  polygon: 'Press corners around the selected object, then the first again; with Shift what is inside is removed.',
  box: 'Drag a box around something, or press on it: it becomes a new object.',
};

export const strings = {
  oneFrame: 'First frame',
  frameNumber: (index: number): string => `Frame ${index}`,
  motionsOf: (seen: string): string => `Motions: ${seen.charAt(0).toLowerCase()}${seen.slice(1)}`,
  camera: 'Camera',
  cameraFrame: 'camera',
  openCamera: 'Camera',
  closeCamera: 'Stop camera',
  size,
  percent,
  zoomValue: (value: string): string => `Zoom ${value}: set to 100 %`,

  /** What frames are called that came without a folder. */
  fromTo: (first: string, last: string, count: number): string => `${first} ${count === 2 ? 'and' : 'to'} ${last}`,
  clipFacts: (count: number, width: number, height: number): string => `${frames(count)}, ${size(width, height)}`,
  imagesIn: (folder: string, count: number): string => `${folder === '' ? 'No folder' : folder}, ${images(count)}`,
  allImages: (count: number): string => `All ${images(count)}, folder by folder`,

  tracking: {
    segment: 'Segment the clip',
    segmentRange: (first: number, last: number): string => `Segment frames ${first}–${last}`,
    again: 'Segment the clip again',
    resume: 'Continue',
    pairs: (done: number, of: number, left: number | null): string => (done < of ? `${whole.format(done)} of ${frames(of)}${remaining(left)}` : 'Following the objects…'),
    corrections: 'Carrying your correction to other frames…',
    carried: (done: number, of: number, left: number | null): string => `${whole.format(done)} of ${frames(of)}${remaining(left)}`,
    labels: (done: number, of: number): string => `Masks of ${whole.format(done)} of ${frames(of)}`,
    started: 'Segmenting…',
    drafting: 'Segmenting… Drafts for now.',
    /** `kept`: accepted frames that it came to. */
    corrected: (changed: number, kept: number): string =>
      `Corrected: the masks of ${frames(changed)} have changed.${kept === 0 ? '' : kept === 1 ? ' One accepted frame stays as it is.' : ` ${whole.format(kept)} accepted frames stay as they are.`}`,
    undone: (changed: number): string => `Undone${changed > 0 ? ` in ${frames(changed)}` : ''}.`,
    redone: (changed: number): string => `Redone in ${frames(changed)}.`,
    locked: (): string => 'Locked.',
    unlocked: (): string => 'Unlocked.',
    accepted: (): string => 'Accepted.',
    described: (): string => 'Changed.',
    found: (count: number, of: number, notes: readonly Note[] = []): string => withNotes(`${objects(count)} in ${frames(of)}.`, notes),
    same: (_count: number, of: number): string => `No objects: all ${frames(of)} are the same, pixel by pixel.`,
    repeated: (count: number, of: number): string => `${objects(count)} in ${frames(of)}, corrected as before.`,
    continued: (count: number, of: number): string => `Continued: ${objects(count).toLowerCase()} in ${frames(of)}.`,
    cancelled: (done: number, of: number): string => `Cancelled. ${whole.format(done)} of ${frames(of)} ${done === 1 ? 'has' : 'have'} masks.`,
    failed: (done: number, of: number): string => `The clip could not be segmented to its end. ${whole.format(done)} of ${frames(of)} ${done === 1 ? 'has' : 'have'} masks.`,
  },
  projects: {
    waiting: (name: string): string => `The project of “${name}” is open. Now open its frames, which are not part of the file.`,
    full: 'There is no room left to keep your work in this browser. It is still open here: save the project, or forget old ones.',
    refused: 'This browser does not allow the page to keep your work. It is still open here: save the project before you leave.',
    elsewhere: (name: string): string =>
      `“${name}” is open in another tab, whose work is kept. What you do here is not: save the project before you leave, or close the other tab and reload this one.`,
    otherFrames: (name: string, saved: number, now: number): string => `The project of “${name}” has ${frames(saved)}, but this browser finds ${frames(now)}.`,
    keeping: ({ is, without = false }: { readonly is: 'nothing' | 'kept' | 'refused'; readonly without?: boolean }): string => {
      if (is === 'nothing') return 'What you do is kept in this browser, with a copy of the frames if there is room.';
      if (is === 'refused') return 'Your work is not kept in this browser. Save the project before you leave.';
      return without ? 'Your work is kept in this browser. Open the same frames again to continue.' : 'Your work is kept in this browser, with its frames.';
    },
    nothingYet: 'There is nothing to save yet: segment the clip or correct the masks first.',
    saved: (name: string): string => `Saved as ${name}.`,
    damaged: (name: string): string => `The project “${name}” is damaged and cannot be opened.`,
    newer: (name: string): string => `The project “${name}” was made by a newer version of this page.`,
    savedHere: (at: number, without: boolean): readonly string[] => ['Saved', without ? ' without its frames' : ' in this browser', `, ${time.format(at)}`],
    notSaved: {
      'storage-full': ['Not saved', ': no room is left', ''],
      'storage-refused': ['Not saved', ': the browser refused', ''],
      'open-elsewhere': ['Not saved', ': open in another tab', ''],
    },
    firstSaved: 'Your work is saved in this browser.',
    welcome: 'Find everything that moves.',
    continue: 'Continue your work',
    left: (count: number, saved: Date, hasFrames: boolean): string => `${frames(count)}, ${when(saved)}${hasFrames ? '' : ': choose the frames'}`,
    more: (count: number): string => `${count} more`,
    summary: (count: number): string => (count === 1 ? 'One project in this browser' : `${count} projects in this browser`),
    facts: (count: number, bytes: number, saved: Date): string => `${frames(count)}, ${fileSize(bytes)}, ${date.format(saved).replaceAll(' ', NBSP)}`,
    forget: 'Forget',
    forgetOf: (name: string): string => `Forget the project of ${name}`,
    forgotten: (name: string): string => `The project of “${name}” is forgotten.`,
  },
  frameHas: (count: number): string => `${objects(count)} in this frame.`,
  draft: 'Draft',
  notTracked: 'This frame has no masks yet.',
  play: 'Play',
  pause: 'Pause',
  speed: (times: number): string => `${{ 0.25: '¼', 0.5: '½' }[times] ?? times}×`,
  speedIs: (times: number): string => `Speed ${strings.speed(times)}`,
  frameSlider: (index: number, count: number, seconds: number | null): string =>
    `Frame ${index} of 0–${count - 1}${seconds === null ? '' : `, ${seconds.toFixed(2)} s`}`,
  life: (first: number, last: number): string => (first === last ? `frame ${first} only` : `frames ${first} to ${last}`),
  away: 'not in this frame',
  mergeWith: 'Merge with…',
  newObjectHelp: 'Paint it in any frame.',
  takeOf: (name: string): string => `Make an object of ${name}: these pixels become one, which is followed to other frames`,
  splitOf: (name: string): string => `Split ${name}: its smaller pieces in this frame become another object`,
  lockOf: (name: string): string => `Lock ${name}`,
  othersOf: (verb: string, name: string): string => `${verb} all objects but ${name}`,
  removeOf: (name: string): string => `Delete ${name}: it becomes background in the whole clip`,
  selectObject: (name: string): string => `Select ${name}`,
  doubtful: (index: number): string => `Check #${index}`,
  doubtfulOf: (name: string, index: number): string => `Check #${index}, the frame where ${name} is least certain`,

  motion,
  displacement,
  objectName: (id: number): string => (id === 0 ? 'Background' : `Object ${id}`),
  motionName: (label: number): string => (label === 0 ? 'Background' : `Motion ${label}`),
  noMasksYet: 'Masks appear here once they are found.',
  liveMasks: (count: number): string => `${objects(count)} at the moment. Stop the camera to segment its last two frames.`,
  residual: (grey: number): string => `residual ${tenths.format(grey)} grey levels`,
  groupWith: (labels: readonly number[]): string => `moves with ${labels.map((label) => strings.motionName(label)).join(', ')}`,
  unknownName: 'Unlabelled',
  entry: (value: number): string => (Math.abs(value) < 1 ? value.toFixed(6) : value.toFixed(3)),
  show: (name: string): string => `Show ${name}`,
  colourOf: (name: string): string => `Colour of ${name}`,
  nameOf: (name: string): string => `Name of ${name}`,
  soloOf: (name: string): string => `Solo: show only ${name}`,
  mergeWithOf: (name: string): string => `Mask to merge ${name} with`,
  mergeOf: (name: string): string => `Merge ${name} with the chosen mask`,
  copied: (what: string, name: string): string => `Copied the motion of ${name} to the clipboard as ${what}.`,
  copiedText: (what: string): string => `Copied the ${what} to the clipboard.`,

  newObject: 'New object',
  pointingHelp: {
    new: 'Drag a box around something, or press on it: it becomes a new object. Shift adds to the selected one, Alt removes.',
    add: 'Press on what also belongs to the selected object, or drag a box around all of it.',
    remove: 'Press on what does not belong to the selected object.',
  },
  /** `why`: why nothing can be drawn. */
  toolHelp: (tool: keyof typeof TOOLS, isExact: boolean, isBackground: boolean, why: string | null): string => {
    if (why !== null) return why;
    if (isBackground && tool === 'eraser') return 'Background is selected, and cannot be erased: select an object first.';
    if (isBackground && tool !== 'box') return `Background is selected: what you ${tool === 'brush' ? 'paint' : 'outline'} is taken away from objects.`;
    return `${TOOLS[tool]} ${isExact ? 'Nothing else changes.' : 'The other frames follow.'}`;
  },

  tab: {
    working: (share: number | null, name: string): string => `${share === null ? '…' : `${whole.format(100 * share)}${NBSP}%`} ${name}`,
    done: (name: string): string => `✓ ${name}`,
    stopped: (name: string): string => `✗ ${name}`,
  },
  changedFrames: (count: number): string => `${whole.format(count)} changed`,
  accepted: (count: number, of: number): string => `${whole.format(count)} of ${whole.format(of)} accepted`,

  status: {
    idle: 'Open two frames or a video to begin.',
    opening: 'Opening…',
    waiting: 'Now add the second frame.',
    live: (rate: number, count: number): string => `Live: ${tenths.format(rate)} frames per second, ${objects(count).toLowerCase()}.`,
  },

  inspect: {
    finding: 'Finding the motions…',
    waits: 'The motions are found when the clip rests.',
    failed: 'The motions could not be found.',
    found: (count: number, waited: number): string => `${motions(count)} from the first frame to the second, found in ${duration(waited)}.`,
  },

  selected: (count: number): string => `${whole.format(count)} selected`,
  classOf: (name: string): string => `Class of ${name}`,

  exporting: (done: number, of: number): string => `${whole.format(done)} of ${frames(of)}`,
  exported: (count: number, of: number): string => `Saved: ${objects(count).toLowerCase()} in ${frames(of)}.`,
  preview: {
    files: (count: number): string => `, ${whole.format(count)}${NBSP}files`,
    noMasks: 'There are no masks of this frame.',
    ofFrame: (name: string, bytes: number): string => `${name}: ${fileSize(bytes)}`,
    ofAll: (name: string, index: number, bytes: number): string => `${name} with frame ${index} alone: ${fileSize(bytes)}`,
    picture: (index: number): string => `Masks of frame ${index} as they are saved`,
  },

  descriptionOf,
  /** Why the number found has not the shortest description. */
  otherThanShortest: (found: number, shortest: number): string =>
    `Automatic took ${found}, though ${shortest} has the shortest description: these lengths are a check made afterwards, and do not decide.`,

  notices: {
    noFiles: 'There is no image or video among these files.',
    chooseMask: 'Select a mask in the list first.',
    nothingElse: 'There is no other mask that these pixels could belong to.',
    leftOut: (folder: string, count: number): string => `Opened the images of “${folder}”. ${images(count)} of other folders ${count === 1 ? 'is' : 'are'} left out.`,
    nothingTicked: 'Tick an object in the list first.',
    notReady: 'Segment the clip first.',
    drafts: 'These masks are drafts. They can be changed and exported when the clip is segmented.',
    nothingThere: 'There is nothing there that is not an object already.',
    noPrompt: 'Clicks refine an object that a box or a press made in this frame. Select it first.',
    isLocked: (name: string): string => `${name} is locked, so nothing changes it. Unlock it first.`,
    noFrameThere: 'There is no segmented frame on that side.',
    locked: 'What you painted belongs to an object with a lock or a name, so it stays.',
    otherState:
      'These masks were made by another version of this page, or in a browser that reads the frames differently. ' +
      'They stay and can be exported. To correct them, segment the clip again.',
    onePiece: 'The object is in one piece in this frame. Choose “New object” and paint the part that is another.',
    tooMany: 'There are 254 objects, and there cannot be more.',
    notPainted: 'The brush cannot make pixels unlabelled. Select another mask, or use the eraser.',
  },

  errors: {
    unreadable: (name: string): string => `“${name}” is not an image that this browser can read.`,
    unreachable: (name: string): string => `“${name}” could not be loaded.`,
    otherSize: (name: string, other: Size, all: Size): string =>
      `“${name}” is ${size(other.width, other.height)}, the first frame ${size(all.width, all.height)}: only what is before it can be segmented as a clip.`,
    tooLarge: (name: string, width: number, height: number): string => `“${name}” is too large: ${width} × ${height} pixels.`,
    unreadableVideo: (name: string): string => `“${name}” is not a video that this browser can read.`,
    unreadableFolder: (name: string): string => `The folder “${name}” cannot be read.`,
    unsupportedCodec: (name: string, codec: string, command: string): string =>
      `“${name}” is ${codec}, which this browser cannot decode. Convert it to H.264 or VP9, e.g. with \`${command}\`, or open it in a browser that plays it.`,
    inexactFrame: (name: string, index: number): string => `Frame ${index} of “${name}” cannot be read exactly.`,
    noCamera: 'There is no camera, or the page has no permission to use it.',
    noCanvas: 'This browser cannot read pixels from a canvas.',
    noClipboard: 'The browser did not allow writing to the clipboard.',
    notLoaded: 'A part of the page could not be loaded. Check the connection and try again.',
    notExported: (what: string, why: string): string => `${what} could not be exported${why === '' ? '' : `: ${why}`}.`,
  },
} as const;
