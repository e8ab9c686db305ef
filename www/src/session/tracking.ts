//! The clip as a whole, in a worker of its own: segmenting its frames, and carrying corrections through them. What is done stays when a
//! run is cancelled or fails.

import { type ClipFrame, type ClipOptions, Segmenter } from 'veronese';
import type { Clip } from '../clips/clip.js';
import { PageError, codeOf } from '../common/errors.js';
import { strings } from '../common/strings.js';
import { smallerPieces } from '../correction/pieces.js';
import { packed, unpacked } from '../correction/runs.js';
import { type Path, type Stroke, eachPixel } from '../correction/strokes.js';
import type { Colour } from '../drawing/palette.js';
import { UNLABELLED, keyOf } from '../result/masks.js';
import { type Pointed, type Said, paintedOver, withSaid } from '../state/said.js';
import type { Settings } from '../state/settings.js';
import type { Store } from '../state/state.js';
import { MOST_OBJECTS, contains, editsIn, fromSpan, lockedIn, numbersOf, spanAt, theirNumber, toSpan, withRun } from '../state/spans.js';
import { type ClipRun, type Range, type SolvedPairs, type Span, type Tracked, type TrackedFrame, type Version, isLocked, isTracked, savedOf, untracked, versionOf } from '../state/tracked.js';
import { ClipFrames, STOPPED } from './clip/frames.js';
import { TimeLeft } from './clip/time-left.js';

/** Masks are shown at most this often while they come, milliseconds. */
const OFTEN = 100;

/** Memory for frames that a correction reads again, bytes. */
const ROOM = 64 << 20;

/** A box with both sides below this share of the frame's width is a click. */
const STILL = 0.01;

/** Ends a run in which a frame is all that is wanted. */
const ENOUGH = new Error('enough');

/** The beginning of carrying a correction through a clip. */
const CARRYING = { phase: 'working', stage: 'corrections', left: null, labelled: 0 } as const;

interface Hooks {
  /** The masks of some frames have changed; `before`: what there was. */
  readonly changed: (before: Tracked) => void;
  readonly failed: (error: unknown) => void;
  readonly say: (sentence: string) => void;
}

/** Changes what is known of the clip. */
type Change = (change: Partial<Tracked>) => void;

/** Corrections that are being carried through the clip, one after another, because each starts from the masks of the one before. */
interface Carrying {
  /** The masks after those that are done. */
  settled: Version;
  /** These, as far as the one under way has changed them. */
  now: Version;
  readonly waiting: Said[];
}

export class Tracking {
  readonly #store: Store;
  readonly #hooks: Hooks;
  readonly #segmenter = new Segmenter();
  /** By the clip's fingerprint. */
  readonly #known = new Map<string, SolvedPairs>();
  /** The run under way, and the frames whose pairs it solves, if it does. */
  #current: AbortController | null = null;
  #solving: ClipFrames | null = null;
  #carrying: Carrying | null = null;

  constructor(store: Store, hooks: Hooks) {
    this.#store = store;
    this.#hooks = hooks;
  }

  /** What is known of this clip, also from when it was open before. A run on another one ends. */
  of(clip: Clip | null): Tracked | null {
    const { tracked } = this.#store.get();
    if (clip !== null && tracked?.clip === clip) return tracked;
    this.#abort();
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
    this.#store.set({ tracked: { ...tracked, range } });
  }

  /**
   * Segments the open clip from its in point to its out point, or continues with it. Masks that there are stay until all new ones are
   * there; what is outside stays, and corrections are applied again. `part`: other frames than those.
   */
  async segment(part?: Range): Promise<void> {
    const { tracked, settings: own, motionsElsewhere } = this.#store.get();
    if (tracked === null) return;
    const { clip, range: chosen } = tracked;
    const range = part ?? chosen;
    // The number of motions of a single pair is not that of the clip.
    const alone = tracked.frames.every((frame, index) => frame === null || contains(range, index));
    const settings = { ...own, motions: motionsElsewhere ?? own.motions, longestSide: alone ? own.longestSide : tracked.longestSide };
    const { longestSide, ...options } = settings;
    const { pairs } = this.#knownOf(clip, range, settings);
    await this.#run(async (signal, set) => {
      const frames = (this.#solving = new ClipFrames(clip, longestSide, range));
      const solved = (): number => [...pairs.keys()].filter((index) => index < frames.length).length;
      const time = new TimeLeft(solved(), frames.length);
      const solving = (): void => {
        if (!frames.stopped) set({ run: { phase: 'working', stage: 'pairs', left: time.at(solved()), labelled: 0 }, solved: solved() });
      };
      solving();
      const found = this.#segmenter.segmentClip(frames, {
        ...options,
        signal,
        transfer: true,
        knownPairs: (index) => bytesOf(pairs.get(index)),
        onPairs: (index, bytes) => {
          pairs.set(index, blobOf(bytes));
          solving();
        },
      });
      const masks: TrackedFrame[] = [];
      let run: ClipRun = { phase: 'done', cause: 'found', changed: frames.length };
      try {
        await this.#take(found, frames, masks, set);
        if (frames.same) run = { ...run, cause: 'same' };
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
  }

