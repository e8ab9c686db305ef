// A clip in the element: the open clip or the stream, the frame that is shown, what is told of its changes. Loaded when there is a clip.

import type { ClipFrames, ElementClipProgress, VeroneseSegmenterMessages } from '../../types/element-class.js';
import type {
  Clip,
  ClipEvent,
  ClipFrame,
  ClipStream,
  ClipTracks,
  Pixels,
  SegmenterPool,
  SegmentOptions,
  StreamSource,
} from '../../types/index.js';
import { type ClipSource, sourceOf } from './clip-source.js';
import { fileOf, type Packed, packed, unpacked } from './masks.js';
import type { Place } from './sources.js';
import { Timeline } from './timeline.js';
import { part } from './view.js';

type Pool = Pick<SegmenterPool, 'openClip' | 'segmentStream'>;

export interface ShownFrame {
  index: number;
  /** Number of frames, as far as it is known. */
  of: number;
  picture: Pixels;
  /** Undefined while the frame has no masks. */
  labels: Uint8Array | undefined;
}

interface Listeners {
  /** A frame is to be drawn, or drawn again. */
  show: (frame: ShownFrame) => void;
  /** A frame has other labels than before. */
  frame: (frame: ClipFrame) => void;
  /** All frames with other labels have been told. */
  masks: () => Promise<void>;
  /** A step has taken effect. */
  tracks: (tracks: ClipTracks) => void;
  progress: (progress: ElementClipProgress) => void;
  /** {@link ElementClip.isBusy} may have changed. */
  change: () => void;
  fail: (thrown: unknown) => void;
}

export class ElementClip {
  readonly timeline: Timeline;
  readonly progress = part('progress', 'progress');
  /** What it was opened with. */
  readonly given: ClipFrames | string;
  readonly #place: Place;
  readonly #texts: () => VeroneseSegmenterMessages;
  readonly #listeners: Listeners;
  readonly #ending = new AbortController();
  #source: ClipSource | undefined;
  /** Undefined for a stream, and until it is open. */
  clip: Clip | undefined;
  #stream: ClipStream | undefined;
  /** The frames of a stream that are done. */
  readonly #done: Packed[] = [];
  /** Revisions of the frames as listeners know them. */
  readonly #told: number[] = [];
  /** Masks as files, until they change. */
  readonly #files = new Map<number, Promise<File>>();
  #tracks: ClipTracks = { objects: [], background: [], dropped: 0 };
  /** Until the listeners know of all that has changed. */
  #telling: Promise<void> | undefined;
  /** Whether something has changed since they began to be told. */
  #isBehind = false;
  /** What there is to tell besides frames: a step that has taken effect, or steps that were undone or done again. */
  #news: 'settled' | 'moved' | undefined;
  /** Calls of {@link segment} that have not ended. */
  #segmenting = 0;
  #current = 0;
  /** Whether the frame that is shown has other labels since. */
  #isStale = false;
  #picture: { index: number; pixels: Promise<Pixels> } | undefined;
  /** Until the frame that is wanted is shown. */
  #showing: Promise<void> | undefined;

  constructor(given: ClipFrames | string, base: string, texts: () => VeroneseSegmenterMessages, listeners: Listeners) {
    this.given = given;
    this.#place = { base, signal: this.#ending.signal };
    this.#texts = texts;
    this.#listeners = listeners;
    this.timeline = new Timeline(this, texts);
    this.name();
  }

