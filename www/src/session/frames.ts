//! Which frames are on screen: one of a clip, and the one beside it. Frames are put there with the work on them that is kept. Both are in the
//! state, with their place in the clip.

import type { Clip } from '../clips/clip.js';
import { WHOLE } from '../drawing/viewport.js';
import type { Header } from '../projects/file.js';
import type { Projects } from '../projects/projects.js';
import { type FramePair, type LoadedFrame, type Timeline, timelineOf } from '../state/pair.js';
import { FRESH, type Store } from '../state/state.js';
import { largestChanges, livesOf } from '../state/tracked.js';
import type { Camera } from './camera/camera.js';
import { isFrameOf } from './clip/frames.js';
import type { Objects } from './clip/objects.js';
import type { ClipSegmenting } from './clip/segmenting.js';
import type { Opening } from './opening.js';
import type { Shown } from './shown.js';

/** The parts that change with the frames. */
interface Parts {
  readonly opening: Opening;
  readonly camera: Camera;
  readonly clip: ClipSegmenting;
  readonly objects: Objects;
  readonly shown: Shown;
  readonly projects: Projects;
}

export class Frames {
  readonly #store: Store;
  readonly #parts: Parts;

  constructor(store: Store, parts: Parts) {
    this.#store = store;
    this.#parts = parts;
  }

  /** Steps by as many frames. */
  step(by: number): Promise<void> {
    return this.goTo((this.#store.get().timeline?.first ?? 0) + by);
  }

  /** Goes to a frame of the open clip; the index is clamped. The timeline moves at once; the frames change when they are loaded. */
  goTo(index: number): Promise<void> {
    const { timeline, pair } = this.#store.get();
    if (timeline === null) return Promise.resolve();
    const { clip } = timeline;
    const first = Math.min(Math.max(Math.round(index), 0), clip.count - 1);
    const wanted: Timeline = { clip, first, second: besideOf(clip, first) };
    const shown = timelineOf(pair);
    if (wanted.first === shown?.first && wanted.second === shown.second) {
      this.#parts.opening.stay();
      return Promise.resolve();
    }
    this.#parts.objects.finishStroke();
    this.#store.set({ timeline: wanted });
    return this.open(() => this.readPair(clip, first), ([first = null, second = null]) => ({ first, second }), undefined, 'step');
  }

  /** Goes to the frame where an object is least certain, by default the selected one; then, or if none is selected, to that of the next or previous. */
  goToDoubtful(id: number | null = null, by: 1 | -1 = 1): void {
    const { tracked, look, timeline } = this.#store.get();
    if (tracked === null) return;
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
    const { tracked, timeline } = this.#store.get();
    if (tracked === null) return;
    const changed = largestChanges(tracked);
    const next = changed[(changed.indexOf(timeline?.first ?? -1) + 1) % changed.length];
    if (next !== undefined) void this.goTo(next);
  }

  /** Loads frames and puts them into the pair, with the work on them that is kept. `then`: after that. `as`: as `Opening.open` takes it. */
  open(
    load: (signal: AbortSignal) => Promise<readonly LoadedFrame[]>,
    place: (frames: readonly LoadedFrame[], pair: FramePair) => FramePair,
    then: (found: Header | null) => void = () => undefined,
    as?: number | 'step',
  ): Promise<void> {
    const { opening, camera, clip, objects, projects } = this.#parts;
    clip.warmUp();
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
  async #read(clip: Clip, index: number): Promise<LoadedFrame> {
    return { ...(await clip.frame(index, this.#store.get().settings.longestSide)), origin: { clip, index } };
  }

  /** A frame of a clip and the one beside it. Those on screen are not read again. */
  async readPair(clip: Clip, index: number): Promise<LoadedFrame[]> {
    const { pair, settings } = this.#store.get();
    const frames: LoadedFrame[] = [];
    for (const at of [index, besideOf(clip, index)]) {
      const known = [pair.first, pair.second, ...frames].find((frame) => frame !== null && isFrameOf(frame, clip, at, settings.longestSide));
      frames.push(known ?? (await this.#read(clip, at)));
    }
    return frames;
  }

  /** Goes to where the work on a clip was left. */
  #continue({ at, hidden }: Header): void {
    this.#store.look({ hidden: new Set(hidden) });
    void this.goTo(at);
  }

  #setPair(pair: FramePair): void {
    const { clip, objects, shown } = this.#parts;
    objects.finishStroke();
    const { look, pair: before, viewport, timeline: left } = this.#store.get();
    const view = pair.second !== null && look.view === 'split' ? 'split' : 'first';
    const sameSize = before.first !== null && pair.first !== null && before.first.width === pair.first.width && before.first.height === pair.first.height;
    const timeline = timelineOf(pair);
    const tracked = clip.of(timeline?.clip ?? null);
    const sameClip = left?.clip === timeline?.clip;
    // The objects of a clip are the same in all its frames.
    const carried = sameClip ? { ...look, blinking: false } : { ...look, ...FRESH };
    shown.pair(pair, { ...carried, view }, { timeline, tracked, viewport: sameSize ? viewport : WHOLE });
    // The old frames are no longer drawn: free their memory now, not at the next garbage collection.
    for (const frame of [before.first, before.second]) if (frame !== pair.first && frame !== pair.second) frame?.bitmap.close();
    if (left !== null && !sameClip) left.clip.close();
  }
}

/** The index of the next frame, or at the end of the clip of the one before. */
function besideOf({ count }: Clip, index: number): number {
  return index + 1 < count ? index + 1 : Math.max(index - 1, 0);
}
