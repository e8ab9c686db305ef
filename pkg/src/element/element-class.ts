// <veronese-segmenter>: two frames in, their masks over the first one, as a custom element. Importing this file registers nothing.

import type { Pixels, Progress, Segmentation } from '../../types/index.js';
import { groupLabels } from '../calls/labels.js';
import { taken } from '../calls/taking.js';
import { checkedPixels } from '../calls/tasks.js';
import { reading } from '../common/checks.js';
import { VeroneseError, veroneseError } from '../common/errors.js';
import { Segmenter } from '../entries/web.js';
import { optionsOf } from './options.js';

/** What a frame can be given as. */
type Source = string | URL | Blob | ImageBitmap | Pixels;

/** What is kept of it, which nobody else can change; or why it cannot be used. */
type Kept = string | Blob | Pixels | VeroneseError;

/** Where there are no elements (Node, a worker), the class can still be imported. */
const Base = globalThis.HTMLElement ?? class {};

/** After Okabe and Ito, told apart by people with any common kind of colour blindness; each can be replaced in CSS. */
const COLOURS = ['transparent', '#f0a000', '#56b4e9', '#d66eaf', '#00a878', '#f0e442', '#d55400', '#0068be', '#ececec', '#805228'];

const STYLE = `
  :host { display: inline-block; position: relative; overflow: hidden; background: var(--veronese-background, #0d0e10); }
  :host([hidden]) { display: none; }
  .picture { position: relative; }
  canvas { display: block; width: 100%; height: auto; }
  .masks { position: absolute; inset: 0; height: 100%; opacity: var(--veronese-opacity, 0.55); }
  .status { position: absolute; inset: auto 0 0; margin: 0; padding: 0.3em 0.8em; font: var(--veronese-font, 0.8125rem/1.5 system-ui, sans-serif);
    color: var(--veronese-status-colour, #fff); background: var(--veronese-status-background, rgb(0 0 0 / 65%)); }
  .status:empty { display: none; }
`;

export class VeroneseSegmenterElement extends Base {
  static readonly observedAttributes = ['first', 'second', 'motions', 'quality', 'seed', 'grouped'];

  readonly #frame: HTMLCanvasElement;
  readonly #masks: HTMLCanvasElement;
  readonly #picture: HTMLElement;
  readonly #status: HTMLElement;
  readonly #given: { first?: Kept; second?: Kept } = {};
  #segmenter: InstanceType<typeof Segmenter> | undefined;
  #request: AbortController | undefined;
  #result: Segmentation | undefined;
  #planned = false;

