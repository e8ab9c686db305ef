// The frames of a video, by seeking in a `<video>` that is on no page. A browser does not say how many frames a video has or how
// long each lasts, so that is measured by the times of the frames that it shows.

import type { Pixels } from '../../types/index.js';
import { pixelsOfBitmap } from '../calls/pictures.js';
import { VeroneseError } from '../common/errors.js';
import { answered } from './sources.js';

/** Seconds between the positions at which the second frame is looked for: a frame of a video with 240 a second. */
const STEP = 1 / 240;
/** Steps until the second frame is given up: such a video has fewer than 4 frames a second. */
const STEPS = 60;
/** Milliseconds to wait for the time of a frame that was sought, before the position is taken for it. */
const PATIENCE = 250;
/** Each measurement of a frame's duration spans so many times more frames. The times of frames may be whole milliseconds. */
const GROWTH = 4;

export class Video {
  readonly #video = document.createElement('video');
  readonly #address: string;
  /** Seeks run one at a time. */
  #queue: Promise<unknown> = Promise.resolve();
  /** Seconds: when the first frame is shown, and for how long. */
  #start = 0;
  #duration = 0;
  length = 0;

  constructor(address: string) {
    this.#address = address;
  }

  /** Loads the video and counts its frames. */
  async open(): Promise<void> {
    const video = this.#video;
    video.muted = true;
    video.playsInline = true;
    video.preload = 'auto';
    video.crossOrigin = 'anonymous';
    const loaded = this.#event('loadeddata');
    video.src = this.#address;
    await loaded.catch(async (thrown) => {
      // The browser does not say whether there was a file at all.
      if (!this.#address.startsWith('http')) throw thrown;
      const answer = await answered(this.#address, { method: 'HEAD' });
      throw typeof answer === 'string' ? new VeroneseError('unreadable-video', `the clip cannot be loaded: ${answer}`) : thrown;
    });
    if (!(video.videoWidth > 0) || !Number.isFinite(video.duration)) throw this.#unreadable();
    this.#start = await this.#seek(0);
    this.#duration = await this.#measured(video.duration - this.#start);
    this.length = Math.max(1, Math.round((video.duration - this.#start) / this.#duration));
  }

  read(index: number): Promise<Pixels> {
    const turn = this.#queue.then(async () => {
      await this.#seek(this.#start + (index + 0.5) * this.#duration);
      const bitmap = await createImageBitmap(this.#video);
      try {
        return pixelsOfBitmap(bitmap);
      } finally {
        bitmap.close();
      }
    });
    this.#queue = turn.catch(() => undefined);
    return turn;
  }

  close(): void {
    this.#video.removeAttribute('src');
    this.#video.load();
  }

  /** The duration of a frame: the time between two frames over ever more of them. */
  async #measured(total: number): Promise<number> {
    let duration = 0;
    for (let step = 1; duration <= 0 && step <= STEPS; step++) duration = (await this.#seek(this.#start + step * STEP)) - this.#start;
    if (duration <= 0) return STEPS * STEP;
    for (let frames = GROWTH; (frames + 1) * duration < total; frames *= GROWTH) {
      const time = (await this.#seek(this.#start + (frames + 0.5) * duration)) - this.#start;
      const passed = Math.round(time / duration);
      if (passed > 0) duration = time / passed;
    }
    return duration;
  }

  /** Returns the time of the frame that is shown then. */
  async #seek(position: number): Promise<number> {
    const video = this.#video;
    const time = new Promise<number>((resolve) => {
      if (!('requestVideoFrameCallback' in video)) return resolve(position);
      const late = setTimeout(() => resolve(position), PATIENCE);
      video.requestVideoFrameCallback((_, { mediaTime }) => {
        clearTimeout(late);
        resolve(mediaTime);
      });
    });
    const sought = this.#event('seeked');
    video.currentTime = position;
    await sought;
    return time;
  }

  #event(name: 'loadeddata' | 'seeked'): Promise<void> {
    const video = this.#video;
    return new Promise((resolve, reject) => {
      const settle = ({ type }: Event) => {
        for (const each of [name, 'error', 'emptied']) video.removeEventListener(each, settle);
        if (type === name) resolve();
        else reject(this.#unreadable());
      };
      for (const each of [name, 'error', 'emptied']) video.addEventListener(each, settle);
    });
  }

  #unreadable(): VeroneseError {
    return new VeroneseError('unreadable-video', 'the clip is not a video that this browser can read', { cause: this.#video.error });
  }
}
