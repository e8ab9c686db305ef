// What is asked of a clip: its frames and options, checked.

import type { ClipOptions, ClipProgress } from '../../../types/index.js';
import {
  checkAttached,
  checkedBytes,
  entriesOf,
  invalidInput,
  invalidOption,
  isArrayOf,
  isListOf,
  isObject,
  isWhole,
} from '../../common/checks.js';
import { VeroneseError } from '../../common/errors.js';
import type { Settings } from '../messages.js';
import { taken } from '../taking.js';
import { parted } from '../tasks.js';
import { type Edits, editsOf } from './edits.js';

/** Default look-ahead of a stream, frames: the longest there is. */
const LOOK_AHEAD_OF_STREAMS = 8;

const OF_ALL = ['motions', 'quality', 'markUnknown', 'seed', 'lookAhead'];
/** Options that need frames which can be read again. */
const OF_WHOLE = ['corrections', 'edits', 'state', 'changesOnly', 'knownPairs', 'onPairs'] as const;

/** Frames that come once. */
export interface Stream {
  each: Iterable<unknown> | AsyncIterable<unknown>;
  /** Number of frames, if known. */
  length: number | undefined;
}

/** Frames that can be read again. */
export interface Whole {
  read: (index: number) => unknown;
  length: number;
}

/** What is said of a frame. */
interface Correction {
  frame: number;
  labels: Uint8Array;
}

export interface Asked extends Pick<ClipOptions, 'signal' | 'knownPairs' | 'onPairs'> {
  source: Stream | Whole;
  onProgress: ((progress: ClipProgress) => void) | undefined;
  transfer: boolean;
  settings: Settings;
  corrections: Correction[];
  edits: Edits;
  state: Uint8Array | undefined;
  changesOnly: boolean;
}

export function asked(frames: unknown, options: unknown): Asked {
  const given = entriesOf(options, [...OF_ALL, ...OF_WHOLE, 'signal', 'onProgress', 'transfer']);
  const { corrections = [], edits = {}, state, changesOnly = false, knownPairs, onPairs, ...rest } = given;
  const { call, transfer, settings } = parted(rest, OF_ALL);
  const name = OF_WHOLE.find((name) => given[name] !== undefined && given[name] !== false);
  const source = sourceOf(frames, settings['lookAhead'], name);
  if (typeof changesOnly !== 'boolean') throw invalidOption('changesOnly', 'true or false', changesOnly);
  for (const [name, listener] of Object.entries({ knownPairs, onPairs })) {
    if (listener !== undefined && typeof listener !== 'function') throw invalidOption(name, 'a function', listener);
  }
  return {
    source,
    signal: call.signal,
    onProgress: call.onProgress as Asked['onProgress'],
    transfer,
    settings: { lookAhead: 'read' in source ? 'all' : LOOK_AHEAD_OF_STREAMS, ...settings },
    corrections: checkedCorrections(corrections, source.length ?? 0),
    edits: editsOf(edits, (reason) => new VeroneseError('invalid-option', `option 'edits': ${reason}`)),
    state: state === undefined ? undefined : (taken([checkedBytes('the state', state)], false)[0] as Uint8Array),
    changesOnly,
    knownPairs: knownPairs as Asked['knownPairs'],
    onPairs: onPairs as Asked['onPairs'],
  };
}

/** `option`: one that needs frames which can be read again, if there is any. */
function sourceOf(frames: unknown, lookAhead: unknown, option: string | undefined): Stream | Whole {
  const { length, read } = Object(frames) as { length: unknown; read: unknown };
  const needed = option ?? (lookAhead === 'all' ? 'lookAhead' : undefined);
  if (typeof read === 'function') {
    if (!isWhole(length, 0, Infinity)) throw invalidInput("the frames: 'length' must be a whole number");
    const readable = frames as { read: (index: number) => unknown };
    if (needed !== undefined || lookAhead === undefined) return { length, read: (index) => readable.read(index) };
    return { length, each: readEach(readable, length) };
  }
  const source = Object(frames) as Partial<Iterable<unknown> & AsyncIterable<unknown>>;
  if (typeof source[Symbol.asyncIterator] !== 'function' && typeof source[Symbol.iterator] !== 'function') {
    throw invalidInput('the frames must be an iterable or async iterable of pixels, or { length, read(index) }');
  }
  if (needed === undefined) return { each: source as Stream['each'], length: undefined };
  if (Array.isArray(frames)) return { length: frames.length, read: (index) => frames[index] };
  const sentence = 'needs frames that can be read again: an array, or { length, read(index) }';
  throw new VeroneseError('invalid-option', `option '${needed}': ${sentence}`);
}

function* readEach(frames: { read: (index: number) => unknown }, length: number): Generator<unknown, void, undefined> {
  for (let index = 0; index < length; index++) yield frames.read(index);
}

function checkedCorrections(corrections: unknown, length: number): Correction[] {
  if (!isListOf(corrections, isObject)) throw invalidOption('corrections', 'a list of { frame, labels }', corrections);
  const seen = new Set<unknown>();
  return corrections.map(({ frame, labels }, at) => {
    const wrong = (reason: string) => new VeroneseError('invalid-option', `option 'corrections': number ${at} ${reason}`);
    if (!isWhole(frame, 0, length - 1)) throw wrong(`must have a frame from 0 to ${length - 1}`);
    if (seen.has(frame)) throw wrong(`corrects frame ${frame}, as one before does`);
    seen.add(frame);
    if (!isArrayOf(labels, 'Uint8Array', 'Uint8ClampedArray')) throw wrong('must have labels, a Uint8Array');
    checkAttached(`the labels of correction ${at}`, labels);
    return { frame, labels: taken([labels], false)[0] as Uint8Array };
  });
}