  constructor() {
    super();
    const root = this.attachShadow({ mode: 'open' });
    const sheet = new CSSStyleSheet();
    sheet.replaceSync(STYLE);
    root.adoptedStyleSheets = [sheet];
    this.#picture = part('div', 'picture');
    this.#frame = part('canvas', 'frame');
    this.#masks = part('canvas', 'masks');
    this.#status = part('p', 'status');
    this.#picture.setAttribute('role', 'img');
    this.#status.setAttribute('role', 'status');
    this.#frame.width = this.#masks.width = 16;
    this.#frame.height = this.#masks.height = 9;
    this.#picture.append(this.#frame, this.#masks);
    root.append(this.#picture, this.#status);
  }

  /** The last result, as {@link Segmenter.segmentPair} gave it. */
  get result(): Segmentation | undefined {
    return this.#result;
  }

  /** Sets both frames at once, also from pixels, which attributes cannot name: these and bitmaps are copied at once. */
  setFrames(first: Source, second: Source): Promise<Segmentation> {
    this.#given.first = kept('first', first);
    this.#given.second = kept('second', second);
    return this.segment();
  }

  /**
   * Segments the frames with the attributes as they are. Made by itself when the element is connected and when an attribute
   * changes; a new call ends the one before, which rejects with code `cancelled`.
   */
  async segment(): Promise<Segmentation> {
    this.#planned = false;
    this.abort();
    const request = new AbortController();
    this.#request = request;
    const { signal } = request;
    try {
      const [first, second] = await Promise.all([this.#pixels('first', signal), this.#pixels('second', signal)]);
      signal.throwIfAborted();
      this.#draw(first);
      this.#segmenter ??= new Segmenter();
      const result = await this.#segmenter.segmentPair(first, second, {
        ...optionsOf((name) => this.getAttribute(name)),
        signal,
        onProgress: (progress: Progress) => this.#tell('progress', progress),
      });
      signal.throwIfAborted();
      this.#result = result;
      this.#paint(result);
      this.#status.textContent = '';
      this.#tell('result', result);
      return result;
    } catch (thrown) {
      const error = signal.aborted ? new VeroneseError('cancelled', 'the call was cancelled') : veroneseError(thrown);
      if (this.#request === request) {
        this.#status.textContent = error.message;
        this.#tell('error', error);
      }
      throw error;
    } finally {
      if (this.#request === request) this.#request = undefined;
    }
  }

  /** Stops at once; the last result stays. */
  abort(): void {
    const request = this.#request;
    this.#request = undefined;
    request?.abort();
  }

  /** One number per pixel: labels, or groups where the element is `grouped`; 255 is unlabelled. */
  labels(): Uint8Array | undefined {
    if (this.#result === undefined) return undefined;
    return this.hasAttribute('grouped') ? groupLabels(this.#result) : this.#result.labels;
  }

  /** 255 where the label (or group) is, 0 elsewhere. */
  mask(wanted: number): Uint8Array | undefined {
    return this.labels()?.map((label) => (label === wanted ? 255 : 0));
  }

  connectedCallback(): void {
    this.#plan();
  }

  disconnectedCallback(): void {
    this.abort();
    this.#segmenter?.close();
    this.#segmenter = undefined;
  }

  attributeChangedCallback(name: string, before: string | null, now: string | null): void {
    if (before === now) return;
    if (name === 'first' || name === 'second') delete this.#given[name];
    if (name === 'grouped') {
      if (this.#result) this.#paint(this.#result);
    } else this.#plan();
  }

  /** Several attributes that change together are one request. */
  #plan(): void {
    if (this.#planned || !this.isConnected || !this.#has('first') || !this.#has('second')) return;
    this.#planned = true;
    queueMicrotask(() => {
      if (!this.#planned) return;
      this.#planned = false;
      if (this.isConnected) this.segment().catch(() => undefined); // said by the event
    });
  }

  #has(slot: 'first' | 'second'): boolean {
    return this.#given[slot] !== undefined || (this.getAttribute(slot) ?? '') !== '';
  }

  async #pixels(slot: 'first' | 'second', signal: AbortSignal): Promise<Pixels> {
    const source = this.#given[slot] ?? this.getAttribute(slot) ?? '';
    if (source instanceof VeroneseError) throw source;
    if (typeof source === 'object' && 'data' in source) return source;
    const bitmap = await bitmapOf(source, slot, this.ownerDocument.baseURI, signal);
    try {
      return pixelsOf(bitmap);
    } finally {
      bitmap.close();
    }
  }

  #draw({ data, width, height }: Pixels): void {
    this.#frame.width = this.#masks.width = width;
    this.#frame.height = this.#masks.height = height;
    const image = new ImageData(new Uint8ClampedArray(data), width, height);
    this.#frame.getContext('2d')?.putImageData(image, 0, 0);
  }

  #paint({ width, height, count }: Segmentation): void {
    const labels = this.labels();
    const context = this.#masks.getContext('2d');
    if (labels === undefined || context === null) return;
    this.#masks.width = width;
    this.#masks.height = height;
    const words = this.#words();
    const pixels = new Uint32Array(labels.length);
    labels.forEach((label, p) => (pixels[p] = words[label] ?? 0));
    context.putImageData(new ImageData(new Uint8ClampedArray(pixels.buffer), width), 0, 0);
    this.#picture.setAttribute('aria-label', `the first frame with the masks of ${count} ${count === 1 ? 'motion' : 'motions'}`);
  }

  /** The colour of each label as one RGBA word: `--veronese-colour-K`, else that of the palette. A canvas knows every CSS colour. */
  #words(): Uint32Array {
    const style = getComputedStyle(this);
    const context = new OffscreenCanvas(1, 1).getContext('2d', { willReadFrequently: true });
    return Uint32Array.from({ length: 255 }, (_, label) => {
      const own = COLOURS[label < COLOURS.length ? label : 1 + ((label - 1) % (COLOURS.length - 1))] ?? '';
      const given = style.getPropertyValue(`--veronese-colour-${label}`).trim();
      return context === null ? 0 : wordOf(context, given === '' ? own : given);
    });
  }

  #tell(type: 'progress' | 'result' | 'error', detail: unknown): void {
    this.dispatchEvent(new CustomEvent(type, { detail }));
  }
}

function part<T extends 'div' | 'canvas' | 'p'>(tag: T, name: string): HTMLElementTagNameMap[T] {
  const made = document.createElement(tag);
  made.className = name;
  made.setAttribute('part', name);
  return made;
}

function kept(which: 'first' | 'second', source: Source): Kept {
  if (typeof source === 'string' || source instanceof Blob) return source;
  try {
    if (source instanceof URL) return source.href;
    if (source instanceof ImageBitmap) return pixelsOf(source);
    const { data, ...size } = reading(() => checkedPixels(`the ${which} frame`, source));
    return { ...size, data: taken([data], false)[0] as Uint8Array };
  } catch (thrown) {
    return thrown instanceof VeroneseError ? thrown : unreadable(which, thrown);
  }
}

function pixelsOf(bitmap: ImageBitmap): Pixels {
  const { width, height } = bitmap;
  const context = new OffscreenCanvas(width, height).getContext('2d', { willReadFrequently: true });
  if (context === null) throw new VeroneseError('internal', 'this browser gives no canvas to read pixels from');
  context.drawImage(bitmap, 0, 0);
  return context.getImageData(0, 0, width, height);
}

function unreadable(which: string, cause: unknown): VeroneseError {
  return new VeroneseError('unreadable-image', `the ${which} frame is not an image that this browser can read`, { cause });
}

async function bitmapOf(source: string | Blob, which: string, base: string, signal: AbortSignal): Promise<ImageBitmap> {
  try {
    const blob = source instanceof Blob ? source : await fetched(new URL(source, base), signal);
    return await createImageBitmap(blob, { imageOrientation: 'from-image', colorSpaceConversion: 'none', premultiplyAlpha: 'none' });
  } catch (cause) {
    throw unreadable(which, cause);
  }
}

async function fetched(url: URL, signal: AbortSignal): Promise<Blob> {
  const response = await fetch(url, { signal });
  if (!response.ok) throw new Error(`${url.href} answered ${response.status}`);
  return response.blob();
}

function wordOf(context: OffscreenCanvasRenderingContext2D, colour: string): number {
  context.clearRect(0, 0, 1, 1);
  context.fillStyle = 'transparent';
  context.fillStyle = colour;
  context.fillRect(0, 0, 1, 1);
  const [r = 0, g = 0, b = 0, a = 0] = context.getImageData(0, 0, 1, 1).data;
  return ((a << 24) | (b << 16) | (g << 8) | r) >>> 0;
}
