//! A press on something that was not found offers a new object there. Further presses refine it. Loaded
//! with the first such press.

import type { Session } from '../session/session.js';
import type { State, Store } from '../state/state.js';
import { isReady } from '../state/tracked.js';
import { find } from './markup.js';
import { chooseTool } from './tools.js';

/** Nearer to the lower edge of the view, the offer is above the press, share of the view. */
const LOW = 0.8;

type Point = readonly [number, number];

export class Offer {
  readonly #store: Store;
  readonly #button: HTMLButtonElement;
  #pixel: Point = [0, 0];

  constructor(layers: HTMLElement, store: Store, session: Session) {
    this.#store = store;
    this.#button = find(layers, '#offer', HTMLButtonElement);
    this.#button.addEventListener('click', () => void this.#take(session));
    store.subscribe((now, before) => {
      if (now.pair !== before.pair || now.tool !== before.tool || now.viewport !== before.viewport || !isNotFound(now)) this.#button.hidden = true;
    });
  }

  /** The pixel of the frame that was pressed, and its place in the view, 0 to 1. What was pressed is selected. */
  at(pixel: Point, [x, y]: Point): void {
    this.#pixel = pixel;
    this.#button.hidden = !isNotFound(this.#store.get());
    this.#button.style.left = `${100 * x}%`;
    this.#button.style.top = `${100 * y}%`;
    this.#button.classList.toggle('above', y > LOW);
  }

  async #take(session: Session): Promise<void> {
    await session.objects.point(this.#pixel);
    chooseTool(this.#store, 'box');
    this.#store.set({ tool: { ...this.#store.get().tool, pointing: 'add' } });
  }
}

/** Whether the background of a clip is selected, which takes corrections. */
function isNotFound({ look, tracked }: State): boolean {
  return look.selected === 0 && isReady(tracked) && tracked.run.phase !== 'working';
}
