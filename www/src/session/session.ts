//! What the page does: open frames, choose them from a clip, segment, correct, cancel. Views call these methods and read the state. Every
//! failure ends as a notice in the state, and the page stays usable.

import type { Clip } from '../clips/clip.js';
import { openClip } from '../clips/open.js';
import { PageError } from '../common/errors.js';
import { strings } from '../common/strings.js';
import { NO_EDITS } from '../correction/edits.js';
import type { Path, Stroke } from '../correction/strokes.js';
import { WHOLE } from '../drawing/viewport.js';
import { type ImageFolder, folderOfAll, foldersOf, likelyFrames, nameIn, selectOpenable, withPath } from '../frames/files.js';
import { fetchImage, frameFromBlob, smaller } from '../frames/frame.js';
import { SAMPLES, type Sample, type SampleClip, type SamplePair } from '../frames/samples.js';
import type { Project, ProjectClip } from '../projects/project.js';
import { Projects } from '../projects/projects.js';
import type { Kind } from '../result/masks.js';
import { type FramePair, type LoadedFrame, type Slot, type Timeline, timelineOf } from '../state/pair.js';
import type { Settings } from '../state/settings.js';
import { FRESH, type Look, type Run, type State, type Store, isCurrent, isPending } from '../state/state.js';
import { type Tracked, isTracked, livesOf } from '../state/tracked.js';
import { Correcting } from './correcting.js';
import type { LiveView } from './camera/live.js';
import { fail, loaded, report } from './failures.js';
import { frameOf, resultOf } from '../state/objects.js';
import { PairWorker } from './pair/worker.js';
import { Tracking } from './tracking.js';

/** Distance between the two frames when a clip is opened. */
const FRAMES_APART = 1;

/** Frame rate at which folders are played, as their frames have no times. */
const FRAMES_PER_SECOND = 25;

/** The state of a run before its first stage. */
const STARTING: Run = { phase: 'working', work: 'segmenting', stage: '', index: 0, of: 0 };

export class Session {
  readonly #store: Store;
  readonly #segmenting = new PairWorker();
  readonly correcting: Correcting;
  readonly tracking: Tracking;
  readonly projects: Projects;
  /** Loaded when the camera is used. */
  #live: LiveView | null = null;
  /** Incremented by each opening, so that a slow one never replaces a later one. */
  #opened = 0;
  /** Distance between the two frames of the clip. */
  #apart = FRAMES_APART;
  /** The frame to which a pointer was dragged and that is not read yet. */
  #wanted: number | null = null;

