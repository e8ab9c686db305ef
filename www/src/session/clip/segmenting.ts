//! Segmenting a clip from its in point to its out point, and going on with it. What is done stays when a run is cancelled or fails. The
//! clip itself, the in point and the masks are in the state.

import type { ClipFrame } from 'veronese';
import type { Clip } from '../../clips/clip.js';
import type { Settings } from '../../state/settings.js';
import { exactly } from '../../state/exact.js';
import { atSize, contains, numbersOf, withRun } from '../../state/spans.js';
import type { Store } from '../../state/state.js';
import { type ClipRun, type Range, type SolvedPairs, type Tracked, type TrackedFrame, type Version, acceptedIn, isTracked, notesOf, savedOf, unchanged, untracked, versionOf } from '../../state/tracked.js';
import type { Shown } from '../shown.js';
import { draft } from './drafts.js';
import { ClipFrames, STOPPED, blobOf, bytesOf, masksOf } from './frames.js';
import type { Change, ClipRuns } from './runs.js';
import type { Spans } from './spans.js';
import { TimeLeft } from './time-left.js';

/** Masks are shown at most this often while they come, milliseconds. */
const OFTEN = 100;

export class ClipSegmenting {
  /** The solved pairs of clips, by their fingerprints, for runs that go on. They are large, and no view shows them. */
  readonly solvedPairs = new Map<string, SolvedPairs>();
  readonly #store: Store;
  readonly #runs: ClipRuns;
  readonly #spans: Spans;
  readonly #shown: Shown;

  constructor(store: Store, runs: ClipRuns, spans: Spans, shown: Shown) {
    this.#store = store;
    this.#runs = runs;
    this.#spans = spans;
    this.#shown = shown;
  }

  /** The objects of this clip, also from when it was open before. A run on another one ends. */
  of(clip: Clip | null): Tracked | null {
    const { tracked } = this.#store.get();
    if (clip !== null && tracked?.clip === clip) return tracked;
    this.#runs.stop();
    const { tracked: left, keptClips } = this.#store.get();
    const kept = new Map(keptClips);
    if (left !== null && left.solved > 0) kept.set(left.clip.fingerprint, left);
    const known = clip === null ? undefined : kept.get(clip.fingerprint);
    if (clip !== null) kept.delete(clip.fingerprint);
    this.#store.set({ keptClips: kept });
    return clip === null ? null : known === undefined ? untracked(clip) : { ...known, clip };
  }

  /** Moves the in point or the out point of the open clip. The other one makes way. */
  setRange(edge: keyof Range, index: number): void {
    const { tracked } = this.#store.get();
    if (tracked === null) return;
    const end = tracked.clip.count - 1;
    const at = Math.min(Math.max(index, 0), end);
    const { first, last } = tracked.range;
    const range = edge === 'first' ? { first: at, last: at > last ? end : last } : { first: at < first ? 0 : first, last: at };
    this.#store.clip({ range });
  }

