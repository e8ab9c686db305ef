//! Carries a person's corrections through the clip: those of pixels that wait together, others one after another, because each starts from
//! the masks of the one before. It goes back and forth between the versions that this makes, and owns the corrections that are waiting.

import { strings } from '../../common/strings.js';
import { packed } from '../../correction/runs.js';
import { withCorrection } from '../../state/correction.js';
import { spanAt } from '../../state/spans.js';
import type { Store } from '../../state/state.js';
import { isPrompt, reaches } from '../../state/annotation.js';
import { type ClipRun, type Correction, type Drawn, type Noted, type Notes, type TrackedFrame, type Version, acceptedIn, unchanged, versionOf } from '../../state/tracked.js';
import type { Shown } from '../shown.js';
import type { Change, ClipRuns } from './runs.js';
import type { Spans } from './spans.js';

/** Masks are shown at most this often while they change, milliseconds. */
const OFTEN = 100;

/** The beginning of carrying a correction through a clip. */
const CARRYING = { phase: 'working', stage: 'corrections', left: null, labelled: 0 } as const;

/** The run after a correction that was taken back, or that failed. */
const TAKEN_BACK = { phase: 'done', cause: 'undone', changed: 0 } as const;

interface Corrections {
  /** The masks after those that are done. */
  settled: Version;
  /** These, as far as those under way have changed them. */
  now: Version;
  /** Those that are being carried, and those after them. */
  under: readonly Correction[];
  readonly waiting: Correction[];
  /** The versions that were undone, which stay when what was carried together is carried without the last. */
  future: readonly Version[];
}

/** Why a run on the clip is done. */
type DoneCause = Extract<ClipRun, { readonly phase: 'done' }>['cause'];

export class Carrying {
  readonly #store: Store;
  readonly #runs: ClipRuns;
  readonly #spans: Spans;
  readonly #shown: Shown;
  /** `null` while none is under way. */
  #corrections: Corrections | null = null;

  constructor(store: Store, runs: ClipRuns, spans: Spans, shown: Shown) {
    this.#store = store;
    this.#runs = runs;
    this.#spans = spans;
    this.#shown = shown;
  }

  /** Shows a correction at once in its own frame, and carries it through the clip after those before. */
  correct(correction: Correction): Promise<void> {
    return this.#correct([correction]);
  }