  constructor(store: Store) {
    this.#store = store;
    this.correcting = new Correcting(store, this.#segmenting, (error) => fail(this.#store, error));
    this.tracking = new Tracking(store, {
      changed: (before) => this.#showObjects(before),
      failed: (error) => report(this.#store, error),
      say: (sentence) => this.say(sentence),
    });
    this.projects = new Projects(store, this.tracking);
  }

  /** Opens a sample and segments it. `swapped`: a pair with the second frame first. */
  openSample(sample: Sample = SAMPLES[0], swapped = false): Promise<void> {
    return this.#openFrames(
      async () => {
        if ('frames' in sample) return this.#startOf(await openFolderOf(sample), sample.start);
        return Promise.all((swapped ? (['second', 'first'] as const) : (['first', 'second'] as const)).map((slot) => this.#frameOfSample(sample, slot)));
      },
      pairOf,
      () => {
        if (!isTracked(this.#store.get().tracked)) void this.tracking.segment();
      },
    );
  }

  /**
   * Opens files. A video or more than two images is a clip to choose frames from. Two images make a new pair, in the order of their
   * names. One image goes into `slot`; without a slot, it becomes the missing second frame or the first of a new pair. A project continues
   * with its frames: those given with it, those on screen, or whenever they are opened. Masks are imported.
   */
  async openFiles(files: Iterable<File> | Promise<Iterable<File>>, slot: Slot | null = null): Promise<void> {
    try {
      const given = [...(await files)];
      const isOfClip = slot === null && this.#store.get().tracked !== null;
      const maybe = isOfClip && given.some(({ name }) => /\.(json|png|txt|xml|zip)$/i.test(name));
      const importing = maybe ? await loaded(import('./clip/importing.js')) : null;
      if (importing === null || !(await importing.areMasks(given, this.#store.get()))) await this.#openGiven(given, slot);
      else await importing.importMasks(given, this.#store, this);
    } catch (error) {
      report(this.#store, error);
    }
  }

  #openGiven(files: readonly File[], slot: Slot | null): Promise<void> {
    let opened: Project | null = null;
    let leftOut = '';
    let folder: Clip | null = null;
    return this.#openFrames(
      async () => {
        const { project, video, images: all } = selectOpenable(files);
        if (project !== null) opened = await this.projects.open(project);
        if (video !== null) return this.#startOf(await openClip(video));
        const folders = foldersOf(all);
        const [likely, ...others] = likelyFrames(folders);
        const images = others.length > 0 ? await this.#chosen(folders, all) : (likely?.images ?? []);
        if (images === null) return [];
        if (others.length === 0 && images.length < all.length) leftOut = strings.notices.leftOut(likely!.path, all.length - images.length);
        if (images.length > 2) {
          const { openFolder } = await loaded(import('../clips/folder.js'));
          return this.#startOf((folder = await openFolder(images)));
        }
        if (images.length === 0 && project !== null) return [];
        if (images.length === 0) throw new PageError('no-image', strings.notices.noFiles);
        const { longestSide } = this.#store.get().settings;
        const read = images.map((image) => frameFromBlob(image, nameIn(folderOfAll(images), image), longestSide));
        // Of several that cannot be read, the first one is named.
        await Promise.allSettled(read);
        return Promise.all(read);
      },
      (frames, pair) => {
        if (frames.length === 2) return pairOf(frames);
        const [frame] = frames;
        if (frame === undefined) return pair;
        if (slot !== null) return { ...pair, [slot]: frame };
        return pair.first !== null && pair.second === null ? { ...pair, second: frame } : { first: frame, second: null };
      },
      (found) => {
        if (opened !== null && found !== opened) this.say(strings.projects.waiting(opened.name));
        else if (leftOut !== '') this.say(leftOut);
        if (folder !== null) void this.#checkSizes(folder);
      },
    );
  }

  /** Chooses one frame of the open clip; the index is clamped. */
  choose(slot: Slot, index: number): Promise<void> {
    const { timeline } = this.#store.get();
    if (timeline === null) return Promise.resolve();
    const places = { ...timeline, [slot]: clamped(Math.round(index), timeline.clip.count) };
    if (places.first !== null && places.second !== null) this.#apart = places.second - places.first;
    return this.#goTo(places);
  }

  /** Steps all frames that are of the clip. */
  step(by: number): Promise<void> {
    const { timeline } = this.#store.get();
    const at = timeline?.first ?? timeline?.second ?? null;
    return at === null ? Promise.resolve() : this.goTo(at + by);
  }

  /** Goes to a frame of the clip. The second frame keeps its distance, except that masks of a clip can be seen up to its ends. */
  goTo(index: number): Promise<void> {
    const { timeline, look } = this.#store.get();
    if (timeline === null) return Promise.resolve();
    const { first, second, clip } = timeline;
    if (first === null || second === null) {
      const slot = first === null ? 'second' : 'first';
      return this.#goTo({ [slot]: clamped(index, clip.count) });
    }
    const apart = this.#apart;
    const [least, most] = look.kind === 'objects' ? [0, clip.count - 1] : [Math.max(0, -apart), clip.count - 1 - Math.max(0, apart)];
    const at = Math.min(Math.max(index, least), most);
    return this.#goTo({ first: at, second: clamped(at + apart, clip.count) });
  }

  /** Goes to the frame where an object is least certain, by default the selected one; then, or if none is selected, to that of the next. */
  goToDoubtful(id: number | null = null): void {
    const { tracked, look, timeline } = this.#store.get();
    if (tracked === null || look.kind !== 'objects') return;
    const lives = livesOf(tracked);
    const selected = lives.findIndex((life) => life.id === (id ?? look.selected));
    const seen = id === null && selected >= 0 && lives[selected]!.doubtful.index === timeline?.first;
    const life = lives[(selected < 0 ? 0 : selected + Number(seen)) % lives.length];
    if (life === undefined) return;
    this.select(life.id);
    this.#store.set({ tracked: { ...tracked, checked: new Map(tracked.checked).set(life.id, life.doubtful.index) } });
    void this.goTo(life.doubtful.index);
  }

  /** Goes to the frames that a pointer is dragged over, but reads none that it has left meanwhile. */
  async scrub(index: number): Promise<void> {
    const waits = this.#wanted !== null;
    this.#wanted = index;
    if (waits) return;
    while (this.#wanted !== null) {
      const wanted: number = this.#wanted;
      await this.goTo(wanted);
      if (this.#wanted === wanted) this.#wanted = null;
    }
    this.#rest();
  }

  /** Plays the clip from the current frame, or stops. */
  async togglePlaying(): Promise<void> {
    const { playing, timeline } = this.#store.get();
    this.#store.set({ playing: !playing });
    if (playing || timeline === null) return;
    const { clip, first } = timeline;
    let at = first === null || first >= clip.count - 1 ? -1 : first;
    while (this.#store.get().playing && at < clip.count - 1) {
      const began = performance.now();
      const next = at + 1;
      await this.goTo(next);
      const now = this.#store.get().timeline;
      if (now?.clip !== clip || now.first !== next) break; // the end of the pair, or gone elsewhere
      await new Promise((resolve) => setTimeout(resolve, durationOf(clip, next) - (performance.now() - began)));
      at = next;
    }
    this.#store.set({ playing: false });
    this.#rest();
  }

  /** Segments the pair at which the clip was left: those that it passed were not. */
  #rest(): void {
    const { run, playing } = this.#store.get();
    if (run.phase === 'idle' && !playing && this.#wanted === null) void this.segment();
  }

  /** Switches the camera on, or off: its last two frames become a pair. */
  toggleLive(): Promise<void> {
    if (this.#store.get().live !== null) {
      this.#live?.stop();
      return this.segment();
    }
    return this.#open(
      async (): Promise<() => void> => {
        const turn: number = this.#opened;
        const { LiveView } = await loaded(import('./camera/live.js'));
        this.#live ??= new LiveView(this.#store, (error) => fail(this.#store, error));
        return turn === this.#opened ? this.#live.start() : () => undefined;
      },
      (show) => {
        this.correcting.keep();
        this.#stop();
        const { timeline } = this.#store.get();
        this.tracking.of(null);
        show();
        timeline?.clip.close();
      },
    );
  }

  /** Swaps the two frames. */
  swap(): void {
    const { first, second } = this.#store.get().pair;
    this.#apart *= -1;
    this.#invalidate();
    this.#setPair({ first: second, second: first });
  }

  /** Changes settings and segments the pair again. */
  change(settings: Partial<Settings>): void {
    const { settings: before, motionsElsewhere } = this.#store.get();
    this.#store.set({ settings: { ...before, ...settings }, motionsElsewhere: settings.motions === undefined ? motionsElsewhere : null });
    // The masks of a clip stay until it is segmented again.
    const { live, look } = this.#store.get();
    if (live === null && look.kind !== 'objects') void this.segment();
  }

  /** Sets the number of motions for this pair alone. */
  forceMotions(motions: number): void {
    const { settings, motionsElsewhere } = this.#store.get();
    this.change({ motions });
    this.#store.set({ motionsElsewhere: motionsElsewhere ?? settings.motions });
  }

  /** Resumes what was cancelled. */
  again(): void {
    if (isCurrent(this.#store.get())) this.correcting.settle(isPending(this.#store.get()) ? 'solved' : 'found');
    else void this.segment();
  }

  /** Segments the pair with the current settings; idle if a frame is missing. */
  async segment(): Promise<void> {
    const { pair, settings } = this.#store.get();
    const { first, second } = pair;
    this.correcting.interrupt();
    if (first === null || second === null) {
      this.#segmenting.cancel();
      this.#store.set({ run: { phase: 'idle' } });
      return;
    }
    this.#store.set({ run: STARTING });
    const began = performance.now();
    try {
      // A fast preview of a new pair, shown until the best result is ready.
      if (settings.quality === 'best' && this.#store.get().result === null) {
        const preview = await this.#segmenting.run({ first, second }, { ...settings, quality: 'fast' });
        if (preview === null) return;
        await this.correcting.accept(preview, { first, second }, began, false);
      }
      const segmentation = await this.#segmenting.run({ first, second }, settings, ({ stage, index, of }) =>
        this.#store.set({ run: { phase: 'working', work: 'segmenting', stage, index, of } }),
      );
      if (segmentation !== null) await this.correcting.accept(segmentation, { first, second }, began, true);
    } catch (error) {
      fail(this.#store, error);
    }
  }

  /** Begins a stroke with the selected mask. Returns what takes its path, or `null`, and tells why, if it would have no effect. */
  beginStroke(tool: Stroke['tool']): ((path: Path) => void) | null {
    if (this.#store.get().look.kind === 'objects') return this.tracking.beginStroke(tool);
    const mask = this.correcting.maskFor(tool);
    return mask === null ? null : (path) => this.correcting.stroke({ ...path, tool, mask });
  }

  /** Begins a box around a new object of the clip, or a click on it. Returns what takes its corners, or `null`, and tells why. */
  beginBox(): ((path: Path) => void) | null {
    return this.tracking.beginBox();
  }

  undo(): void {
    if (this.#store.get().look.kind === 'objects') this.tracking.undo();
    else this.correcting.undo();
  }

  redo(): void {
    if (this.#store.get().look.kind === 'objects') this.tracking.redo();
    else this.correcting.redo();
  }

  /** Selects a mask. */
  select(mask: number | null): void {
    if (this.#store.get().look.selected !== mask) this.#store.look({ selected: mask });
  }

  /** Stops at once; the last result stays. */
  cancel(): void {
    const { run, opening } = this.#store.get();
    if (opening) return this.#stopOpening();
    if (run.phase !== 'working') return this.tracking.cancel();
    this.#stop();
    this.#store.set({ run: { phase: 'cancelled' } });
  }

  /** Shows masks of this kind. Mask numbers change meaning, so choices that refer to them are reset. */
  show(kind: Kind): void {
    const { look, pair, tracked, live } = this.#store.get();
    if (live !== null || look.kind === kind || (kind === 'objects' && !isTracked(tracked))) return;
    const { hidden, solo, stabilised, selected } = FRESH;
    if (kind !== 'objects' && look.kind !== 'objects') return this.#store.look({ kind, hidden, solo, stabilised, selected });
    this.correcting.keep();
    this.#stop();
    this.#showMasks(pair, { ...look, ...FRESH, kind });
  }

  /** Shows the masks of the clip as soon as there are any, and whenever those on screen change. */
  #showObjects(before: Tracked): void {
    const { look, pair, tracked } = this.#store.get();
    if (tracked === null) return;
    if (!isTracked(before)) return this.show('objects');
    const frames = [pair.first, pair.second].filter((frame) => frame !== null);
    const changed = frames.some((frame) => frameOf(tracked, frame) !== frameOf(before, frame));
    if (look.kind === 'objects' && changed) this.#store.set({ result: resultOf(tracked, pair) });
  }

  #stop(): void {
    this.#segmenting.cancel();
    this.correcting.interrupt();
  }

  /** Shows a notice; with a code it is an error. */
  say(sentence: string, code: string | null = null): void {
    this.#store.say(sentence, code);
  }

  /** The images of the folder that the person chooses, or all; `null` if none. */
  async #chosen(folders: readonly ImageFolder[], images: readonly File[]): Promise<readonly File[] | null> {
    const turn = this.#opened;
    const chosen = await new Promise<readonly File[] | null>((resolve) => {
      const answer = (files: readonly File[] | null): void => {
        this.#store.set({ question: null });
        resolve(files);
      };
      this.#store.set({ question: { folders, images, answer } });
    });
    if (chosen === null && turn === this.#opened) this.#stopOpening();
    return chosen;
  }

  /** Tells of a frame that has another size than the clip, which ends where it is segmented. */
  async #checkSizes(clip: Clip): Promise<void> {
    const other = await clip.otherSize?.();
    if (!other || this.#store.get().timeline?.clip !== clip) return;
    this.say(strings.errors.otherSize(clip.nameOf(other.index), other, clip), 'frame-size-mismatch');
  }

  /** Two frames of a clip. */
  async #startOf(clip: Clip, at = 0): Promise<LoadedFrame[]> {
    try {
      return [await this.#frameOf(clip, at), await this.#frameOf(clip, Math.min(at + FRAMES_APART, clip.count - 1))];
    } catch (error) {
      clip.close();
      throw error;
    }
  }

  async #frameOf(clip: Clip, index: number): Promise<LoadedFrame> {
    return { ...(await clip.frame(index, this.#store.get().settings.longestSide)), origin: { clip, index } };
  }

  async #frameOfSample(sample: SamplePair, slot: Slot): Promise<LoadedFrame> {
    const image = await fetchImage(sample[slot]);
    return { ...(await frameFromBlob(image, image.name, this.#store.get().settings.longestSide)), origin: { sample, slot } };
  }

  /** Goes to other frames of the clip. The timeline moves at once; the pair changes when the frames are loaded. */
  #goTo(places: Partial<Pick<Timeline, Slot>>): Promise<void> {
    const { timeline, pair, opening } = this.#store.get();
    if (timeline === null) return Promise.resolve();
    const { clip } = timeline;
    const wanted: Timeline = { ...timeline, ...places };
    const shown = timelineOf(pair);
    const missing = (['first', 'second'] as const).flatMap((slot) => {
      const index = wanted[slot];
      return index === null || index === shown?.[slot] ? [] : [{ slot, index }];
    });
    if (missing.length === 0) {
      if (opening) this.#stopOpening();
      return Promise.resolve();
    }
    this.#store.set({ timeline: wanted });
    return this.#openFrames(
      async () => {
        const { longestSide } = this.#store.get().settings;
        const isSized = ({ full, width }: LoadedFrame): boolean => smaller(full, longestSide).width === width;
        const frames: LoadedFrame[] = [];
        for (const { index } of missing) frames.push([pair.first, pair.second, ...frames].find((frame) => frame !== null && isOf(frame, clip, index) && isSized(frame)) ?? (await this.#frameOf(clip, index)));
        return frames;
      },
      (frames, now) => ({ ...now, ...Object.fromEntries(missing.map(({ slot }, k) => [slot, frames[k]])) }),
    );
  }

  /** Loads frames and puts them into the pair, with the work on them that is kept. `then`: after that. */
  #openFrames(
    load: () => Promise<readonly LoadedFrame[]>,
    place: (frames: readonly LoadedFrame[], pair: FramePair) => FramePair,
    then: (found: Project | null) => void = () => undefined,
  ): Promise<void> {
    this.#segmenting.prepare();
    return this.#open(
      async () => {
        const frames = await load();
        return { frames, project: await this.projects.find(place(frames, this.#store.get().pair)) };
      },
      ({ frames, project }) => {
        const pair = place(frames, this.#store.get().pair);
        if (frames.length > 0) this.#live?.stop();
        if (project !== null) this.correcting.keep();
        this.projects.restore(project, pair);
        if (frames.length > 0 || project !== null) this.#setPair(pair);
        if (project?.clip) this.#continue(project.clip);
        then(project);
      },
      ({ frames }) => {
        const { first, second } = this.#store.get().pair;
        for (const frame of frames) {
          const { bitmap, origin } = frame;
          if (frame !== first && frame !== second) bitmap.close();
          if (origin !== undefined && 'clip' in origin && origin.clip !== this.#store.get().timeline?.clip) origin.clip.close();
        }
      },
    );
  }

  /** Goes to where the work on a clip was left. */
  #continue({ at, hidden }: ProjectClip): void {
    this.show('objects');
    if (this.#store.get().look.kind === 'objects') this.#store.look({ hidden: new Set(hidden) });
    void this.tracking.renew();
    void this.goTo(at);
  }

  /**
   * Opens something. The current pair stays, and work on it continues, until `take` is called with its replacement. The last request wins;
   * earlier ones are discarded.
   */
  async #open<T>(load: () => Promise<T>, take: (opened: T) => void, discard: (opened: T) => void = () => undefined): Promise<void> {
    const turn = this.#invalidate();
    this.#store.set({ opening: true, notice: null });
    try {
      const opened = await load();
      if (turn !== this.#opened) return discard(opened);
      this.#store.set({ opening: false });
      take(opened);
    } catch (error) {
      if (turn !== this.#opened) return;
      this.#stopOpening();
      report(this.#store, error);
    }
  }

  /** Invalidates whatever is being opened. */
  #invalidate(): number {
    if (this.#store.get().live === null) this.#live?.stop();
    this.#store.get().question?.answer(null);
    return ++this.#opened;
  }

  /** Stops opening: the timeline returns to the frames on screen. */
  #stopOpening(): void {
    this.#invalidate();
    this.#store.set({ opening: false, timeline: timelineOf(this.#store.get().pair) });
  }

  #setPair(pair: FramePair): void {
    this.correcting.keep();
    this.#stop();
    const { look, pair: before, viewport, timeline: left } = this.#store.get();
    const only: Slot = pair.first === null && pair.second !== null ? 'second' : 'first';
    const complete = pair.first !== null && pair.second !== null;
    const view = complete && look.view === 'split' ? 'split' : only;
    const sameSize = before.first !== null && pair.first !== null && before.first.width === pair.first.width && before.first.height === pair.first.height;
    const timeline = timelineOf(pair);
    const sameClip = left?.clip === timeline?.clip;
    const tracked = this.tracking.of(timeline?.clip ?? null);
    const kind = isTracked(tracked) && (!sameClip || look.kind === 'objects') ? 'objects' : look.kind === 'objects' ? 'groups' : look.kind;
    // The objects of a clip are the same in all its frames.
    const carried: Look = kind === 'objects' && sameClip ? { ...look, stabilised: null, blinking: false } : { ...look, ...FRESH, kind };
    if (timeline !== null && timeline.first !== null && timeline.second !== null && !(kind === 'objects' && sameClip)) this.#apart = timeline.second - timeline.first;
    this.#showMasks(pair, { ...carried, view }, { timeline, tracked, opening: false, viewport: sameSize ? viewport : WHOLE });
    // The old frames are no longer drawn: free their memory now, not at the next garbage collection.
    for (const frame of [before.first, before.second]) if (frame !== pair.first && frame !== pair.second) frame?.bitmap.close();
    if (left !== null && !sameClip) left.clip.close();
  }

  /** Shows a pair with the masks that there are: those of the clip, or its own, which are found if necessary. */
  #showMasks(pair: FramePair, look: Look, others: Partial<State> = {}): void {
    const { tracked, playing } = { ...this.#store.get(), ...others };
    if (look.kind === 'objects' && tracked !== null) {
      const { names, colours } = tracked;
      const result = resultOf(tracked, pair);
      this.#store.set({ ...others, pair, found: null, edits: NO_EDITS, result, run: { phase: 'done', cause: 'tracked' }, look: { ...look, names, colours } });
      return;
    }
    const restored = this.correcting.stateFor(pair);
    const current = isCurrent(restored);
    const passing = playing || this.#wanted !== null;
    const starting: Run = pair.first !== null && pair.second !== null && !passing ? STARTING : { phase: 'idle' };
    this.#store.set({ ...others, pair, ...restored, run: current ? { phase: 'done', cause: 'restored' } : starting, look });
    if (current) this.correcting.settle('restored');
    else if (!passing) void this.segment();
  }
}

/** Opens a sample as the folder that it is. */
async function openFolderOf(sample: SampleClip): Promise<Clip> {
  const [{ openFolder }, images] = await Promise.all([loaded(import('../clips/folder.js')), Promise.all(sample.frames.map(fetchImage))]);
  return openFolder(images.map((image) => withPath(image, `${sample.id}/${image.name}`)), sample);
}

function clamped(index: number, count: number): number {
  return Math.min(Math.max(index, 0), count - 1);
}

/** Whether a frame is that of the clip with this index. */
function isOf({ origin }: LoadedFrame, clip: Clip, index: number): boolean {
  return origin !== undefined && 'clip' in origin && origin.clip === clip && origin.index === index;
}

/** How long a frame is shown when the clip is played, milliseconds. */
function durationOf({ times }: Clip, index: number): number {
  if (times === null) return 1000 / FRAMES_PER_SECOND;
  const [now, next] = [times[index]!, times[index + 1]];
  return next === undefined ? 0 : 1000 * (next - now);
}

function pairOf([first, second]: readonly LoadedFrame[]): FramePair {
  return { first: first ?? null, second: second ?? null };
}