  /**
   * Segments the open clip from its in point to its out point, or continues with it. Masks that there are stay until all new ones are
   * there; what is outside stays, and corrections are applied again.
   */
  async segment(): Promise<void> {
    const { tracked, settings: own } = this.#store.get();
    if (tracked === null) return;
    const { clip, range } = tracked;
    const alone = tracked.frames.every((frame, index) => frame === null || contains(range, index));
    const settings = { ...own, longestSide: alone ? own.longestSide : tracked.longestSide };
    const { longestSide, ...options } = settings;
    const { pairs } = this.#knownOf(clip, range, settings);
    const frames = new ClipFrames(clip, longestSide, range);
    const drafting = new AbortController();
    const cancel = (): void => {
      drafting.abort();
      this.#finish(frames);
    };
    const ends = { cancel, stopped: () => this.#store.clip({ run: { phase: 'cancelled' } }) };
    await this.#runs.run(ends, async (signal, set) => {
      const solved = (): number => [...pairs.keys()].filter((index) => index < frames.length).length;
      const time = new TimeLeft(solved(), frames.length);
      const solving = (): void => {
        if (!frames.stopped) set({ run: { phase: 'working', stage: 'pairs', left: time.at(solved()), labelled: 0 }, solved: solved() });
      };
      set({ previews: tracked.frames });
      solving();
      const preview = (read: ClipFrames) => (frame: ClipFrame) => this.#preview(frame, read, set);
      const fresh = !isTracked(tracked);
      const drafts = fresh && settings.quality === 'best' && solved() < frames.length ? new ClipFrames(clip, longestSide, range) : null;
      if (drafts !== null) void draft(drafts, { ...options, signal: drafting.signal }, preview(drafts));
      const found = this.#runs.segmenter.segmentClip(frames, {
        ...options,
        signal,
        transfer: true,
        knownPairs: (index) => {
          const known = pairs.get(index);
          return known && bytesOf(known);
        },
        onPairs: (index, bytes) => {
          pairs.set(index, blobOf(bytes));
          solving();
        },
        onPreview: fresh && drafts === null ? preview(frames) : undefined,
      });
      const masks: TrackedFrame[] = [];
      let run: ClipRun = { phase: 'done', cause: 'found', changed: frames.length };
      try {
        await this.#take(found, frames, masks, set);
        run = frames.same ? { ...run, cause: 'same' } : { ...run, notes: found.tracks().notes ?? [] };
      } catch (error) {
        if (error !== STOPPED) throw error;
        run = { phase: 'cancelled' };
      }
      const state = masks.length === 0 ? undefined : await found.state();
      const { tracked: before } = this.#store.get();
      if (signal.aborted || before === null) return;
      // A run that was cancelled early has less than there was.
      const covered = before.frames.every((frame, index) => frame === null || !contains(range, index) || index < range.first + masks.length);
      if (state === undefined || !covered) return set({ run });
      await this.#replace(before, masks, { first: range.first, last: range.first + masks.length - 1 }, { state, longestSide, run }, signal, set);
    });
    drafting.abort();
    this.#shown.ended();
  }

  /** Cancels the run on the clip. A correction under way is taken back. */
  cancel(): void {
    this.#runs.cancel();
  }

  /** Frames whose pairs are solved get their masks first; if that is what is under way, it stops at once. */
  #finish(frames: ClipFrames): void {
    const { tracked } = this.#store.get();
    if (tracked?.run.phase !== 'working' || tracked.run.stage !== 'pairs') return this.#runs.stop();
    frames.stop();
    this.#store.clip({ run: { phase: 'working', stage: 'labels', left: null, labelled: 0 } });
  }

  /** Shows a draft of a frame that has no masks yet. */
  #preview(frame: ClipFrame, { range, size }: ClipFrames, set: Change): void {
    const { tracked } = this.#store.get();
    const index = range.first + frame.index;
    if (tracked === null || tracked.frames[index] !== null) return;
    set({ previews: tracked.previews.with(index, masksOf(frame, size)) });
    this.#shown.objects(tracked);
  }

  /** Takes the labelled frames as they come, and shows them if there are no masks yet. */
  async #take(found: AsyncIterable<ClipFrame>, { clip, longestSide, range, size }: ClipFrames, masks: TrackedFrame[], set: Change): Promise<void> {
    const { tracked } = this.#store.get();
    const fresh = !isTracked(tracked);
    let shown = 0;
    const show = (): void => {
      const { tracked: before } = this.#store.get();
      if (before === null) return;
      shown = performance.now();
      set({ run: { phase: 'working', stage: 'labels', left: null, labelled: masks.length } });
      if (!fresh) return;
      const frames = untracked(clip).frames.map((_, index) => masks[index - range.first] ?? null);
      const previews = before.previews.map((shown, index) => frames[index] ?? shown);
      set({ frames, previews, largest: largestOf(frames), longestSide, saved: savedOf({ ...before, frames }) });
      this.#shown.objects(before);
    };
    try {
      for await (const frame of found) {
        masks.push(masksOf(frame, size));
        if (performance.now() - shown >= OFTEN) show();
      }
    } finally {
      if (masks.length > 0) show();
    }
  }

  /** Puts the masks of a run in the place of those before, under the same numbers, and corrects them as those were corrected. */
  async #replace(
    before: Tracked,
    masks: readonly TrackedFrame[],
    range: Range,
    { state, longestSide, run }: { readonly state: Uint8Array; readonly longestSide: number; readonly run: ClipRun },
    signal: AbortSignal,
    set: Change,
  ): Promise<void> {
    const { annotations, became } = before;
    const isFirst = before.found.every((runs) => runs === null);
    const numbers = isFirst ? new Map(masks.flatMap(({ objects }) => objects.map(({ id }) => [id, id] as const))) : numbersOf(masks, range, before);
    let version = withRun(versionOf(before), masks, { range, state: blobOf(state), numbers }, longestSide);
    const corrected = annotations.some(({ frame }) => contains(range, frame)) || became.size > 0;
    if (corrected || acceptedIn(before).some((index) => contains(range, index))) version = await this.#spans.repeated(before, version, signal);
    const { tracked: now } = this.#store.get();
    if (signal.aborted || now === null) return;
    version = unchanged(now, version);
    // A person's corrections can be brought back.
    if (now.past.length > 0) set({ past: [...now.past, versionOf(now)] });
    else if (now.saved.frames === now.frames) set({ saved: { ...now.saved, frames: version.frames } });
    set({ future: [] });
    // Notes, and pixels that were drawn exactly meanwhile, stay.
    const meanwhile = { ...version, ...notesOf(now), exact: atSize(now.exact, version.frames), largest: Math.max(version.largest, now.largest) };
    this.#shown.version(exactly(meanwhile), corrected && run.phase === 'done' ? { ...run, cause: 'repeated' } : run);
  }

  /** The pairs that were solved with these settings: other settings and another first frame begin anew. */
  #knownOf({ fingerprint }: Clip, { first }: Range, settings: Settings): SolvedPairs {
    const key = JSON.stringify([first, settings.motions, settings.quality, settings.subject, settings.longestSide]);
    const before = this.solvedPairs.get(fingerprint);
    const known = before?.settings === key ? before : { settings: key, pairs: new Map<number, Blob>() };
    this.solvedPairs.set(fingerprint, known);
    return known;
  }
}

/** The largest number of an object in these frames. */
function largestOf(frames: Version['frames']): number {
  return frames.reduce((most, frame) => (frame?.objects ?? []).reduce((larger, { id }) => Math.max(larger, id), most), 0);
}