  /** Goes on with what was not carried through the clip when it was left, or the page was. */
  resume(): void {
    const { tracked } = this.#store.get();
    if (tracked?.pending && this.#corrections === null) void this.#correct(tracked.pending.corrections);
  }

  /** `future`: what can still be redone when these are carried. */
  async #correct(all: readonly Correction[], future: readonly Version[] = []): Promise<void> {
    const { tracked } = this.#store.get();
    if (tracked === null) return;
    const before = this.#corrections;
    const settled = versionOf(tracked);
    const corrections: Corrections = before ?? { settled, now: settled, under: [], waiting: [], future };
    corrections.waiting.push(...all);
    this.#corrections = corrections;
    this.#show(all.reduce(withCorrection, versionOf(tracked)), tracked.run);
    if (before !== null) return; // taken by the loop below
    const ends = { cancel: () => this.#takeBack(corrections), stopped: () => this.#stopped(corrections) };
    while (this.#corrections === corrections && corrections.waiting.length > 0) {
      await this.#runs.run(ends, (signal, set) => this.#carry(corrections, signal, set));
      if (this.#corrections !== corrections || this.#store.get().tracked?.run.phase !== 'failed') continue;
      // Of what failed nothing stays.
      corrections.waiting.length = 0;
      corrections.under = [];
      this.#show(corrections.settled, TAKEN_BACK);
    }
    if (this.#corrections === corrections) this.#corrections = null;
  }

  /** Shows a version of the masks, and tells what of the corrections is not carried yet. */
  #show(version: Version, run: ClipRun): void {
    const { settled, under, waiting } = this.#corrections ?? { settled: version, under: [], waiting: [] };
    const [said, before] = [[...under, ...waiting], this.#store.get().tracked?.pending ?? null];
    const isSame = before?.settled === settled && said.length === before.corrections.length && said.every((one, k) => one === before.corrections[k]);
    this.#shown.version(version, run, isSame ? before : said.length === 0 ? null : { settled, corrections: said });
  }

  /** Notes what changes no masks: a step of undo and redo, or, if it `goesOn`, part of the last one. The first masks are complete before there are steps. */
  note(notes: Partial<Notes>, cause: DoneCause, goesOn = false): void {
    this.#note({ notes }, cause, goesOn);
  }

  /** Takes what is drawn exactly in frames, by index: it is not carried to other pixels. */
  draw(drawn: ReadonlyMap<number, Uint8Array>): void {
    const { frames = [] } = this.#store.get().tracked ?? {};
    const inFrames = [...drawn].map(([index, labels]) => [index, packed(labels, frames[index]!.runs.width, frames[index]!.runs.height)] as const);
    this.#note({ drawn: new Map(inFrames) }, 'corrected', false);
  }

  #note(correction: Noted | Drawn, cause: DoneCause, goesOn: boolean): void {
    const { tracked } = this.#store.get();
    if (tracked === null) return;
    if (this.#corrections !== null) {
      const { waiting } = this.#corrections;
      const last = goesOn ? waiting.findLastIndex((one) => kindOf(one) === kindOf(correction)) : -1;
      if (last >= 0) waiting.splice(last, 1);
      return void this.correct(correction);
    }
    const after = withCorrection(tracked, correction);
    if (!goesOn && tracked.spans.length > 0) this.#store.clip({ past: [...tracked.past, versionOf(tracked)], future: [] });
    this.#shown.version(after, tracked.run.phase === 'working' ? tracked.run : { phase: 'done', cause, changed: changedIn(after, tracked) });
  }

  undo(): void {
    const corrections = this.#corrections;
    const { tracked } = this.#store.get();
    if (corrections === null || tracked === null) return this.#go('past', 'future', 'undone');
    // The last correction is what is undone.
    const { under, waiting } = corrections;
    if (waiting.pop() === undefined) {
      if (under.length < 2) return this.#takeBack(corrections);
      // The others are carried anew without it.
      this.#restart(corrections);
      waiting.push(...under.slice(0, -1));
    }
    this.#show(waiting.reduce(withCorrection, corrections.now), tracked.run);
  }

  redo(): void {
    this.#go('future', 'past', 'redone');
  }

  #go(from: 'past' | 'future', to: 'past' | 'future', cause: 'undone' | 'redone'): void {
    const { tracked } = this.#store.get();
    const version = tracked?.[from].at(-1);
    if (tracked === null || version === undefined || tracked.run.phase === 'working') return;
    const { together = [], ...plain } = version;
    const future = [...tracked[to], versionOf(tracked)];
    this.#store.clip({ [from]: tracked[from].slice(0, -1), [to]: future });
    this.#shown.version(plain, { phase: 'done', cause, changed: changedIn(version, tracked) });
    if (from === 'past' && together.length > 0) void this.#correct(together, future);
  }

  /** Takes back what is being carried through the clip. Later corrections are carried on. */
  #takeBack(corrections: Corrections): void {
    const { settled, waiting } = corrections;
    if (waiting.length === 0) {
      this.#runs.stop();
      return this.#store.clip({ pending: null });
    }
    this.#restart(corrections);
    this.#show(waiting.reduce(withCorrection, settled), CARRYING);
  }

