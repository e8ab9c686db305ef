// The view of the element: a frame, its masks, and the objects as a list box that lies over them.

import type { VeroneseSegmenterMessages } from '../../types/element-class.js';
import type { Pixels } from '../../types/index.js';
import { UNLABELLED } from '../common/checks.js';
import { coloursOf } from './colours.js';

const STYLE = `
  :host { display: inline-block; position: relative; overflow: hidden; background: var(--veronese-background, #0d0e10); }
  :host([hidden]) { display: none; }
  .stage, .picture { position: relative; }
  canvas { display: block; width: 100%; height: auto; }
  .masks { position: absolute; inset: 0; height: 100%; opacity: var(--veronese-opacity, 0.55); }
  .objects { position: absolute; inset: 0; --focus: var(--veronese-focus-colour, #fff); }
  .objects:focus-visible { outline: 3px solid var(--focus); outline-offset: -3px; box-shadow: inset 0 0 0 5px #000; }
  .object { position: absolute; pointer-events: none; }
  .object[aria-selected=true] { outline: 2px solid var(--focus); outline-offset: -2px; box-shadow: 0 0 0 1px #000, inset 0 0 0 3px #000; }
  .status { position: absolute; inset: auto 0 0; margin: 0; padding: 0.3em 0.8em; font: var(--veronese-font, 0.8125rem/1.5 system-ui, sans-serif);
    color: var(--veronese-status-colour, #fff); background: var(--veronese-status-background, rgb(0 0 0 / 65%)); }
  .status:empty { display: none; }
  .timeline { display: block; box-sizing: border-box; inline-size: 100%; block-size: 2.75rem; margin: 0; padding-inline: 0.5rem; }
  .progress { position: absolute; inset: auto 0 0; inline-size: 100%; block-size: 0.375rem; }
`;

/** Actions of a person. */
interface Listeners {
  select: (object: number | null) => void;
  /** Frames forward, negative for back. */
  step: (frames: number) => void;
}

export class View {
  readonly stage = part('div', 'stage');
  readonly objects = part('div', 'objects');
  readonly status = part('p', 'status');
  readonly #picture = part('div', 'picture');
  readonly #frame = part('canvas', 'frame');
  readonly #masks = part('canvas', 'masks');
  readonly #texts: () => VeroneseSegmenterMessages;
  readonly #listeners: Listeners;
  #labels: { labels: Uint8Array; width: number; height: number } | undefined;
  #selected: number | null = null;
  #disabled = false;

