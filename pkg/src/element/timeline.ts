// The slider of a clip's frames, a button that plays them, and the number of the one that is shown.

import type { VeroneseSegmenterMessages } from '../../types/element-class.js';
import { part } from './view.js';

/** Of a clip that plays, milliseconds. */
const FRAME_TIME = 40;

/** The frames that can be shown. */
interface Frames {
  readonly length: number;
  readonly current: number;
  show(index: number): void;
  /** Waits for the frame that is wanted. */
  shown(): Promise<void>;
}

export class Timeline {
  readonly #slider = part('input', 'timeline');
  readonly #controls = part('div', 'controls');
  readonly #play = part('button', 'play');
  readonly #number = part('span', 'number');
  readonly #frames: Frames;
  readonly #texts: () => VeroneseSegmenterMessages;
  #plays = false;

  constructor(frames: Frames, texts: () => VeroneseSegmenterMessages) {
    this.#frames = frames;
    this.#texts = texts;
    this.#slider.type = 'range';
    this.#slider.min = this.#slider.max = this.#slider.value = '0';
    this.#slider.addEventListener('input', (event) => {
      // Seen from outside it would be an input of the element, whose value it does not change.
      event.stopPropagation();
      frames.show(this.#slider.valueAsNumber);
    });
    this.#play.type = 'button';
    this.#play.addEventListener('click', () => (this.#plays ? this.#pause() : void this.#run()));
    // The slider says the same.
    this.#number.ariaHidden = 'true';
    this.#controls.append(this.#play, this.#number);
    this.mark();
  }

  get parts(): HTMLElement[] {
    return [this.#slider, this.#controls];
  }

  set disabled(disabled: boolean) {
    this.#slider.disabled = this.#play.disabled = disabled;
  }

  /** Shows which frame is shown, and in which words. */
  mark(): void {
    const { length, current } = this.#frames;
    const texts = this.#texts();
    this.#slider.setAttribute('aria-label', texts.timeline);
    this.#slider.max = String(Math.max(0, length - 1));
    this.#slider.value = String(current);
    this.#number.textContent = texts.time(current + 1, length);
    this.#slider.setAttribute('aria-valuetext', this.#number.textContent);
    this.#play.textContent = this.#plays ? texts.pause : texts.play;
  }

  close(): void {
    this.#plays = false;
    for (const part of this.parts) part.remove();
  }

  /** Shows frame after frame, from the first one where the last one is shown, until a person stops it or there are no more. */
  async #run(): Promise<void> {
    const frames = this.#frames;
    this.#plays = true;
    this.mark();
    if (frames.current === frames.length - 1) frames.show(0);
    while (this.#plays) {
      await Promise.all([frames.shown(), new Promise((resolve) => setTimeout(resolve, FRAME_TIME))]);
      if (frames.current >= frames.length - 1) this.#pause();
      else if (this.#plays) frames.show(frames.current + 1);
    }
  }

  #pause(): void {
    this.#plays = false;
    this.mark();
  }
}
