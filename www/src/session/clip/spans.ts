//! What the package is asked about frames that were segmented together: whether it still knows them, and what they become by corrections.
//! It computes the next version of the masks and shows nothing.

import type { ClipEdits, ClipFrame, ClipOptions, Segmenter } from 'veronese';
import { codeOf } from '../../common/errors.js';
import { type Runs, packed } from '../../correction/runs.js';
import { keyOf } from '../../result/masks.js';
import type { LoadedFrame } from '../../state/pair.js';
import { exactly, overlaid } from '../../state/exact.js';
import { contains, editsIn, fromSpan, spanAt, theirNumbers, toSpan, toldOf } from '../../state/spans.js';
import type { State, Store } from '../../state/state.js';
import type { Said } from '../../state/statement.js';
import { type Span, type Tracked, type TrackedFrame, type Version, acceptedIn } from '../../state/tracked.js';
import { ClipFrames } from './frames.js';

/** Memory for frames that a correction reads again, bytes. */
const ROOM = 64 << 20;

export class Spans {
  readonly #store: Store;
  readonly #segmenter: Segmenter;

  constructor(store: Store, segmenter: Segmenter) {
    this.#store = store;
    this.#segmenter = segmenter;
  }

  /** Whether the package reads what it knows of these frames: another version of it may not. */
  async areReadable({ clip, longestSide, spans: [span] }: Tracked): Promise<boolean> {
    if (span === undefined) return true; // all are of one version
    const frames = new ClipFrames(clip, longestSide, span.range);
    try {
      await this.#segmenter.segmentClip(frames, { state: await bytesOf(span.state), changesOnly: true }).next();
      return true;
    } catch (error) {
      return codeOf(error) !== 'invalid-option';
    }
  }

  /**
   * Says in a span what is new there, and what became of objects. `changes` takes frames as they change, perhaps not for the last time.
   */
  corrected(version: Version, span: Span, said: readonly Said[], signal: AbortSignal, changes: (index: number, masks: TrackedFrame) => void): Promise<Version> {
    const accepted = acceptedIn(version).filter((index) => spanAt(version.spans, index) === span);
    return this.#answer(version, span, signal, changes, (numbers) => ({
      ...toldOf(said, span.range, numbers),
      accepted: accepted.map((index) => index - span.range.first),
      locked: theirNumbers(numbers, version.became, (id) => version.locked.has(id)),
      names: namesIn(version, numbers),
    }));
  }

  /**
   * Says in a span that was segmented again all that was said, and then that frames are accepted, with their labels by index. What was locked and
   * named since is protected from what is said next.
   */
  async repeated(version: Version, span: Span, accepted: ReadonlyMap<number, Runs>, signal: AbortSignal): Promise<Version> {
    const { range } = span;
    const said = version.said.filter(({ frame }) => contains(range, frame));
    const after = await this.#answer(version, span, signal, null, (numbers) => ({ ...toldOf(said, range, numbers), accepted: [], locked: [], names: {} }));
    if (accepted.size === 0 || signal.aborted) return after;
    return this.#answer(after, after.spans[version.spans.indexOf(span)]!, signal, null, (numbers) => ({
      accepted: [...accepted].map(([index, runs]) => ({ frame: index - range.first, labels: toSpan(runs, numbers) })),
      locked: [],
      names: {},
    }));
  }

  async #answer(
    version: Version,
    span: Span,
    signal: AbortSignal,
    changes: ((index: number, masks: TrackedFrame) => void) | null,
    tell: (numbers: Map<number, number>) => Pick<ClipOptions, 'corrections' | 'prompts' | 'accepted' | 'locked'> & Pick<ClipEdits, 'names'>,
  ): Promise<Version> {
    const { tracked, settings, pair } = this.#store.get();
    if (tracked === null) return version;
    const { first } = span.range;
    const numbers = new Map(span.numbers);
    const frames = framesOf(tracked, version, span, pair);
    let { largest } = version;
    const numbered = (frame: ClipFrame): TrackedFrame => {
      const masks = overlaid(fromSpan(masksOf(frame, frames.size), numbers, largest), version.exact.get(first + frame.index));
      largest = Math.max(largest, ...masks.objects.map(({ id }) => id));
      return masks;
    };
    const isOwn = (index: number): boolean => spanAt(version.spans, index) === span;
    const onChange = async (index: number, segmented: () => Promise<ClipFrame>): Promise<void> => {
      if (!isOwn(first + index)) return;
      const frame = await segmented();
      if (!signal.aborted) changes?.(first + index, numbered(frame));
    };
    const { names, ...told } = tell(numbers);
    const found = this.#segmenter.segmentClip(frames, {
      ...told,
      state: await bytesOf(span.state),
      markUnknown: settings.markUnknown,
      changesOnly: true,
      signal,
      transfer: true,
      edits: { ...editsIn(numbers, version.became), names },
      ...(changes && { onChange }),
    });
    const masks = [...version.frames];
    for await (const frame of found) {
      const is = numbered(frame);
      if (isOwn(first + frame.index)) masks[first + frame.index] = is;
    }
    const state = await found.state();
    if (state === undefined) return version;
    const spans = version.spans.map((other) => (other === span ? { ...span, state: blobOf(state), numbers } : other));
    return exactly({ ...version, frames: masks, spans, largest });
  }
}

/** The frames of a span as a correction reads them, several times: those on screen need no decoding. */
function framesOf({ clip }: Tracked, { longestSide }: Version, { range }: Span, { first, second }: State['pair']): ClipFrames {
  const hand = [first, second].filter((frame): frame is LoadedFrame => frame !== null);
  return new ClipFrames(clip, longestSide, range, { hand, room: ROOM });
}

/** The names that a person gave to objects, by the package's numbers: other corrections leave them as they are. */
function namesIn({ names, became }: Version, numbers: ReadonlyMap<number, number>): Record<number, string> {
  return Object.fromEntries([...numbers].flatMap(([there, here]) => {
    const name = names[keyOf('objects', became.get(here) ?? here)];
    return name === undefined ? [] : [[there, name]];
  }));
}

export async function bytesOf(blob: Blob): Promise<Uint8Array> {
  return new Uint8Array(await blob.arrayBuffer());
}

export function blobOf(bytes: Uint8Array): Blob {
  return new Blob([new Uint8Array(bytes)]);
}

export function masksOf({ labels, objects, background }: ClipFrame, { width, height }: ClipFrames['size']): TrackedFrame {
  return { runs: packed(labels, width, height), objects, background };
}
