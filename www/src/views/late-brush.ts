//! The brush is loaded when a tool that draws is first chosen. What pointers and keys do until then waits for it, unless other frames come
//! first.

import { imported } from '../common/loaded.js';
import { strings } from '../common/strings.js';
import type { Session } from '../session/session.js';
import type { FramePair } from '../state/pair.js';
import type { Store } from '../state/state.js';
import type { Brush } from './brush.js';
import { find } from './markup.js';

export class LateBrush {
  /** `null` until it is loaded. */
  now: Brush | null = null;
  readonly #store: Store;
  readonly #session: Session;
  readonly #load: () => Promise<Brush>;
  #loading: Promise<Brush> | null = null;
  /** The pair on which a key that waits has begun to draw. */
  #begun: FramePair | null = null;

  constructor(stage: HTMLElement, store: Store, session: Session) {
    this.#store = store;
    this.#session = session;
    const layers = find(stage, '.layers', HTMLElement);
    let over: PointerEvent | null = null;
    layers.addEventListener('pointermove', (event) => (over = event));
    layers.addEventListener('pointerleave', () => (over = null));
    this.#load = async () => {
      const { Brush } = await imported(() => import('./brush.js'));
      this.now = new Brush(stage, store, session);
      // A pointer that rests does not say again where it is.
      if (over !== null) layers.dispatchEvent(new PointerEvent('pointermove', over));
      return this.now;
    };
    const loading = (): Promise<Brush> => {
      if (this.#loading !== null) return this.#loading;
      this.#loading = this.#load();
      this.#loading.catch(() => {
        this.#loading = this.#begun = null;
        store.set({ tool: { ...store.get().tool, name: 'look' } });
        session.say(strings.errors.notLoaded, 'not-loaded');
      });
      return this.#loading;
    };
    session.objects.drawing = () => loading().then(({ drawing }) => drawing, () => null);
    // Whoever comes to the tools is likely to choose one.
    const tools = find(document, '#tools', HTMLElement);
    for (const coming of ['pointerenter', 'focusin']) tools.addEventListener(coming, () => void imported(() => import('./brush.js')).catch(() => undefined), { once: true });
    const picture = find(stage, '#strokes', SVGSVGElement);
    store.subscribe(({ tool }) => {
      // Styles go by it: from now on a finger draws, and scrolls nothing.
      picture.dataset.tool = tool.name;
      if (tool.name !== 'look') void loading();
    });
  }

  get painting(): boolean {
    return this.now?.painting ?? this.#begun === this.#store.get().pair;
  }

  do(what: (brush: Brush) => void): void {
    if (this.now !== null) return what(this.now);
    const { pair } = this.#store.get();
    const later = (brush: Brush): void => (this.#store.get().pair === pair ? what(brush) : undefined);
    const done = this.#loading?.then(later, () => undefined);
    // Other frames wait for it as for what is being drawn.
    if (done !== undefined) this.#session.objects.drawn = () => done.then(() => this.now?.drawn());
  }

  /** A key while the picture has the focus, or while something is being drawn. Returns whether it is the brush's. */
  key(event: KeyboardEvent): boolean {
    if (this.now !== null) return this.now.key(event);
    const { tool, result, pair } = this.#store.get();
    const draws = event.key === ' ' || event.key.startsWith('Arrow');
    if (tool.name === 'look' || result === null || !(draws || (this.painting && ['Enter', 'Backspace', 'Escape'].includes(event.key)))) return false;
    if (event.key === ' ') this.#begun = pair;
    this.do((brush) => brush.key(event));
    return true;
  }
}
