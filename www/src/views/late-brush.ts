//! The brush is loaded when a tool that draws is first chosen. What a pointer does until then waits for it, unless other frames come first.

import { strings } from '../common/strings.js';
import type { Session } from '../session/session.js';
import type { Store } from '../state/state.js';
import type { Brush } from './brush.js';
import { find } from './markup.js';

export class LateBrush {
  /** `null` until it is loaded. */
  now: Brush | null = null;
  readonly #store: Store;
  readonly #load: () => Promise<Brush>;
  #loading: Promise<Brush> | null = null;

  constructor(stage: HTMLElement, store: Store, session: Session) {
    this.#store = store;
    const layers = find(stage, '.layers', HTMLElement);
    let over: PointerEvent | null = null;
    layers.addEventListener('pointermove', (event) => (over = event));
    layers.addEventListener('pointerleave', () => (over = null));
    this.#load = async () => {
      const { Brush } = await import('./brush.js');
      this.now = new Brush(stage, store, session);
      // A pointer that rests does not say again where it is.
      if (over !== null) layers.dispatchEvent(new PointerEvent('pointermove', over));
      return this.now;
    };
    const loading = (): Promise<Brush> => {
      if (this.#loading !== null) return this.#loading;
      this.#loading = this.#load();
      this.#loading.catch(() => {
        this.#loading = null;
        session.say(strings.errors.notLoaded, 'not-loaded');
      });
      return this.#loading;
    };
    session.objects.drawing = () => loading().then(({ drawing }) => drawing, () => null);
    const picture = find(stage, '#strokes', SVGSVGElement);
    store.subscribe(({ tool }) => {
      // Styles go by it: from now on a finger draws, and scrolls nothing.
      picture.dataset.tool = tool.name;
      if (tool.name !== 'look') void loading();
    });
  }

  do(what: (brush: Brush) => void): void {
    if (this.now !== null) return what(this.now);
    const { pair } = this.#store.get();
    const later = (brush: Brush): void => (this.#store.get().pair === pair ? what(brush) : undefined);
    this.#loading?.then(later, () => undefined);
  }
}
