// The frames and options of a clip, checked.

import type { ClipOptions, ClipProgress } from '../../../types/index.js';
import { checkedBytes, entriesOf, invalidInput, invalidOption, isListOf, isWhole } from '../../common/checks.js';
import { VeroneseError } from '../../common/errors.js';
import type { Settings } from '../messages.js';
import { taken } from '../taking.js';
import { parted } from '../tasks.js';
import { reads, upTo } from './frames.js';
import { type Edits, editsOf, isObjectNumber, RANGE, withMerged } from './edits.js';
import { checkedAnnotations, checkUnlocked, type FrameAnnotations } from './annotations.js';

/** Default look-ahead of a stream, frames: the longest there is. */
const LOOK_AHEAD_OF_STREAMS = 8;

const OF_ALL = ['motions', 'quality', 'markUnknown', 'subject', 'lookAhead', 'maxSize'];
/** Options that need frames which can be read again. */
const OF_WHOLE = ['masks', 'corrections', 'prompts', 'accepted', 'edits', 'locked', 'state', 'changesOnly', 'onChange', 'knownPairs', 'onPairs', 'onPreview'] as const;

/** Frames that come once. */
export interface Stream {
  each: Iterable<unknown> | AsyncIterable<unknown>;
  /** Number of frames, if known. */
  length: number | undefined;
  /** Where frames can be read again all the same. */
  again?: (index: number) => unknown;
}

/** Frames that can be read again. */
export interface Whole {
  read: (index: number) => unknown;
  length: number;
}

export interface CheckedOptions extends FrameAnnotations, Pick<ClipOptions, 'signal' | 'onChange' | 'knownPairs' | 'onPairs' | 'onPreview'> {
  source: Stream | Whole;
  onProgress: ((progress: ClipProgress) => void) | undefined;
  transfer: boolean;
  maxSize: number | undefined;
  settings: Settings;
  /** Not looked at yet, but the call's own. */
  masks: unknown;
  edits: Edits;
  /** Undefined if not given. */
  locked: Uint8Array | undefined;
  state: Uint8Array | undefined;
  changesOnly: boolean;
}

export function checkedOptions(frames: unknown, options: unknown): CheckedOptions {
  const given = entriesOf(options, [...OF_ALL, ...OF_WHOLE, 'signal', 'onProgress', 'transfer']);
  const { masks, corrections, prompts, accepted, edits = {}, locked, state, changesOnly = false, onChange, knownPairs, onPairs, onPreview, ...rest } = given;
  const { call, transfer, maxSize, settings } = parted(rest, OF_ALL);
  const name = OF_WHOLE.find((name) => given[name] !== undefined && (name !== 'changesOnly' || changesOnly !== false));
  const source = sourceOf(frames, settings['lookAhead'], name);
  if (typeof changesOnly !== 'boolean') throw invalidOption('changesOnly', 'true or false', changesOnly);
  for (const [name, listener] of Object.entries({ onChange, knownPairs, onPairs, onPreview })) {
    if (listener !== undefined && typeof listener !== 'function') throw invalidOption(name, 'a function', listener);
  }
  const known = editsOf(edits, (reason) => new VeroneseError('invalid-option', `option 'edits': ${reason}`));
  const annotations = checkedAnnotations({ corrections, prompts, accepted }, source.length ?? 0);
  const all = lockedOf(locked, known);
  // In a state, the object may be gone already.
  if (state === undefined) checkUnlocked(all, known.numbers);
  return {
    source,
    signal: call.signal,
    onProgress: call.onProgress as CheckedOptions['onProgress'],
    transfer,
    maxSize,
    settings: { lookAhead: 'read' in source ? 'all' : LOOK_AHEAD_OF_STREAMS, ...settings },
    masks: structuredClone(masks),
    ...annotations,
    edits: known,
    locked: all,
    state: state === undefined ? undefined : (taken([checkedBytes('the state', state)], false)[0] as Uint8Array),
    changesOnly,
    onChange: onChange as CheckedOptions['onChange'],
    knownPairs: knownPairs as CheckedOptions['knownPairs'],
    onPairs: onPairs as CheckedOptions['onPairs'],
    onPreview: onPreview as CheckedOptions['onPreview'],
  };
}

/** `option`: one that needs frames which can be read again, if there is any. */
function sourceOf(frames: unknown, lookAhead: unknown, option: string | undefined): Stream | Whole {
  const { length, read } = Object(frames) as { length: unknown; read: unknown };
  const needed = option ?? (lookAhead === 'all' ? 'lookAhead' : undefined);
  if (typeof read === 'function') {
    if (!isWhole(length, 0, Infinity)) throw invalidInput("the frames: 'length' must be a whole number");
    const readable = frames as { read: (index: number) => unknown };
    const read = (index: number) => readable.read(index);
    return needed !== undefined || lookAhead === undefined ? { length, read } : { length, each: reads(read, upTo(length)), again: read };
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

/** Those of the option and of the edits. */
function lockedOf(option: unknown, { numbers, locked }: Edits): Uint8Array | undefined {
  if (option === undefined) return locked;
  if (!isListOf(option, isObjectNumber)) throw invalidOption('locked', `a list of objects, ${RANGE}`, option);
  return withMerged([...option, ...(locked ?? [])], numbers);
}
