//! Passing through the frames of a clip, as it is played or as a pointer is dragged over the timeline. Where that ends, the pair is
//! segmented. It owns the frame to which the pointer was dragged last.

import type { Clip } from '../clips/clip.js';
import type { Store } from '../state/state.js';
import type { Frames } from './frames.js';
import type { PairSegmenting } from './pair/segmenting.js';

/** Frame rate at which folders are played, as their frames have no times. */
const FRAMES_PER_SECOND = 25;

export class Playing {
  readonly #store: Store;
  readonly #frames: Frames;
  readonly #segmenting: PairSegmenting;
  /** `null` once it is read. */
  #wanted: number | null = null;

  constructor(store: Store, frames: Frames, segmenting: PairSegmenting) {
    this.#store = store;
    this.#frames = frames;
    this.#segmenting = segmenting;
  }

  /** Plays the clip from the current frame, or stops. */
  async toggle(): Promise<void> {
    const { playing, timeline } = this.#store.get();
    this.#store.set({ playing: !playing });
    if (playing || timeline === null) return;
    const { clip, first } = timeline;
    let at = first === null || first >= clip.count - 1 ? -1 : first;
    while (this.#store.get().playing && at < clip.count - 1) {
      const began = performance.now();
      const next = at + 1;
      await this.#frames.goTo(next);
      const now = this.#store.get().timeline;
      if (now?.clip !== clip || now.first !== next) break; // the end of the pair, or gone elsewhere
      await new Promise((resolve) => setTimeout(resolve, durationOf(clip, next) - (performance.now() - began)));
      at = next;
    }
    this.#store.set({ playing: false });
    this.#segmenting.rest();
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
    this.#segmenting.rest();
  }
}

/** How long a frame is shown when the clip is played, milliseconds. */
function durationOf({ times }: Clip, index: number): number {
  if (times === null) return 1000 / FRAMES_PER_SECOND;
  const [now, next] = [times[index]!, times[index + 1]];
  return next === undefined ? 0 : 1000 * (next - now);
}
