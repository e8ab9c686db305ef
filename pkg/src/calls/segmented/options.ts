// The frames and options of a clip, checked.

import { checkedBytes, entriesOf, invalidInput, invalidOption, isListOf, isWhole } from '../../common/checks.js';
import { VeroneseError } from '../../common/errors.js';
import type { Settings } from '../messages.js';
import { taken } from '../taking.js';
import { parted } from '../tasks.js';
import type { ClipOptions, ClipProgress } from './types.js';
import { type Edits, editsOf, isObjectNumber, RANGE, withMerged } from './edits.js';
import { checkedAnnotations, checkUnlocked, type FrameAnnotations } from './annotations.js';

const OF_ALL = ['motions', 'quality', 'markUnknown', 'subject', 'lookAhead', 'maxSize'];
const OF_WHOLE = [
  'corrections',
  'prompts',
  'accepted',
  'edits',
  'locked',
  'state',
  'changesOnly',
  'onChange',
  'knownPairs',
  'onPairs',
  'onPreview',
] as const;

/** Frames that can be read again. */
export interface Whole {
  read: (index: number) => unknown;
  length: number;
}

export interface CheckedOptions
  extends FrameAnnotations, Pick<ClipOptions, 'signal' | 'onChange' | 'knownPairs' | 'onPairs' | 'onPreview'> {
  source: Whole;
  onProgress: ((progress: ClipProgress) => void) | undefined;
  transfer: boolean;
  maxSize: number | undefined;
  settings: Settings;
  edits: Edits;
  /** Undefined if not given. */
  locked: Uint8Array | undefined;
  state: Uint8Array | undefined;
  changesOnly: boolean;
}

export function checkedOptions(frames: unknown, options: unknown): CheckedOptions {
  const given = entriesOf(options, [...OF_ALL, ...OF_WHOLE, 'signal', 'onProgress', 'transfer']);
  const {
    corrections,
    prompts,
    accepted,
    edits = {},
    locked,
    state,
    changesOnly = false,
    onChange,
    knownPairs,
    onPairs,
    onPreview,
    ...rest
  } = given;
  const { call, transfer, maxSize, settings } = parted(rest, OF_ALL);
  const source = sourceOf(frames);
  if (typeof changesOnly !== 'boolean') throw invalidOption('changesOnly', 'true or false', changesOnly);
  for (const [name, listener] of Object.entries({ onChange, knownPairs, onPairs, onPreview })) {
    if (listener !== undefined && typeof listener !== 'function') throw invalidOption(name, 'a function', listener);
  }
  const known = editsOf(edits, (reason) => new VeroneseError('invalid-option', `option 'edits': ${reason}`));
  const annotations = checkedAnnotations({ corrections, prompts, accepted }, source.length);
  const all = lockedOf(locked, known);
  // In a state, the object may be gone already.
  if (state === undefined) checkUnlocked(all, known.numbers);
  return {
    source,
    signal: call.signal,
    onProgress: call.onProgress as CheckedOptions['onProgress'],
    transfer,
    maxSize,
    settings: { lookAhead: 'all', ...settings },
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

function sourceOf(frames: unknown): Whole {
  const { length, read } = Object(frames) as { length: unknown; read: unknown };
  if (typeof read !== 'function' || !isWhole(length, 0, Infinity))
    throw invalidInput("the frames must be { length, read(index) }, 'length' a whole number");
  return { length, read: (index) => (frames as Whole).read(index) };
}

/** Those of the option and of the edits. */
function lockedOf(option: unknown, { numbers, locked }: Edits): Uint8Array | undefined {
  if (option === undefined) return locked;
  if (!isListOf(option, isObjectNumber)) throw invalidOption('locked', `a list of objects, ${RANGE}`, option);
  return withMerged([...option, ...(locked ?? [])], numbers);
}