  /**
   * Segments the open clip again if what the package knows of it is of another version. Its masks stay until then, but take no corrections.
   */
  async renew(): Promise<void> {
    const { tracked } = this.#store.get();
    if (tracked === null || (await this.#isReadable(tracked))) return;
    if (this.#store.get().tracked?.clip !== tracked.clip) return;
    this.#abort();
    this.#known.delete(tracked.clip.fingerprint);
    this.#store.set({ tracked: { ...this.#store.get().tracked!, spans: [] } });
    for (const { range } of tracked.spans) {
      await this.segment(range);
      const { tracked: now } = this.#store.get();
      if (now?.clip !== tracked.clip || now.run.phase !== 'done') return;
    }
  }

  async #isReadable({ clip, longestSide, spans: [span] }: Tracked): Promise<boolean> {
    if (span === undefined) return true; // all are of one version
    const frames = new ClipFrames(clip, longestSide, span.range);
    try {
      await this.#segmenter.segmentClip(frames, { state: (await bytesOf(span.state))!, changesOnly: true }).next();
      return true;
    } catch (error) {
      return codeOf(error) !== 'invalid-option';
    }
  }

  /**
   * Stops the run. Frames whose pairs are solved get their masks first; if that is what is under way, it stops at once. A correction under
   * way is taken back.
   */
  cancel(): void {
    const { tracked } = this.#store.get();
    if (this.#carrying !== null) return this.#takeBack(this.#carrying);
    if (tracked?.run.phase !== 'working' || tracked.run.stage !== 'pairs' || this.#solving === null) return this.#abort();
    this.#solving.stop();
    this.#store.set({ tracked: { ...tracked, run: { phase: 'working', stage: 'labels', left: null, labelled: 0 } } });
  }

  /** Stops the run at once; what is done stays. */
  #abort(): void {
    const { tracked } = this.#store.get();
    if (this.#current === null || tracked === null || tracked.run.phase !== 'working') return;
    const carrying = this.#carrying;
    this.#carrying = null;
    this.#current.abort();
    this.#current = null;
    if (carrying !== null) this.#show(carrying.settled, { phase: 'done', cause: 'undone', changed: 0 });
    else this.#store.set({ tracked: { ...tracked, run: { phase: 'cancelled' } } });
  }

  /**
   * Begins a stroke over the frame on screen, with the selected object. Returns what takes its path, or `null`, and tells why, if nothing
   * can be painted.
   */
  beginStroke(tool: Stroke['tool']): ((path: Path) => void) | null {
    const { tracked, timeline, look, pair } = this.#store.get();
    const frame = timeline?.first ?? null;
    const own = look.selected;
    if (!this.#takesCorrections() || tracked === null || frame === null || pair.first === null) return null;
    if (spanAt(tracked.spans, frame) === null) return this.#refuse(strings.notTracked);
    if (own === null) return this.#refuse(strings.notices.chooseMask);
    if (own === UNLABELLED) return this.#refuse(strings.notices.notPainted);
    if (own === 0 && tool === 'eraser') return this.#refuse(strings.notices.nothingElse);
    const { width } = pair.first;
    return ({ points, radius }) => {
      const { tracked: now } = this.#store.get();
      const masks = now?.frames[frame]?.runs;
      if (!now || masks === undefined) return;
      const scale = masks.width / width;
      const path = { points: points.map((value) => (value + 0.5) * scale - 0.5), radius: radius * scale };
      const [labels, said] = [unpacked(masks), new Uint8Array(masks.width * masks.height).fill(UNLABELLED)];
      eachPixel(path, masks.width, masks.height, (p) => {
        const there = labels[p]!;
        if (tool === 'eraser' ? there === own : there === own || !isLocked(now, there)) said[p] = tool === 'eraser' ? 0 : own;
      });
      if (tool === 'brush' && said.every((label) => label === UNLABELLED)) return void this.#refuse(strings.notices.locked);
      void this.correct({ painted: new Map([[frame, said]]) });
    };
  }

  /** Begins a box around a new object, or a click on it, in the frame on screen. Returns what takes its corners, or `null`, and tells why. */
  beginBox(): ((path: Pick<Path, 'points'>) => void) | null {
    const { tracked, timeline, pair } = this.#store.get();
    const frame = timeline?.first ?? null;
    if (!this.#takesCorrections() || tracked === null || frame === null || pair.first === null) return null;
    if (spanAt(tracked.spans, frame) === null) return this.#refuse(strings.notTracked);
    const { first } = pair;
    return ({ points: [x = 0, y = 0, right = x, bottom = y] }) => {
      const masks = this.#store.get().tracked?.frames[frame]?.runs;
      const id = this.#newNumber();
      if (masks === undefined || id === null) return;
      const place = (value: number, side: number): number => Math.min(Math.max(Math.round((value + 0.5) * (masks.width / first.width) - 0.5), 0), side - 1);
      const [columns, rows] = [[x, right].map((at) => place(at, masks.width)), [y, bottom].map((at) => place(at, masks.height))];
      const [left, top] = [Math.min(...columns), Math.min(...rows)];
      const [width, height] = [Math.max(...columns) + 1 - left, Math.max(...rows) + 1 - top];
      const isClick = Math.max(width, height) <= Math.max(STILL * masks.width, 1);
      this.#store.look({ selected: id });
      void this.correct({ pointed: { frame, id, at: isClick ? [place(x, masks.width), place(y, masks.height)] : [left, top, width, height] } });
    };
  }

  /** Two objects become one, under the smaller of their numbers. */
  merge(one: number, other: number): void {
    if (one !== other) this.#edit({ merge: [[Math.min(one, other), Math.max(one, other)]] });
  }

  /** The object becomes background in the whole clip. */
  remove(id: number): void {
    this.#edit({ delete: [id] });
  }

  /** Makes a new object of all pieces of an object but the largest, in the frame on screen; the others follow. */
  split(id: number): void {
    const { tracked, timeline } = this.#store.get();
    const frame = timeline?.first ?? null;
    const masks = frame === null ? undefined : tracked?.frames[frame]?.runs;
    if (!this.#takesCorrections() || masks === undefined || frame === null) return;
    const pieces = smallerPieces(unpacked(masks), masks.width, id);
    const number = this.#newNumber();
    if (pieces.length === 0) return void this.#refuse(strings.notices.onePiece);
    if (number === null) return;
    const labels = new Uint8Array(masks.width * masks.height).fill(UNLABELLED);
    for (const p of pieces) labels[p] = number;
    void this.correct({ painted: new Map([[frame, labels]]) });
  }

  /** Selects the number of a new object, to be painted. Returns whether there can be one. */
  addObject(): boolean {
    const number = this.#takesCorrections() ? this.#newNumber() : null;
    if (number !== null) this.#store.look({ selected: number });
    return number !== null;
  }

  undo(): void {
    this.#go('past', 'future', 'undone');
  }

  redo(): void {
    this.#go('future', 'past', 'redone');
  }

  /** Locks an object, or unlocks it: whether corrections of others may change it. */
  setLocked(id: number, locked: boolean): void {
    const { tracked } = this.#store.get();
    if (tracked === null) return;
    const said = { locks: new Map([[id, locked]]) };
    if (this.#carrying !== null) return void this.correct(said);
    this.#store.set({ tracked: { ...tracked, past: [...tracked.past, versionOf(tracked)], future: [] } });
    this.#show(withSaid(tracked, said), tracked.run.phase === 'working' ? tracked.run : { phase: 'done', cause: locked ? 'locked' : 'unlocked', changed: 0 });
  }

  /** Sets the name or colour of an object. An empty name restores the default. */
  setAppearance(id: number, what: { name: string } | { colour: Colour }): void {
    const { tracked } = this.#store.get();
    if (tracked === null) return;
    const key = keyOf('objects', id);
    const { [key]: given, ...others } = tracked.names;
    if ('name' in what && what.name === (given ?? '')) return;
    const names = 'colour' in what ? tracked.names : what.name === '' ? others : { ...others, [key]: what.name };
    const colours = 'colour' in what ? { ...tracked.colours, [key]: what.colour } : tracked.colours;
    this.#store.set({ tracked: { ...tracked, names, colours } });
    this.#store.look({ names, colours });
  }

  /** What is known of the pairs of a clip, also if its masks are not complete. */
  solvedPairs(fingerprint: string): SolvedPairs | null {
    return this.#known.get(fingerprint) ?? null;
  }

  /** Goes on from these pairs when the clip is segmented. */
  learn(fingerprint: string, pairs: SolvedPairs): void {
    this.#known.set(fingerprint, pairs);
  }

  /** Records that the masks were exported as they are. */
  saved(exported: Tracked): void {
    const { tracked } = this.#store.get();
    if (tracked?.clip === exported.clip) this.#store.set({ tracked: { ...tracked, saved: savedOf(exported) } });
  }

  #refuse(sentence: string): null {
    this.#hooks.say(sentence);
    return null;
  }

  #takesCorrections(): boolean {
    const { tracked } = this.#store.get();
    const ready = tracked !== null && tracked.spans.length > 0;
    if (!ready) this.#hooks.say(strings.notices.notReady);
    return ready;
  }

  #newNumber(): number | null {
    const { tracked } = this.#store.get();
    const number = (tracked?.largest ?? 0) + 1;
    return number > MOST_OBJECTS ? this.#refuse(strings.notices.tooMany) : number;
  }

  #edit(edits: NonNullable<ClipOptions['edits']>): void {
    if (this.#takesCorrections()) void this.correct({ edits });
  }

  /** Shows what is said at once in its own frame, and carries it through the clip after what was said before. */
  async correct(said: Said): Promise<void> {
    const { tracked } = this.#store.get();
    if (tracked === null) return;
    const under = this.#carrying;
    const settled = versionOf(tracked);
    const carrying: Carrying = under ?? { settled, now: settled, waiting: [] };
    carrying.waiting.push(said);
    this.#show(withSaid(tracked, said), tracked.run);
    if (under !== null) return; // taken by the loop below
    this.#carrying = carrying;
    while (this.#carrying === carrying && carrying.waiting.length > 0) {
      await this.#run((signal, set) => this.#carry(carrying, signal, set));
      if (this.#carrying !== carrying || this.#store.get().tracked?.run.phase !== 'failed') continue;
      // Of what failed nothing stays.
      carrying.waiting.length = 0;
      this.#show(carrying.settled, { phase: 'done', cause: 'undone', changed: 0 });
    }
    if (this.#carrying === carrying) this.#carrying = null;
  }

  /** Takes back the correction that is being carried through the clip. Those said since are carried on. */
  #takeBack(carrying: Carrying): void {
    const { settled, waiting } = carrying;
    if (waiting.length === 0) return this.#abort();
    this.#current?.abort();
    carrying.now = settled;
    this.#show(waiting.reduce(withSaid, settled), CARRYING);
  }

  /** Carries the next correction through the frames that were segmented together. */
  async #carry(carrying: Carrying, signal: AbortSignal, set: Change): Promise<void> {
    const { settled: before, waiting } = carrying;
    const next = waiting.shift();
    if (next === undefined) return;
    set({ run: CARRYING });
    const said = 'pointed' in next ? { painted: await this.#outlined(before, next.pointed, signal) } : next;
    if (signal.aborted) return;
    if ('painted' in said && said.painted.size === 0) return this.#show(waiting.reduce(withSaid, before), { phase: 'done', cause: 'corrected', changed: 0 });
    carrying.now = withSaid(before, said);
    if ('pointed' in next) this.#show(waiting.reduce(withSaid, carrying.now), CARRYING);
    const shows = this.#shows(carrying);
    let after: Version = before;
    if ('pointed' in said || 'locks' in said) after = carrying.now;
    else if ('edits' in said) {
      after = carrying.now;
      const objects = new Set([...(said.edits.merge ?? []), said.edits.delete ?? []].flat());
      for (const span of before.spans) if ([...span.numbers.values()].some((id) => objects.has(id))) after = await this.#applied(after, span, [], signal, shows);
    } else {
      const painted = new Map(before.painted);
      for (const [index, labels] of said.painted) {
        painted.set(index, paintedOver(before.painted.get(index), labels, before.frames[index]!.runs));
      }
      after = { ...before, painted };
      for (const span of before.spans) {
        const own = [...said.painted.keys()].filter((index) => spanAt(before.spans, index) === span);
        if (own.length > 0) after = await this.#applied(after, span, own, signal, shows);
      }
    }
    const now = this.#store.get().tracked;
    if (signal.aborted || now === null) return;
    carrying.settled = carrying.now = after;
    set({ past: [...now.past, before], future: [] });
    const changed = after.frames.filter((frame, index) => frame !== before.frames[index]).length;
    // What was said meanwhile stays on screen.
    this.#show(waiting.reduce(withSaid, after), waiting.length > 0 ? now.run : { phase: 'done', cause: 'corrected', changed });
  }

  /** What is painted when a box or a click points to an object. */
  async #outlined(version: Version, { frame, id, at }: Pointed, signal: AbortSignal): Promise<Map<number, Uint8Array>> {
    const { tracked, pair } = this.#store.get();
    const span = spanAt(version.spans, frame);
    if (tracked === null || span === null) return new Map();
    const { first } = span.range;
    const label = theirNumber(span.numbers, id);
    const hand = [pair.first, pair.second].filter((frame) => frame !== null);
    let labels: Uint8Array | undefined;
    const found = this.#segmenter.segmentClip(new ClipFrames(tracked.clip, version.longestSide, span.range, { hand, room: ROOM }), {
      state: (await bytesOf(span.state))!,
      changesOnly: true,
      signal,
      corrections: [at.length === 2 ? { frame: frame - first, label, click: at } : { frame: frame - first, label, box: at }],
      locked: lockedIn(span, version, [], (id) => isLocked({ locks: version.locks, names: tracked.names }, id)),
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
      this.#refuse(strings.notices.nothingThere);
      return new Map();
    }
    const { width } = version.frames[frame]!.runs;
    const [left, top, columns = width, rows = labels.length] = at.length === 2 ? [0, 0] : at;
    const isWithin = (p: number): boolean => p % width >= left && p % width < left + columns && p / width >= top && p / width < top + rows;
    return new Map([[frame, labels.map((own, p) => (own === label && isWithin(p) ? id : own === 0 ? 0 : UNLABELLED))]]);
  }

  /** Shows frames as a correction changes them: those on screen at once, others soon. */
  #shows(carrying: Carrying): (index: number, masks: TrackedFrame) => void {
    const changed = new Set<number>();
    let shown = -Infinity;
    return (index, masks) => {
      const { now, waiting } = carrying;
      changed.add(index);
      carrying.now = { ...now, frames: now.frames.with(index, masks), largest: Math.max(now.largest, ...masks.objects.map(({ id }) => id)) };
      const { timeline } = this.#store.get();
      if (index !== timeline?.first && index !== timeline?.second && performance.now() - shown < OFTEN) return;
      shown = performance.now();
      this.#show(waiting.reduce(withSaid, carrying.now), { ...CARRYING, labelled: changed.size });
    };
  }

  /**
   * Applies what became of objects to the frames of a span, and what was painted in some of them. `changes` takes frames as they change,
   * perhaps not for the last time.
   */
  async #applied(
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
    const hand = [pair.first, pair.second].filter((frame) => frame !== null);
    const frames = new ClipFrames(tracked.clip, version.longestSide, span.range, { hand, room: ROOM });
    const corrections = painted.map((index) => ({ frame: index - first, labels: toSpan(version.painted.get(index)!, numbers) }));
    let { largest } = version;
    const named = (frame: ClipFrame): TrackedFrame => {
      const masks = fromSpan(masksOf(frame, frames.size), numbers, largest);
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
      state: (await bytesOf(span.state))!,
      markUnknown: settings.markUnknown,
      changesOnly: true,
      signal,
      transfer: true,
      edits: editsIn(numbers, version.became),
      corrections,
      // When the clip is segmented again, all is said again that was said before objects were locked.
      locked: changes ? lockedIn(span, version, painted, (id) => isLocked({ locks: version.locks, names: tracked.names }, id)) : [],
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
    return { ...version, frames: masks, spans, largest };
  }

  /** Another version of the masks. */
  #show(version: Version, run: ClipRun): void {
    const { tracked } = this.#store.get();
    if (tracked === null) return;
    this.#store.set({ tracked: { ...tracked, ...versionOf(version), run } });
    const { selected } = this.#store.get().look;
    const now = version.became.get(selected ?? 0);
    if (now !== undefined) this.#store.look({ selected: now === 0 ? null : now });
    this.#hooks.changed(tracked);
  }

  #go(from: 'past' | 'future', to: 'past' | 'future', cause: 'undone' | 'redone'): void {
    const { tracked } = this.#store.get();
    if (tracked === null) return;
    const carrying = this.#carrying;
    if (carrying !== null && from === 'past') {
      // The last correction is what is undone.
      if (carrying.waiting.pop() === undefined) return this.#abort();
      return this.#show(carrying.waiting.reduce(withSaid, carrying.now), tracked.run);
    }
    if (tracked.run.phase === 'working') return;
    const version = tracked[from].at(-1);
    if (version === undefined) return;
    const { frames } = tracked;
    const changed = version.frames.filter((frame, index) => frame !== frames[index]).length;
    this.#store.set({ tracked: { ...tracked, [from]: tracked[from].slice(0, -1), [to]: [...tracked[to], versionOf(tracked)] } });
    this.#show(version, { phase: 'done', cause, changed });
  }

  /** Runs `work` instead of what is under way. `set` changes what is known of the clip, unless the run has ended. */
  async #run(work: (signal: AbortSignal, set: Change) => Promise<void>): Promise<void> {
    this.#current?.abort();
    const own = (this.#current = new AbortController());
    const { signal } = own;
    const set: Change = (change) => {
      const { tracked } = this.#store.get();
      if (tracked !== null && !signal.aborted) this.#store.set({ tracked: { ...tracked, ...change } });
    };
    try {
      await work(signal, set);
    } catch (error) {
      if (signal.aborted) return;
      set({ run: { phase: 'failed' } });
      this.#hooks.failed(codeOf(error) === 'invalid-option' ? new PageError('other-state', strings.notices.otherState) : error);
    } finally {
      if (this.#current === own) this.#current = null;
    }
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
      set({ frames, largest: largestOf(frames), longestSide, saved: savedOf({ ...before, frames }) });
      this.#hooks.changed(before);
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
    const { past, painted, became } = before;
    const isFirst = before.found.every((runs) => runs === null);
    const numbers = isFirst ? new Map(masks.flatMap(({ objects }) => objects.map(({ id }) => [id, id] as const))) : numbersOf(masks, range, before);
    let version = withRun(versionOf(before), masks, { range, state: blobOf(state), numbers }, longestSide);
    const said = [...painted.keys()].filter((index) => contains(range, index));
    const corrected = said.length > 0 || became.size > 0;
    if (corrected) version = await this.#applied(version, version.spans.at(-1)!, said, signal);
    const { tracked: now } = this.#store.get();
    if (signal.aborted || now === null) return;
    // What a person corrected can be brought back.
    if (past.length > 0) set({ past: [...past, versionOf(before)] });
    else if (now.saved.frames === now.frames) set({ saved: { ...now.saved, frames: version.frames } });
    set({ future: [] });
    this.#show(version, corrected && run.phase === 'done' ? { ...run, cause: 'repeated' } : run);
  }

  /** What is known for these settings: other settings and another first frame begin anew. */
  #knownOf({ fingerprint }: Clip, { first }: Range, settings: Settings): SolvedPairs {
    const key = JSON.stringify([first, settings.motions, settings.quality, settings.longestSide]);
    const before = this.#known.get(fingerprint);
    const known = before?.settings === key ? before : { settings: key, pairs: new Map<number, Blob>() };
    this.#known.set(fingerprint, known);
    return known;
  }
}

async function bytesOf(blob: Blob | undefined): Promise<Uint8Array | undefined> {
  return blob === undefined ? undefined : new Uint8Array(await blob.arrayBuffer());
}

function blobOf(bytes: Uint8Array): Blob {
  return new Blob([new Uint8Array(bytes)]);
}

function masksOf({ labels, objects, background }: ClipFrame, { width, height }: { readonly width: number; readonly height: number }): TrackedFrame {
  return { runs: packed(labels, width, height), objects, background };
}

/** The largest number of an object in these frames. */
function largestOf(frames: Version['frames']): number {
  return frames.reduce((most, frame) => (frame?.objects ?? []).reduce((larger, { id }) => Math.max(larger, id), most), 0);
}