  get #isClosed(): boolean {
    return this.#ending.signal.aborted;
  }

  /** Names the slider and the progress. */
  name(): void {
    this.progress.setAttribute('aria-label', this.#texts().progress);
    this.timeline.mark();
  }

  /** Number of frames up to the last one with masks. */
  get length(): number {
    return this.clip ? this.clip.frames.reduce((length, { hasMasks }, index) => (hasMasks ? index + 1 : length), 0) : this.#done.length;
  }

  /** Whether steps have not taken effect, or listeners do not know all that has. */
  get isBusy(): boolean {
    return this.#telling !== undefined || (this.clip?.steps.waiting ?? 0) > 0;
  }

  /** Those that listeners know; of a stream those of the frames that are done. */
  get tracks(): ClipTracks {
    return this.#stream?.tracks() ?? this.#tracks;
  }

  /** Opens the source, and the clip unless the frames are a stream. The first frame is shown meanwhile. */
  async open(pool: Pool): Promise<void> {
    const source = await sourceOf(this.given, this.#place);
    if (this.#isClosed) return source.close?.();
    this.#source = source;
    const { frames } = source;
    if (!frames) return;
    const opening = pool.openClip(frames).then((clip) => {
      if (this.#isClosed) return clip.close();
      this.clip = clip;
      clip.subscribe((event) => this.#hear(event));
    });
    // A frame that cannot be read is the error before it.
    opening.catch(() => undefined);
    if (frames.length > 0) {
      const first = await this.#pixels(0);
      if (!this.#isClosed) this.#draw(0, first, undefined);
    }
    await opening;
  }

  /** Segments all frames. When it ends, listeners know of all frames with masks, also if it fails. */
  async segment(pool: Pool, options: SegmentOptions & { signal: AbortSignal }): Promise<ClipTracks> {
    const { clip } = this;
    if (!clip)
      return this.#follow(pool.segmentStream(this.#source?.stream as StreamSource, { ...options, onProgress: this.#listeners.progress }));
    this.progress.removeAttribute('value');
    this.#segmenting += 1;
    try {
      await clip.segment(options);
      this.#news = undefined;
    } finally {
      this.#segmenting -= 1;
      await this.#tell();
    }
    return (this.#tracks = await clip.tracks());
  }

  async #follow(stream: ClipStream): Promise<ClipTracks> {
    this.#stream = stream;
    for await (const frame of stream) {
      this.#done.push(await packed(frame.labels, frame.width, frame.height));
      this.timeline.mark();
      this.#listeners.frame(frame);
      // The latest frame is shown, unless a person looks at an earlier one.
      if (frame.index === 0 || this.#current === frame.index - 1) this.show(frame.index);
    }
    await this.shown();
    await this.#listeners.masks();
    return stream.tracks();
  }

  #hear(event: ClipEvent): void {
    if (this.#isClosed) return;
    if (event.type === 'progress') this.#report(event);
    if (event.type === 'frames') {
      for (const index of event.frames) this.#files.delete(index);
      this.#isStale ||= event.frames.includes(this.#current);
      if (this.#isStale) this.show(this.#current);
      this.timeline.mark();
    }
    const isSettled = event.type === 'settled';
    // What is undone or done again is no step of its own.
    const isMoved = event.type === 'frames' && this.clip?.steps.waiting === 0 && this.#segmenting === 0;
    if (isSettled && !event.error) this.#news = 'settled';
    else if (isMoved) this.#news ??= 'moved';
    if (isSettled || isMoved) void this.#tell();
    this.#listeners.change();
  }

  #report({ stage, frame, done, of }: Extract<ClipEvent, { type: 'progress' }>): void {
    if (of !== undefined) this.progress.value = done / of;
    this.#listeners.progress({ stage, frame, done, of });
  }

  /** Tells listeners what has changed; resolves when they know. */
  #tell(): Promise<void> {
    this.#isBehind = true;
    return (this.#telling ??= this.#tellAll(this.clip as Clip));
  }

  async #tellAll(clip: Clip): Promise<void> {
    let tracks: ClipTracks | undefined;
    try {
      for (let isChanged = false; this.#isBehind && !this.#isClosed;) {
        this.#isBehind = false;
        isChanged = (await this.#tellFrames(clip)) || isChanged;
        await this.shown();
        await this.#listeners.masks();
        const isNew = this.#news === 'settled' || (this.#news === 'moved' && isChanged);
        if (isNew && this.#segmenting === 0) tracks = await clip.tracks();
      }
    } catch (thrown) {
      if (!this.#isClosed) this.#listeners.fail(thrown);
    }
    this.#telling = undefined;
    if (this.#isClosed) return;
    if (this.#segmenting === 0) this.#news = undefined;
    if (tracks) this.#listeners.tracks((this.#tracks = tracks));
    this.#listeners.change();
  }

  /** Returns whether there were some. */
  async #tellFrames(clip: Clip): Promise<boolean> {
    let isChanged = false;
    for (const [index, { hasMasks, revision }] of clip.frames.entries()) {
      if ((this.#told[index] ?? 0) === revision) continue;
      isChanged = true;
      const frame = hasMasks ? await clip.labels(index) : undefined;
      // Another step may be spreading to it, and may be cancelled.
      this.#told[index] = clip.steps.waiting > 0 ? -1 : revision;
      if (frame) this.#listeners.frame(frame);
    }
    return isChanged;
  }

  /** Index of the frame that is shown, or will be once it is read. */
  get current(): number {
    return this.#current;
  }

  /** Shows a frame, or the one that is done and nearest to it. Of those that are asked for while one is read, the latest is shown. */
  show(index: number): void {
    this.#current = Math.max(0, Math.min(this.length - 1, Math.trunc(index) || 0));
    this.timeline.mark();
    this.#showing ??= this.#showLatest();
  }

  /** Waits for the frame that is wanted. */
  async shown(): Promise<void> {
    await this.#showing;
  }

  async #showLatest(): Promise<void> {
    for (let index = -1; (index !== this.#current || this.#isStale) && !this.#isClosed;) {
      index = this.#current;
      this.#isStale = false;
      try {
        const [picture, labels] = await Promise.all([this.#pixels(index), this.#labels(index)]);
        if (!this.#isClosed) this.#draw(index, picture, labels);
      } catch (thrown) {
        if (!this.#isClosed) this.#listeners.fail(thrown);
      }
    }
    this.#showing = undefined;
  }

  #draw(index: number, picture: Pixels, labels: Uint8Array | undefined): void {
    this.#listeners.show({ index, of: this.#source?.frames?.length ?? this.length, picture, labels });
  }

  async #labels(index: number): Promise<Uint8Array | undefined> {
    if (this.clip?.frames[index]?.hasMasks) return (await this.clip.labels(index)).labels;
    const done = this.#done[index];
    return done && unpacked(done);
  }

  /** The pixels of a frame. The last ones are kept: its labels change while an annotation spreads. */
  #pixels(index: number): Promise<Pixels> {
    if (this.#picture?.index === index) return this.#picture.pixels;
    // A copy: whoever reads the frames may have one buffer for all.
    const pixels = (this.#source as ClipSource).picture(index).then(({ data, width, height }) => ({ data: data.slice(), width, height }));
    const picture = { index, pixels };
    this.#picture = picture;
    pixels.catch(() => {
      if (this.#picture === picture) this.#picture = undefined;
    });
    return pixels;
  }

  /** The masks, as `veronese clip` names those of a video. */
  files(): Promise<File[]> {
    const named = (index: number, masks: Packed) => fileOf(masks, `${String(index).padStart(5, '0')}.png`);
    const { clip } = this;
    if (!clip) return Promise.resolve(this.#done.map((done, index) => named(index, done)));
    const file = (index: number) => {
      const made =
        this.#files.get(index) ??
        clip.labels(index).then(async ({ labels, width, height }) => named(index, await packed(labels, width, height)));
      this.#files.set(index, made);
      // It is tried again.
      made.catch(() => this.#files.delete(index));
      return made;
    };
    return Promise.all(clip.frames.flatMap(({ hasMasks }, index) => (hasMasks ? file(index) : [])));
  }

  close(): void {
    this.#ending.abort();
    void this.clip?.close();
    this.timeline.close();
    this.progress.remove();
    this.#source?.close?.();
  }
}