  constructor(root: ShadowRoot, texts: () => VeroneseSegmenterMessages, listeners: Listeners) {
    this.#texts = texts;
    this.#listeners = listeners;
    const sheet = new CSSStyleSheet();
    sheet.replaceSync(STYLE);
    root.adoptedStyleSheets = [sheet];
    this.#picture.setAttribute('role', 'img');
    this.status.setAttribute('role', 'status');
    this.objects.setAttribute('role', 'listbox');
    this.name();
    this.objects.tabIndex = 0;
    this.objects.addEventListener('keydown', (event) => this.#key(event));
    this.objects.addEventListener('click', (event) => this.#click(event));
    this.#frame.width = this.#masks.width = 16;
    this.#frame.height = this.#masks.height = 9;
    this.#picture.append(this.#frame, this.#masks);
    this.stage.append(this.#picture, this.objects, this.status);
    root.append(this.stage);
  }

  /** Names what has a name whatever is shown. */
  name(): void {
    this.objects.setAttribute('aria-label', this.#texts().objects);
    if (this.#labels === undefined) this.#picture.setAttribute('aria-label', this.#texts().noFrame);
  }

  get selected(): number | null {
    return this.#selected;
  }

  /** Marks an object, also one that this frame does not show. */
  set selected(object: number | null) {
    this.#selected = object;
    this.objects.removeAttribute('aria-activedescendant');
    for (const option of this.#options()) {
      const chosen = Number(option.dataset.object) === object;
      option.setAttribute('aria-selected', String(chosen));
      if (chosen) this.objects.setAttribute('aria-activedescendant', option.id);
    }
  }

  set disabled(disabled: boolean) {
    this.#disabled = disabled;
    this.objects.tabIndex = disabled ? -1 : 0;
    this.objects.setAttribute('aria-disabled', String(disabled));
  }

  /** Draws a frame without masks. */
  draw({ data, width, height }: Pixels): void {
    this.#frame.width = this.#masks.width = width;
    this.#frame.height = this.#masks.height = height;
    this.#frame.getContext('2d')?.putImageData(new ImageData(new Uint8ClampedArray(data), width, height), 0, 0);
    this.#labels = undefined;
    this.#list();
  }

  /** Draws masks over the frame. `description` is for those who do not see them. */
  paint(host: Element, labels: Uint8Array, width: number, height: number, description: string): void {
    const context = this.#masks.getContext('2d');
    if (context === null) return;
    this.#masks.width = width;
    this.#masks.height = height;
    const colours = coloursOf(host);
    const pixels = new Uint32Array(labels.length);
    labels.forEach((label, p) => (pixels[p] = colours[label] ?? 0));
    context.putImageData(new ImageData(new Uint8ClampedArray(pixels.buffer), width), 0, 0);
    this.#picture.setAttribute('aria-label', description);
    this.#labels = { labels, width, height };
    this.#list();
  }

  /** One option for each object, where its pixels are. */
  #list(): void {
    const { labels, width, height } = this.#labels ?? { labels: new Uint8Array(), width: 1, height: 1 };
    const options = [...boxesOf(labels, width)].map(([object, [left, top, right, bottom]]) => {
      const option = part('div', 'object');
      option.setAttribute('role', 'option');
      option.setAttribute('aria-label', this.#texts().object(object));
      option.id = `object-${object}`;
      option.dataset.object = String(object);
      const percent = (pixels: number, of: number) => `${(100 * pixels) / of}%`;
      option.style.left = percent(left, width);
      option.style.top = percent(top, height);
      option.style.width = percent(right + 1 - left, width);
      option.style.height = percent(bottom + 1 - top, height);
      return option;
    });
    this.objects.replaceChildren(...options);
    this.selected = this.#selected;
  }

  #options(): HTMLElement[] {
    return [...this.objects.children] as HTMLElement[];
  }

  #choose(object: number | null): void {
    if (object === this.#selected) return;
    this.selected = object;
    this.#listeners.select(object);
  }

  #key(event: KeyboardEvent): void {
    if (this.#disabled || event.altKey || event.ctrlKey || event.metaKey) return;
    const objects = this.#options().map(({ dataset }) => Number(dataset.object));
    const at = objects.indexOf(this.#selected ?? -1);
    const choose = (index: number) => this.#choose(objects[Math.max(0, Math.min(objects.length - 1, index))] ?? null);
    const actions: Record<string, () => void> = {
      ArrowLeft: () => this.#listeners.step(-1),
      ArrowRight: () => this.#listeners.step(1),
      ArrowUp: () => choose(at < 0 ? objects.length - 1 : at - 1),
      ArrowDown: () => choose(at + 1),
      Home: () => choose(0),
      End: () => choose(objects.length - 1),
      Escape: () => this.#choose(null),
    };
    const action = Object.hasOwn(actions, event.key) ? actions[event.key] : undefined;
    if (action === undefined) return;
    event.preventDefault();
    action();
  }

  #click(event: MouseEvent): void {
    if (this.#disabled || this.#labels === undefined) return;
    const { labels, width, height } = this.#labels;
    const box = this.objects.getBoundingClientRect();
    const x = Math.floor(((event.clientX - box.left) / box.width) * width);
    const y = Math.floor(((event.clientY - box.top) / box.height) * height);
    const label = labels[y * width + x] ?? 0;
    this.#choose(label === 0 || label === UNLABELLED ? null : label);
  }
}

/** An element of the shadow tree that a host page can style. */
export function part<T extends keyof HTMLElementTagNameMap>(tag: T, name: string): HTMLElementTagNameMap[T] {
  const made = document.createElement(tag);
  made.className = name;
  made.setAttribute('part', name);
  return made;
}

/** The first and last column and row of each object, by number. */
function boxesOf(labels: Uint8Array, width: number): Map<number, [left: number, top: number, right: number, bottom: number]> {
  const boxes = new Int32Array(4 * 256);
  for (let p = 0, x = 0, y = 0; p < labels.length; p++) {
    const at = 4 * (labels[p] as number);
    // The right edge is one more than the last column until the end, so that 0 means unseen.
    if (boxes[at + 2] === 0) boxes.set([x, y, x + 1, y], at);
    if (x < (boxes[at] as number)) boxes[at] = x;
    if (x >= (boxes[at + 2] as number)) boxes[at + 2] = x + 1;
    boxes[at + 3] = y;
    if (++x === width) [x, y] = [0, y + 1];
  }
  const found = new Map<number, [number, number, number, number]>();
  for (let object = 1; object < UNLABELLED; object++) {
    const [left = 0, top = 0, end = 0, bottom = 0] = boxes.subarray(4 * object, 4 * object + 4);
    if (end > 0) found.set(object, [left, top, end - 1, bottom]);
  }
  return found;
}
