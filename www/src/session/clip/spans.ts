//! What the package is asked about frames that were segmented together: whether it still knows them, what a box or a click in one of them
//! points to, and what all of them become by corrections. It computes the next version of the masks and shows nothing.

import type { ClipFrame, Segmenter } from 'veronese';
import { codeOf } from '../../common/errors.js';
import { strings } from '../../common/strings.js';
import { packed, unpacked } from '../../correction/runs.js';
import { UNLABELLED } from '../../result/masks.js';
import type { LoadedFrame } from '../../state/pair.js';
import type { Pointed } from '../../state/said.js';
import { exactly, overlaid } from '../../state/exact.js';
import { editsIn, fromSpan, lockedIn, spanAt, theirNumber, toSpan } from '../../state/spans.js';
import type { State, Store } from '../../state/state.js';
import { type Span, type Tracked, type TrackedFrame, type Version, isLocked } from '../../state/tracked.js';
import { ClipFrames } from './frames.js';

/** Memory for frames that a correction reads again, bytes. */
const ROOM = 64 << 20;

/** Ends a run in which a frame is all that is wanted. */
const ENOUGH = new Error('enough');

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

  /** What is painted when a box or a click points to an object. What is not the object is not, unless that is to be drawn exactly. */
  async outlined(version: Version, { frame, id, spread, at }: Pointed, signal: AbortSignal): Promise<Map<number, Uint8Array>> {
    const { tracked, pair } = this.#store.get();
    const span = spanAt(version.spans, frame);
    if (tracked === null || span === null) return new Map();
    const { first } = span.range;
    const label = theirNumber(span.numbers, id);
    let labels: Uint8Array | undefined;
    const found = this.#segmenter.segmentClip(framesOf(tracked, version, span, pair), {
      state: await bytesOf(span.state),
      changesOnly: true,
      signal,
      corrections: [at.length === 2 ? { frame: frame - first, label, click: at } : { frame: frame - first, label, box: at }],
      locked: lockedIn(span, version, [], (id) => isLocked(version, id)),
      // The first frame that changes is this one; the others are carried later, with all that was said before.
      onChange: async (index, segmented) => {
        if (first + index === frame) labels = (await segmented()).labels;
        throw ENOUGH;
      },
    });
    try {
      for await (const _ of found);
    } catch (error) {
      if (error !== ENOUGH) throw error;
    }
    if (!labels?.includes(label)) {
      this.#store.say(strings.notices.nothingThere);
      return new Map();
    }
    const ground = spread === 'exact' ? UNLABELLED : 0;
    const { width } = version.frames[frame]!.runs;
    const exact = version.exact.get(frame);
    const drawn = exact && unpacked(exact);
    const [left, top, columns = width, rows = labels.length] = at.length === 2 ? [0, 0] : at;
    const isWithin = (p: number): boolean => p % width >= left && p % width < left + columns && p / width >= top && p / width < top + rows;
    return new Map([[frame, labels.map((own, p) => ((drawn?.[p] ?? UNLABELLED) !== UNLABELLED ? UNLABELLED : own === label && isWithin(p) ? id : own === 0 ? ground : UNLABELLED))]]);
  }

  /**
   * Applies what became of objects to the frames of a span, and what was painted in some of them. `changes` takes frames as they change,
   * perhaps not for the last time.
   */
  async corrected(
    version: Version,
    span: Span,
    painted: readonly number[],
    signal: AbortSignal,
    changes?: (index: number, masks: TrackedFrame) => void,
  ): Promise<Version> {
    const { tracked, settings, pair } = this.#store.get();
    if (tracked === null) return version;
    const { first } = span.range;
    const numbers = new Map(span.numbers);
    const frames = framesOf(tracked, version, span, pair);
    const corrections = painted.map((index) => ({
      frame: index - first,
      propagate: version.spread.get(index) ?? 'both',
      labels: toSpan(version.painted.get(index)!, numbers),
    }));
    let { largest } = version;
    const named = (frame: ClipFrame): TrackedFrame => {
      const masks = overlaid(fromSpan(masksOf(frame, frames.size), numbers, largest), version.exact.get(first + frame.index));
      largest = Math.max(largest, ...masks.objects.map(({ id }) => id));
      return masks;
    };
    const isOwn = (index: number): boolean => spanAt(version.spans, index) === span;
    const onChange = async (index: number, segmented: () => Promise<ClipFrame>): Promise<void> => {
      if (!isOwn(first + index)) return;
      const frame = await segmented();
      if (!signal.aborted) changes?.(first + index, named(frame));
    };
    const found = this.#segmenter.segmentClip(frames, {
      state: await bytesOf(span.state),
      markUnknown: settings.markUnknown,
      changesOnly: true,
      signal,
      transfer: true,
      edits: editsIn(numbers, version.became),
      corrections,
      // When the clip is segmented again, all is said again that was said before objects were locked.
      locked: changes ? lockedIn(span, version, painted, (id) => isLocked(version, id)) : [],
      ...(changes && { onChange }),
    });
    const masks = [...version.frames];
    for await (const frame of found) {
      const is = named(frame);
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

export async function bytesOf(blob: Blob): Promise<Uint8Array> {
  return new Uint8Array(await blob.arrayBuffer());
}

export function blobOf(bytes: Uint8Array): Blob {
  return new Blob([new Uint8Array(bytes)]);
}

export function masksOf({ labels, objects, background }: ClipFrame, { width, height }: ClipFrames['size']): TrackedFrame {
  return { runs: packed(labels, width, height), objects, background };
}
