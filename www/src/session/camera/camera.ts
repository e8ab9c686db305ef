//! The camera, switched on and off. It owns the live view.

import type { Store } from '../../state/state.js';
import type { Objects } from '../clip/objects.js';
import type { ClipSegmenting } from '../clip/segmenting.js';
import type { Opening } from '../opening.js';
import { LiveView } from './live.js';

/** The parts that make way for it. */
interface Parts {
  readonly opening: Opening;
  readonly clip: ClipSegmenting;
  readonly objects: Objects;
  /** Opens its last two frames, which are on screen. */
  readonly openLast: () => Promise<void>;
}

export class Camera {
  readonly #store: Store;
  readonly #parts: Parts;
  readonly #live: LiveView;

  constructor(store: Store, parts: Parts) {
    this.#store = store;
    this.#parts = parts;
    this.#live = new LiveView(store);
  }

  /** Switches the camera on, or off: its last two frames become a clip. */
  toggle(): Promise<void> {
    if (this.#store.get().live !== null) {
      this.stop();
      return this.#parts.openLast();
    }
    return this.#parts.opening.open(
      (signal) => {
        signal.addEventListener('abort', () => this.stop());
        return this.#live.start();
      },
      (show) => {
        this.#parts.objects.finishStroke();
        const { timeline } = this.#store.get();
        this.#parts.clip.of(null);
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
