// The view of the element: a frame, its masks, and the objects as a list box that lies over them.

import type { VeroneseSegmenterMessages } from '../../types/element-class.js';
import type { Pixels } from '../../types/index.js';
import { UNLABELLED } from '../common/checks.js';
import { coloursOf } from './colours.js';
import type { Zoom } from './zoom.js';

const STYLE = `
  :host { display: inline-block; position: relative; overflow: hidden; background: var(--veronese-background, #0d0e10); }
  :host([hidden]) { display: none; }
  .stage, .picture { position: relative; }
  .stage { overflow: hidden; }
  .view { position: relative; transform-origin: 0 0; }
  canvas { display: block; width: 100%; height: auto; }
  .masks { position: absolute; inset: 0; height: 100%; opacity: var(--veronese-opacity, 0.55); }
  .objects { position: absolute; inset: 0; --focus: var(--veronese-focus-colour, #fff); }
  .objects:focus-visible { outline: 3px solid var(--focus); outline-offset: -3px; box-shadow: inset 0 0 0 5px #000; }
  .object { position: absolute; pointer-events: none; }
  .object[aria-selected=true] { outline: 2px solid var(--focus); outline-offset: -2px; box-shadow: 0 0 0 1px #000, inset 0 0 0 3px #000; }
  .status, .controls, .legend { font: var(--veronese-font, 0.8125rem/1.5 system-ui, sans-serif); color: var(--veronese-status-colour, #fff); margin: 0; padding: 0.3em 0.8em; }
  .status { position: absolute; inset: auto 0 0; background: var(--veronese-status-background, rgb(0 0 0 / 65%)); }
  .status:empty { display: none; }
  .timeline { display: block; box-sizing: border-box; inline-size: 100%; block-size: 2.75rem; margin: 0; padding-inline: 0.5rem; }
  .controls, .legend { display: flex; flex-wrap: wrap; gap: 0.3em 1em; }
  :host(:not([controls~=play])) .controls, :host(:not([controls~=legend])) .legend { display: none; }
  .entry[data-selected] { text-decoration: underline; }
  .swatch { display: inline-block; inline-size: 0.8em; block-size: 0.8em; margin-inline-end: 0.3em; }
  .progress { position: absolute; inset: auto 0 0; inline-size: 100%; block-size: 0.375rem; }
`;

/** Actions of a person. */
interface Listeners {
  select: (object: number | null) => void;
  /** Frames forward, negative for back. */
  step: (frames: number) => void;
  /** The first time that the picture is magnified. */
  zoom: (stage: HTMLElement, view: HTMLElement) => Promise<Zoom>;
}

/** By keys, factors of the picture's size; 0 shows all of it. */
const zooming = (by: (factor: number) => void) => ({ '+': () => by(2), '-': () => by(0.5), 0: () => by(0) });

export class View {
  readonly stage = part('div', 'stage');
  readonly objects = part('div', 'objects');
  readonly status = part('p', 'status');
  readonly #legend = part('div', 'legend');
  readonly #view = part('div', 'view');
  readonly #picture = part('div', 'picture');
  readonly #frame = part('canvas', 'frame');
  readonly #masks = part('canvas', 'masks');
  readonly #texts: () => VeroneseSegmenterMessages;
  readonly #listeners: Listeners;
  #zooming: Promise<Zoom> | undefined;
  #colours: Uint32Array | undefined;
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
    this.stage.addEventListener('wheel', (event) => {
      if (!this.#zooms()) return;
      event.preventDefault();
      this.#zoom((zoom) => zoom.wheel(event));
    });
    this.stage.addEventListener('dblclick', () => this.#zooming && this.#zoom((zoom) => zoom.by(0)));
    // The list box has the same for those who do not see it.
    this.#legend.ariaHidden = 'true';
    this.#view.append(this.#picture, this.objects);
    this.stage.append(this.#view, this.status);
    root.append(this.stage, this.#legend);
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
    for (const entry of this.#legend.children as Iterable<HTMLElement> & HTMLCollection)
      entry.toggleAttribute('data-selected', entry.dataset.object === String(object));
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
    this.#colours = colours;
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
    this.#legend.replaceChildren(...options.map(({ dataset }) => this.#entry(Number(dataset.object))));
    this.selected = this.#selected;
  }

  #entry(object: number): HTMLElement {
    const [entry, swatch] = [part('div', 'entry'), part('span', 'swatch')];
    const [red, green, blue] = [0, 8, 16].map((bits) => ((this.#colours?.[object] ?? 0) >>> bits) & 255);
    swatch.style.background = `rgb(${red} ${green} ${blue})`;
    entry.dataset.object = String(object);
    entry.append(swatch, this.#texts().object(object));
    entry.addEventListener('click', () => this.#disabled || this.#choose(object));
    return entry;
  }

  #zooms(): boolean {
    return (this.stage.getRootNode() as ShadowRoot).host.matches('[controls~=zoom]');
  }

  /** Loads what zooms. */
  #zoom(work: (zoom: Zoom) => void): void {
    this.#zooming ??= this.#listeners.zoom(this.stage, this.#view);
    void this.#zooming.then(work);
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
      ...(this.#zooms() && zooming((factor) => this.#zoom((zoom) => zoom.by(factor)))),
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
