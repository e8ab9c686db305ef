//! Which frames are on screen: a pair, with its place in a clip. Frames are put there with the work on them that is kept. The pair and the
//! timeline are in the state; how far the two frames are apart is kept here, because near the end of a clip they cannot be.

import type { Clip } from '../clips/clip.js';
import { WHOLE } from '../drawing/viewport.js';
import type { Header } from '../projects/file.js';
import type { Projects } from '../projects/projects.js';
import { type FramePair, type LoadedFrame, type Slot, type Timeline, timelineOf } from '../state/pair.js';
import { FRESH, type Look, type Store } from '../state/state.js';
import { isSeen, largestChanges, livesOf } from '../state/tracked.js';
import type { Camera } from './camera/camera.js';
import { isFrameOf } from './clip/frames.js';
import type { Objects } from './clip/objects.js';
import type { ClipSegmenting } from './clip/segmenting.js';
import type { Opening } from './opening.js';
import type { PairSegmenting } from './pair/segmenting.js';
import type { PairWorker } from './pair/worker.js';
import type { Shown } from './shown.js';

/** Distance between the two frames when a clip is opened. */
export const FRAMES_APART = 1;

/** The parts that change with the frames. */
interface Parts {
  readonly opening: Opening;
  readonly worker: PairWorker;
  readonly camera: Camera;
  readonly clip: ClipSegmenting;
  readonly pair: PairSegmenting;
  readonly objects: Objects;
  readonly shown: Shown;
  readonly projects: Projects;
}

export class Frames {
  readonly #store: Store;
  readonly #parts: Parts;
  #apart = FRAMES_APART;

  constructor(store: Store, parts: Parts) {
    this.#store = store;
    this.#parts = parts;
  }

  /** Chooses one frame of the open clip; the index is clamped. */
  choose(slot: Slot, index: number): Promise<void> {
    const { timeline } = this.#store.get();
    if (timeline === null) return Promise.resolve();
    const places = { ...timeline, [slot]: clamped(Math.round(index), timeline.clip.count) };
    this.#apart = places.second - places.first;
    return this.#goTo(places);
  }

  /** Steps both frames. */
  step(by: number): Promise<void> {
    const { timeline } = this.#store.get();
    return timeline === null ? Promise.resolve() : this.goTo(timeline.first + by);
  }

  /** Goes to a frame of the clip. The second frame keeps its distance, except that masks of a clip can be seen up to its ends. */
  goTo(index: number): Promise<void> {
    const { timeline, look } = this.#store.get();
    if (timeline === null) return Promise.resolve();
    const { clip } = timeline;
    const apart = this.#apart;
    const [least, most] = look.kind === 'objects' ? [0, clip.count - 1] : [Math.max(0, -apart), clip.count - 1 - Math.max(0, apart)];
    const at = Math.min(Math.max(index, least), most);
    return this.#goTo({ first: at, second: clamped(at + apart, clip.count) });
  }

  /** Goes to the frame where an object is least certain, by default the selected one; then, or if none is selected, to that of the next or previous. */
  goToDoubtful(id: number | null = null, by: 1 | -1 = 1): void {
    const { tracked, look, timeline } = this.#store.get();
    if (tracked === null || look.kind !== 'objects') return;
    const lives = livesOf(tracked);
    const selected = lives.findIndex((life) => life.id === (id ?? look.selected));
    const seen = id === null && selected >= 0 && lives[selected]!.doubtful.index === timeline?.first;
    const life = lives[(selected < 0 ? 0 : selected + by * Number(seen) + lives.length) % lives.length];
    if (life === undefined) return;
    this.#parts.shown.select(life.id);
    this.#store.clip({ checked: new Map(tracked.checked).set(life.id, life.doubtful.index) });
    void this.goTo(life.doubtful.index);
  }

  /** Goes to the next frame that a person has corrected, or to the one before. */
  goToCorrected(by: 1 | -1): void {
    const { tracked, timeline } = this.#store.get();
    const at = timeline?.first ?? 0;
    const corrected = [...(tracked?.annotated.keys() ?? [])].sort((one, other) => by * (one - other));
    const next = corrected.find((index) => by * (index - at) > 0);
    if (next !== undefined) void this.goTo(next);
  }

  /** Goes to the frame that the last correction changed most; from there to the next one. */
  goToChanged(): void {
    const { tracked, timeline, look } = this.#store.get();
    if (tracked === null || look.kind !== 'objects') return;
    const changed = largestChanges(tracked);
    const next = changed[(changed.indexOf(timeline?.first ?? -1) + 1) % changed.length];
    if (next !== undefined) void this.goTo(next);
  }

  /** Swaps the two frames. */
  swap(): void {
    const { first, second } = this.#store.get().pair;
    this.#apart *= -1;
    this.#parts.opening.giveUp();
    this.#setPair({ first: second, second: first });
  }

