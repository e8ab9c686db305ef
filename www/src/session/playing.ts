//! Passing through the frames of a clip, as it is played or as a pointer is dragged over the timeline. It owns the frame to which the pointer
//! was dragged last.

import { type Clip, FRAMES_PER_SECOND } from '../clips/clip.js';
import type { Store } from '../state/state.js';
import type { Frames } from './frames.js';

/** How fast a clip can be played, as a multiple of how fast it was taken. */
const SPEEDS = [0.25, 0.5, 1, 2];

export class Playing {
  readonly #store: Store;
  readonly #frames: Frames;
  /** `null` once it is read. */
  #wanted: number | null = null;

  constructor(store: Store, frames: Frames) {
    this.#store = store;
    this.#frames = frames;
  }

  /** Plays the clip from the current frame, or stops. */
  async toggle(): Promise<void> {
    const { playing, timeline } = this.#store.get();
    this.#store.set({ playing: !playing });
    if (playing || timeline === null) return;
    const { clip, first } = timeline;
    const pace = new Pace(clip, performance.now());
    let index = first >= clip.count - 1 ? 0 : first + 1;
    while (this.#store.get().playing && index < clip.count) {
      await this.#frames.goTo(index);
      const { timeline: now, speed } = this.#store.get();
      if (now?.clip !== clip || now.first !== index) break; // gone elsewhere
      const { next, wait } = pace.after(index, speed, performance.now());
      await new Promise((resolve) => setTimeout(resolve, wait));
      index = next;
      // What was opened meanwhile stays where it is.
      if (this.#store.get().timeline?.clip !== clip) break;
    }
    this.#store.set({ playing: false });
  }

  /** Plays faster by as many steps, or more slowly. */
  change(by: number): void {
    const { speed } = this.#store.get();
    this.#store.set({ speed: SPEEDS[SPEEDS.indexOf(speed) + by] ?? speed });
  }

  /** Plays faster by a step, and after the fastest at the slowest. */
  cycle(): void {
    const { speed } = this.#store.get();
    this.#store.set({ speed: SPEEDS[(SPEEDS.indexOf(speed) + 1) % SPEEDS.length]! });
  }

  /** Goes to the frames that a pointer is dragged over, but reads none that it has left meanwhile. */
  async scrub(index: number): Promise<void> {
    const waits = this.#wanted !== null;
    this.#wanted = index;
    if (waits) return;
    this.#store.set({ scrubbing: true });
    while (this.#wanted !== null) {
      const wanted: number = this.#wanted;
      await this.#frames.goTo(wanted);
      if (this.#wanted === wanted) this.#wanted = null;
    }
    this.#store.set({ scrubbing: false });
  }
}

/** Which frames of a clip are shown when it is played, and when. */
export class Pace {
  /** Of the time of the frame before, milliseconds. */
  #end: number;

  constructor(
    readonly clip: Pick<Clip, 'times' | 'count'>,
    begin: number,
  ) {
    this.#end = begin;
  }

  /** What comes after a frame that is shown from now on, and in how many milliseconds. */
  after(index: number, speed: number, now: number): { readonly next: number; readonly wait: number } {
    const duration = (of: number): number => this.#duration(of) / speed;
    this.#end += duration(index);
    let next = index + 1;
    // Above the speed at which it was taken, frames whose time is over are left out. Else all are shown, if need be more slowly.
    if (speed > 1) for (; next < this.clip.count - 1 && this.#end + duration(next) < now; next++) this.#end += duration(next);
    else this.#end = Math.max(this.#end, now);
    return { next, wait: this.#end - now };
  }

  #duration(index: number): number {
    const { times } = this.clip;
    if (times === null) return 1000 / FRAMES_PER_SECOND;
    const [now, next] = [times[index]!, times[index + 1]];
    return next === undefined ? 0 : 1000 * (next - now);
  }
}
