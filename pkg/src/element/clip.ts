// A clip in the element: frames of any kind for `segmentClip`, the pictures and masks of those that are done, a timeline. Loaded
// when there is a clip.

import type { ClipFrames, FrameSource, VeroneseSegmenterMessages } from '../../types/element-class.js';
import type { Clip, ClipFrame, ClipProgress, ClipSource, ClipTracks, Pixels } from '../../types/index.js';
import { Tracks } from '../calls/clip/tracks.js';
import { fileOf, type Packed, packed, unpacked } from './masks.js';
import { type Place, pixelsOf } from './sources.js';
import { Video } from './video.js';
import { part } from './view.js';

/** Of a clip that plays, milliseconds. */
const FRAME_TIME = 40;

/** The source of a clip's frames. */
interface Source {
  /** For `segmentClip`. */
  frames: ClipSource;
  /** Number of frames, if it is known. */
  length?: number;
  /** Reads a frame that was given to `segmentClip` already, or any frame of those that can be read again. */
  picture: (index: number) => Promise<Pixels>;
  /** Of the frames, once one has been read. */
  size: { width: number; height: number };
  close?: () => void;
}

/** A frame without its labels, which are kept packed. */
type FoundFrame = Omit<ClipFrame, 'labels'>;

export interface ShownFrame {
  index: number;
  /** Number of frames, as far as it is known. */
  of: number;
  picture: Pixels;
  labels: Uint8Array;
}

/** Called when a clip can show a frame, or cannot. */
interface Listeners {
  show: (frame: ShownFrame) => void;
  fail: (thrown: unknown) => void;
}

export class ElementClip {
  readonly timeline = part('input', 'timeline');
  readonly progress = part('progress', 'progress');
  /** A button that plays the frames, and the number of the one that is shown. */
  readonly controls = part('div', 'controls');
  readonly #play = part('button', 'play');
  readonly #number = part('span', 'number');
  #plays = false;
  readonly #done: Packed[] = [];
  readonly #found: FoundFrame[] = [];
  readonly #texts: () => VeroneseSegmenterMessages;
  readonly #listeners: Listeners;
  #source: Source | undefined;
  #clip: Clip | undefined;
  /** The state of a clip whose frames are all done and can be read again. */
  #state: Uint8Array | undefined;
  #isCorrected = false;
  #current = 0;
  /** Until the frame that is wanted is shown. */
  #showing: Promise<void> | undefined;
  #closed = false;

