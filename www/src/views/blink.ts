//! Alternating between the frames: by itself, or while the F key is held.

import type { Store } from '../state/state.js';
import { prefersStillness } from './markup.js';

/** How long each frame is shown, milliseconds. */
const PERIOD = 450;

export function mountBlink(store: Store): void {
  let timer = 0;
  store.subscribe(({ look }, before) => {
    if (look.blinking === before.look.blinking) return;
    clearInterval(timer);
    if (look.blinking) timer = window.setInterval(() => flip(store), PERIOD);
    else if (before.look.view !== 'split') store.look({ view: 'first' });
  });
}

/** Starts or stops blinking. With reduced motion, each call shows the other frame instead. */
export function toggleBlinking(store: Store): void {
  const { look, pair } = store.get();
  if (pair.second === null) return;
  if (prefersStillness()) flip(store);
  else store.look({ blinking: !look.blinking, view: look.view === 'split' ? 'first' : look.view });
}

export function flip(store: Store): void {
  const { look, pair } = store.get();
  if (pair.second === null) return;
  store.look({ view: look.view === 'second' ? 'first' : 'second' });
}

/** Shows the other frame from `press` to `release`. */
export class Peek {
  readonly #store: Store;
  #held = false;

  constructor(store: Store) {
    this.#store = store;
  }

  get held(): boolean {
    return this.#held;
  }

  press(): void {
    const { first, second } = this.#store.get().pair;
    if (this.#held || first === null || second === null) return;
    this.#held = true;
    flip(this.#store);
  }

  release(): void {
    if (this.#held) flip(this.#store);
    this.#held = false;
  }
}