  /** Loads frames and puts them into the pair, with the work on them that is kept. `then`: after that. `as`: as `Opening.open` takes it. */
  open(
    load: (signal: AbortSignal) => Promise<readonly LoadedFrame[]>,
    place: (frames: readonly LoadedFrame[], pair: FramePair) => FramePair,
    then: (found: Header | null) => void = () => undefined,
    as?: number | 'step',
  ): Promise<void> {
    const { opening, worker, camera, clip, objects, projects } = this.#parts;
    worker.prepare();
    return opening.open(
      async (signal) => {
        const frames = await load(signal);
        // A step goes on in the clip that is open.
        const project = as === 'step' ? null : await projects.find(place(frames, this.#store.get().pair));
        const opened = timelineOf(place(frames, this.#store.get().pair))?.clip;
        if (project !== null && opened !== undefined) await clip.prepare(opened);
        // What was begun on the frame that is still on screen is of that frame.
        if (as === 'step') await objects.drawn();
        return { frames, project };
      },
      ({ frames, project }) => {
        const pair = place(frames, this.#store.get().pair);
        if (frames.length > 0) camera.stop();
        if (project !== null) objects.finishStroke();
        if (frames.length > 0 || project !== null) this.#setPair(pair);
        if (project !== null) projects.restore(project);
        if (project !== null) this.#continue(project);
        then(project);
      },
      ({ frames, project }) => {
        if (project !== null) clip.giveUp();
        const { first, second } = this.#store.get().pair;
        for (const frame of frames) {
          const { bitmap, origin } = frame;
          if (frame !== first && frame !== second) bitmap.close();
          if (origin !== undefined && origin.clip !== this.#store.get().timeline?.clip) origin.clip.close();
        }
      },
      as,
    );
  }

  /** A frame of a clip at the size that the settings ask for. */
  async read(clip: Clip, index: number): Promise<LoadedFrame> {
    return { ...(await clip.frame(index, this.#store.get().settings.longestSide)), origin: { clip, index } };
  }

  /** Goes to other frames of the clip. The timeline moves at once; the pair changes when the frames are loaded. */
  #goTo(places: Partial<Pick<Timeline, Slot>>): Promise<void> {
    const { timeline, pair } = this.#store.get();
    if (timeline === null) return Promise.resolve();
    const { clip } = timeline;
    const wanted: Timeline = { ...timeline, ...places };
    const shown = timelineOf(pair);
    const missing = (['first', 'second'] as const).filter((slot) => wanted[slot] !== shown?.[slot]).map((slot) => ({ slot, index: wanted[slot] }));
    if (missing.length === 0) {
      this.#parts.opening.stay();
      return Promise.resolve();
    }
    this.#parts.objects.finishStroke();
    this.#store.set({ timeline: wanted });
    return this.open(
      async () => {
        const { longestSide } = this.#store.get().settings;
        const frames: LoadedFrame[] = [];
        for (const { index } of missing) {
          const known = [pair.first, pair.second, ...frames].find((frame) => frame !== null && isFrameOf(frame, clip, index, longestSide));
          frames.push(known ?? (await this.read(clip, index)));
        }
        return frames;
      },
      (frames, now) => ({ ...now, ...Object.fromEntries(missing.map(({ slot }, k) => [slot, frames[k]])) }),
      undefined,
      'step',
    );
  }

  /** Goes to where the work on a clip was left. */
  #continue({ at, hidden }: Header): void {
    this.#parts.shown.kind('objects');
    if (this.#store.get().look.kind === 'objects') this.#store.look({ hidden: new Set(hidden) });
    void this.goTo(at);
  }

  #setPair(pair: FramePair): void {
    const { clip, pair: segmenting, objects, shown } = this.#parts;
    objects.finishStroke();
    segmenting.stop();
    const { look, pair: before, viewport, timeline: left } = this.#store.get();
    const only: Slot = pair.first === null && pair.second !== null ? 'second' : 'first';
    const complete = pair.first !== null && pair.second !== null;
    const view = complete && look.view === 'split' ? 'split' : only;
    const sameSize = before.first !== null && pair.first !== null && before.first.width === pair.first.width && before.first.height === pair.first.height;
    const timeline = timelineOf(pair);
    const sameClip = left?.clip === timeline?.clip;
    const tracked = clip.of(timeline?.clip ?? null);
    const kind = isSeen(tracked) && (!sameClip || look.kind === 'objects') ? 'objects' : look.kind === 'objects' ? 'groups' : look.kind;
    // The objects of a clip are the same in all its frames.
    const same = kind === 'objects' && sameClip;
    const carried: Look = same ? { ...look, stabilised: null, blinking: false } : { ...look, ...FRESH, kind };
    if (!same && timeline !== null) this.#apart = timeline.second - timeline.first;
    shown.pair(pair, { ...carried, view }, { timeline, tracked, forced: null, viewport: sameSize ? viewport : WHOLE });
    // The old frames are no longer drawn: free their memory now, not at the next garbage collection.
    for (const frame of [before.first, before.second]) if (frame !== pair.first && frame !== pair.second) frame?.bitmap.close();
    if (left !== null && !sameClip) left.clip.close();
  }
}

function clamped(index: number, count: number): number {
  return Math.min(Math.max(index, 0), count - 1);
}