  constructor(texts: () => VeroneseSegmenterMessages, listeners: Listeners) {
    this.#texts = texts;
    this.#listeners = listeners;
    this.timeline.type = 'range';
    this.timeline.min = this.timeline.max = this.timeline.value = '0';
    this.timeline.addEventListener('input', (event) => {
      // Seen from outside it would be an input of the element, whose value it does not change.
      event.stopPropagation();
      this.show(this.timeline.valueAsNumber);
    });
    this.#play.type = 'button';
    this.#play.addEventListener('click', () => (this.#plays ? this.#pause() : void this.#run()));
    // The slider says the same.
    this.#number.ariaHidden = 'true';
    this.controls.append(this.#play, this.#number);
    this.name();
  }

  /** Shows frame after frame, from the first one where the last one is shown, until a person stops it or there are no more. */
  async #run(): Promise<void> {
    this.#plays = true;
    this.#mark();
    if (this.#current === this.length - 1) this.show(0);
    while (this.#plays && !this.#closed) {
      await Promise.all([this.shown(), new Promise((resolve) => setTimeout(resolve, FRAME_TIME))]);
      if (this.#current >= this.length - 1) this.#pause();
      else if (this.#plays) this.show(this.#current + 1);
    }
  }

  #pause(): void {
    this.#plays = false;
    this.#mark();
  }

  set disabled(disabled: boolean) {
    this.timeline.disabled = this.#play.disabled = disabled;
  }

  /** Names the slider and the progress. */
  name(): void {
    this.timeline.setAttribute('aria-label', this.#texts().timeline);
    this.progress.setAttribute('aria-label', this.#texts().progress);
    this.#mark();
  }

  /** Number of frames that are done. */
  get length(): number {
    return this.#done.length;
  }

  /** Whether frames come once, as those of a camera. */
  get streams(): boolean {
    return this.#source?.length === undefined;
  }

  async open(given: ClipFrames | string, place: Place): Promise<void> {
    this.#source = await sourceOf(given, place);
  }

  /** The first frame, before it has masks. Frames that come once are not taken for it. */
  async poster(): Promise<Pixels | undefined> {
    const { length, picture } = this.#source as Source;
    if (length === undefined) return undefined;
    return length > 0 ? picture(0) : undefined;
  }

  /** Yields each frame when it can be shown. `begin` begins to segment frames. */
  async *segment(begin: (frames: ClipSource) => Clip): AsyncGenerator<ClipFrame, void, undefined> {
    const { frames, size } = this.#source as Source;
    const clip = begin(frames);
    this.#clip = clip;
    for await (const frame of clip) {
      const { labels, ...found } = frame;
      this.#done.push(await packed(labels, size.width, size.height));
      this.#found.push(found);
      this.#mark();
      yield frame;
    }
    this.#state = await clip.state();
  }

  /** Whether all frames are done and can be read again. */
  get takesCorrections(): boolean {
    return this.#state !== undefined;
  }

  /** Yields the frames that change, when all of them have: before, the clip stays as it was. `begin` begins to correct frames. */
  async *correct(begin: (frames: ClipSource, state: Uint8Array) => Clip): AsyncGenerator<ClipFrame, void, undefined> {
    const { frames, size } = this.#source as Source;
    const clip = begin(frames, this.#state as Uint8Array);
    const changed: [FoundFrame, Packed][] = [];
    for await (const { labels, ...found } of clip) changed.push([found, await packed(labels, size.width, size.height)]);
    this.#state = (await clip.state()) as Uint8Array;
    this.#isCorrected = true;
    for (const [found, done] of changed) [this.#found[found.index], this.#done[found.index]] = [found, done];
    for (const [found, done] of changed) yield { ...found, labels: await unpacked(done) };
  }

  /** Shows the labels that a frame has while a correction spreads, if it is the frame that is wanted. */
  async preview({ index, labels }: ClipFrame): Promise<void> {
    const { length = this.length, picture } = this.#source as Source;
    const shown = await picture(index);
    if (index === this.#current && !this.#closed) this.#listeners.show({ index, of: length, picture: shown, labels });
  }

  report({ frame, of, stage }: ClipProgress): void {
    // The pairs are nearly all the work.
    if (of !== undefined) this.progress.value = stage === 'pairs' ? frame / of : 1;
  }

  /** The objects of the frames that are done. */
  tracks(): ClipTracks {
    const found = this.#clip?.tracks() ?? { objects: [], background: [], dropped: 0 };
    if (!this.#isCorrected) return found;
    const tracks = new Tracks();
    tracks.dropped = found.dropped;
    for (const found of this.#found) tracks.add(found);
    return tracks.value();
  }

  /** Index of the frame that is shown, or will be once it is read. */
  get current(): number {
    return this.#current;
  }

  /** Shows a frame, or the one that is done and nearest to it. Of those that are asked for while one is read, the latest is shown. */
  show(index: number): void {
    this.#current = Math.max(0, Math.min(this.length - 1, Math.trunc(index) || 0));
    this.#mark();
    this.#showing ??= this.#showLatest();
  }

  /** Waits for the frame that is wanted. */
  async shown(): Promise<void> {
    await this.#showing;
  }

  async #showLatest(): Promise<void> {
    for (let index = -1; index !== this.#current && !this.#closed; ) {
      index = this.#current;
      try {
        const [picture, labels] = await Promise.all([(this.#source as Source).picture(index), unpacked(this.#done[index] as Packed)]);
        if (!this.#closed) this.#listeners.show({ index, of: this.#source?.length ?? this.length, picture, labels });
      } catch (thrown) {
        if (!this.#closed) this.#listeners.fail(thrown);
      }
    }
    this.#showing = undefined;
  }

  #mark(): void {
    this.timeline.max = String(Math.max(0, this.length - 1));
    this.timeline.value = String(this.#current);
    this.#number.textContent = this.#texts().time(this.#current + 1, this.length);
    this.timeline.setAttribute('aria-valuetext', this.#number.textContent);
    this.#play.textContent = this.#plays ? this.#texts().pause : this.#texts().play;
  }

  /** The masks that are done, as `veronese clip` names those of a video. */
  files(): File[] {
    return this.#done.map((done, index) => fileOf(done, `${String(index).padStart(5, '0')}.png`));
  }

  close(): void {
    this.#closed = true;
    this.timeline.remove();
    this.controls.remove();
    this.progress.remove();
    this.#source?.close?.();
  }
}

async function sourceOf(given: ClipFrames | string, place: Place): Promise<Source> {
  const size = { width: 0, height: 0 };
  const measured = async (frame: Promise<Pixels>) => {
    const pixels = await frame;
    [size.width, size.height] = [pixels.width, pixels.height];
    return pixels;
  };
  const decoded = (index: number, source: FrameSource) => measured(pixelsOf(`frame ${index}`, source, place));
  if (typeof given === 'string') {
    const video = new Video(new URL(given, place.base).href);
    await video.open();
    return { ...again(video.length, (index) => measured(video.read(index))), size, close: () => video.close() };
  }
  if (Array.isArray(given) || 'read' in Object(given)) {
    const frames = Array.isArray(given) ? listed(given.slice()) : (given as Readable);
    return { ...again(frames.length, async (index) => decoded(index, await frames.read(index))), size };
  }
  const each = given as AsyncIterable<FrameSource>;
  const isIterable = Symbol.asyncIterator in Object(each) || Symbol.iterator in Object(each);
  const pictures: Promise<Blob>[] = [];
  async function* once() {
    for await (const frame of each) {
      const pixels = await decoded(pictures.length, frame);
      pictures.push(pictureOf(pixels));
      yield pixels;
    }
  }
  // `segmentClip` refuses frames that are no source.
  return { frames: isIterable ? once() : (given as never), picture: async (index) => decoded(index, await (pictures[index] as Promise<Blob>)), size };
}

function again(length: number, read: (index: number) => Promise<Pixels>): Pick<Source, 'frames' | 'length' | 'picture'> {
  return { frames: { length, read }, length, picture: read };
}

type Readable = Extract<ClipFrames, { read: unknown }>;

function listed(frames: FrameSource[]): Readable {
  return { length: frames.length, read: (index) => frames[index] as FrameSource };
}

/** A frame that comes once, kept to be shown again: lossy, since nothing is computed from it. */
function pictureOf({ data, width, height }: Pixels): Promise<Blob> {
  const canvas = new OffscreenCanvas(width, height);
  canvas.getContext('2d')?.putImageData(new ImageData(new Uint8ClampedArray(data), width, height), 0, 0);
  return canvas.convertToBlob({ type: 'image/webp', quality: 0.9 });
}