  /** Ends what is under way. */
  #restart(corrections: Corrections): void {
    this.#runs.interrupt();
    corrections.under = [];
    corrections.now = corrections.settled;
  }

  /** The clip is left: it has what it had, and what was said of it since is still pending. */
  #stopped({ settled }: Corrections): void {
    const pending = this.#store.get().tracked?.pending ?? null;
    this.#corrections = null;
    this.#shown.version(settled, TAKEN_BACK, pending);
  }

  /** Carries the corrections of pixels that wait, or the next one of another kind, through the frames that were segmented together. */
  async #carry(corrections: Corrections, signal: AbortSignal, set: Change): Promise<void> {
    const { settled: before, waiting } = corrections;
    if (waiting.length === 0) return;
    const others = waiting.findIndex((one) => !isOfPixels(one));
    const under = (corrections.under = waiting.splice(0, others < 0 ? waiting.length : Math.max(others, 1)));
    set({ run: CARRYING });
    corrections.now = under.reduce(withCorrection, before);
    const after = unchanged(before, await this.#carried(before, under, corrections, signal, set));
    const now = this.#store.get().tracked;
    if (signal.aborted || now === null) return;
    corrections.under = [];
    const annotations = under.flatMap((one) => ('annotations' in one ? one.annotations : []));
    const nothing = annotations.filter((one) => isPrompt(one) && !after.frames[one.frame]?.objects.some(({ id }) => id === (after.became.get(one.object) ?? one.object)));
    if (nothing.length > 0) this.#store.say(strings.notices.nothingThere);
    // What else was said with it stays.
    const isNothing = nothing.length > 0 && nothing.length === annotations.length;
    corrections.settled = corrections.now = isNothing ? before : after;
    if (!isNothing) set({ past: [...now.past, { ...before, ...(under.length > 1 && { together: under.slice(0, -1) }) }], future: corrections.future });
    corrections.future = [];
    // Later corrections stay on screen.
    const kept = acceptedIn(corrections.settled).filter((index) => annotations.some((one) => reaches(one, index))).length;
    const run = waiting.length > 0 ? now.run : ({ phase: 'done', cause: 'corrected', changed: changedIn(corrections.settled, before), kept } as const);
    this.#show(waiting.reduce(withCorrection, corrections.settled), run);
  }

  /** The masks of all frames after corrections of pixels, or one of another kind. */
  async #carried(before: Version, under: readonly Correction[], corrections: Corrections, signal: AbortSignal, set: Change): Promise<Version> {
    const { now } = corrections;
    const correction = under[0]!;
    if (!('edits' in correction || 'annotations' in correction)) return now;
    const progress = (labelled: number, of: number, left: number | null): void => set({ run: { ...CARRYING, labelled, of, left } });
    const changes = this.#shows(corrections);
    // Frames that do not change are as they were.
    let after: Version = 'edits' in correction ? now : { ...now, frames: before.frames, largest: before.largest };
    const objects = new Set('edits' in correction ? [...(correction.edits.merge ?? []), correction.edits.delete ?? []].flat() : []);
    const annotations = now.annotations.filter((one) => !before.annotations.includes(one));
    for (const span of before.spans) {
      const own = annotations.filter(({ frame }) => spanAt(before.spans, frame) === span);
      const isAbout = own.length > 0 || [...span.numbers.values()].some((id) => objects.has(id));
      if (isAbout) after = await this.#spans.corrected(after, span, own, signal, { changes, progress });
    }
    return after;
  }

  /** Shows frames as a correction changes them: those on screen at once, others soon. */
  #shows(corrections: Corrections): (index: number, masks: TrackedFrame) => void {
    let shown = -Infinity;
    return (index, masks) => {
      const { now, settled, waiting } = corrections;
      corrections.now = { ...now, frames: unchanged(settled, { frames: now.frames.with(index, masks) }).frames, largest: Math.max(now.largest, ...masks.objects.map(({ id }) => id)) };
      const { timeline, tracked } = this.#store.get();
      if (tracked === null) return;
      if (index !== timeline?.first && index !== timeline?.second && performance.now() - shown < OFTEN) return;
      shown = performance.now();
      this.#show(waiting.reduce(withCorrection, corrections.now), tracked.run);
    };
  }
}

/** Whether it is of pixels or clicks in frames, and nothing else. */
function isOfPixels(correction: Correction): boolean {
  return 'annotations' in correction && correction.notes === undefined;
}

/** The kinds of notes; `null` for a correction of masks. */
function kindOf(correction: Correction): string | null {
  return 'notes' in correction && correction.notes !== undefined && !('annotations' in correction || 'drawn' in correction || 'edits' in correction) ? Object.keys(correction.notes).join() : null;
}

/** Number of frames that are others than before. */
function changedIn({ frames }: Version, before: Version): number {
  return frames.filter((frame, index) => frame !== before.frames[index]).length;
}
