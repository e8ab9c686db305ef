//! The camera, switched on and off. It owns the live view.

import type { Store } from '../../state/state.js';
import type { ClipSegmenting } from '../clip/segmenting.js';
import type { Opening } from '../opening.js';
import type { Masks } from '../pair/masks.js';
import type { PairSegmenting } from '../pair/segmenting.js';
import { LiveView } from './live.js';

export class Camera {
  readonly #store: Store;
  readonly #opening: Opening;
  readonly #segmenting: PairSegmenting;
  readonly #masks: Masks;
  readonly #clip: ClipSegmenting;
  readonly #live: LiveView;

  constructor(store: Store, opening: Opening, segmenting: PairSegmenting, masks: Masks, clip: ClipSegmenting) {
    this.#store = store;
    this.#opening = opening;
    this.#segmenting = segmenting;
    this.#masks = masks;
    this.#clip = clip;
    this.#live = new LiveView(store);
  }

  /** Switches the camera on, or off: its last two frames become a pair. */
  toggle(): Promise<void> {
    if (this.#store.get().live !== null) {
      this.stop();
      return this.#segmenting.segment();
    }
    return this.#opening.open(
      (signal) => {
        signal.addEventListener('abort', () => this.stop());
        return this.#live.start();
      },
      (show) => {
        this.#masks.leave();
        const { timeline } = this.#store.get();
        this.#clip.of(null);
        show();
        timeline?.clip.close();
      },
    );
  }

  /** Switches the camera off; its last frames stay. */
  stop(): void {
    this.#live.stop();
  }
}
