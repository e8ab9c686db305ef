//! Corrections of frames that were segmented together, as the package answers them: the next version of the masks. It shows nothing.

import type { ClipFrame, Segmenter } from 'veronese';
import type { ClipEdits, ClipOptions, ClipProgress } from '../../segmented.js';
import { type Runs, packed, resized, unpacked } from '../../correction/runs.js';
import { UNLABELLED } from '../../result/masks.js';
import type { LoadedFrame } from '../../state/pair.js';
import { exactly, overlaid } from '../../state/exact.js';
import { contains, fromSpan, spanAt } from '../../state/spans.js';
import type { State, Store } from '../../state/state.js';
import { type Annotation, reaches } from '../../state/annotation.js';
import { editsIn, namesIn, annotationAtSize, packageNumbers, toSpan, forPackage } from '../../state/package-numbers.js';
import { type Range, type Span, type Tracked, type TrackedFrame, type Version, acceptedIn } from '../../state/tracked.js';
import { ClipFrames, blobOf, bytesOf, masksOf } from './frames.js';
import { TimeLeft } from './time-left.js';

/** Memory for frames that a correction reads again, bytes. */
const ROOM = 64 << 20;

/** What is told while a correction spreads. */
interface Told {
  /** Frames as they change, perhaps not for the last time. */
  readonly changes: (index: number, masks: TrackedFrame) => void;
  /** The number of frames that it has come through, of those that it may reach, and the seconds left; `null` until they are known. */
  readonly progress: (done: number, of: number, left: number | null) => void;
}

export class Spans {
  readonly #store: Store;
  readonly #segmenter: Segmenter;

  constructor(store: Store, segmenter: Segmenter) {
    this.#store = store;
    this.#segmenter = segmenter;
  }

  /** Tells the package what is new in a span, and what became of objects. */
  corrected(version: Version, span: Span, annotations: readonly Annotation[], signal: AbortSignal, telling: Told): Promise<Version> {
    const accepted = acceptedIn(version).filter((index) => spanAt(version.spans, index) === span);
    const told = { ...telling, of: reachOf(annotations, span.range) };
    return this.#answer(version, span, signal, told, (numbers) => ({
      ...forPackage(annotations, span.range, numbers),
      accepted: accepted.map((index) => index - span.range.first),
      locked: packageNumbers(numbers, version.became, (id) => version.locked.has(id)),
      names: namesIn(version, numbers),
    }));
  }

  /**
   * Repeats in the span that was segmented last all annotations of `before`, and then that frames are accepted, with their labels. Objects that
   * were locked and named since are protected from later annotations.
   */
  async repeated(before: Version, now: Version, signal: AbortSignal): Promise<Version> {
    const at = now.spans.length - 1;
    const { range } = now.spans[at]!;
    const annotations = now.annotations.map((one) => {
      const [was, is] = [before, now].map(({ frames }) => frames[one.frame]?.runs);
      return was && is && was.width !== is.width ? annotationAtSize(one, was, is) : one;
    });
    const own = annotations.filter(({ frame }) => contains(range, frame));
    const after = await this.#answer({ ...now, annotations }, now.spans[at]!, signal, null, (numbers) => ({ ...forPackage(own, range, numbers), accepted: [], locked: [], names: {} }));
    const accepted = acceptedIn(before).filter((index) => contains(range, index));
    if (accepted.length === 0 || signal.aborted) return after;
    return this.#answer(after, after.spans[at]!, signal, null, (numbers) => ({
      accepted: accepted.map((index) => ({ frame: index - range.first, labels: toSpan(acceptedLabels(before, after, index), numbers) })),
      locked: [],
      names: {},
    }));
  }

  async #answer(
    version: Version,
    span: Span,
    signal: AbortSignal,
    told: (Told & { readonly of: number }) | null,
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
      if (!signal.aborted) told?.changes(first + index, numbered(frame));
    };
    const { names, ...asked } = tell(numbers);
    // A frame may be read again: first it tells what objects look like.
    const reached = new Set<number>();
    const time = new TimeLeft(0, told?.of ?? 0);
    const onProgress = ({ stage, frame }: ClipProgress): void => {
      if (told === null || stage !== 'corrections' || signal.aborted) return;
      reached.add(frame);
      const done = Math.min(reached.size, told.of);
      told.progress(done, told.of, time.at(done));
    };
    const found = this.#segmenter.segmentClip(frames, {
      ...asked,
      state: await bytesOf(span.state),
      markUnknown: settings.markUnknown,
      changesOnly: true,
      signal,
      transfer: true,
      edits: { ...editsIn(numbers, version.became), names },
      ...(told && { onChange, onProgress }),
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

/** The number of frames in a range that annotations may reach. */
function reachOf(annotations: readonly Annotation[], { first, last }: Range): number {
  let count = 0;
  for (let index = first; index <= last; index++) if (annotations.some((one) => reaches(one, index))) count += 1;
  return count;
}

/** The frames of a span as a correction reads them, several times: those on screen need no decoding. */
function framesOf({ clip }: Tracked, { longestSide }: Version, { range }: Span, { first, second }: State['pair']): ClipFrames {
  const hand = [first, second].filter((frame): frame is LoadedFrame => frame !== null);
  return new ClipFrames(clip, longestSide, range, { hand, room: ROOM });
}

/** The labels of an accepted frame at the size that it has now. What was drawn exactly is the page's alone. */
function acceptedLabels(before: Version, now: Version, index: number): Runs {
  const runs = resized(before.frames[index]!.runs, now.frames[index]!.runs);
  const exact = now.exact.get(index);
  if (exact === undefined) return runs;
  const drawn = unpacked(exact);
  return packed(unpacked(runs).map((label, p) => (drawn[p] === UNLABELLED ? label : UNLABELLED)), runs.width, runs.height);
}
