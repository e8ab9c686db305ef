//! Frames of a video by seeking a `<video>` element, for browsers without WebCodecs. Browsers may show a neighbour of the requested
//! frame, so the clip is not exact.

import { PageError } from '../common/errors.js';
import { strings } from '../common/strings.js';
import { type DecodedFrame, frameFromBitmap } from '../frames/frame.js';
import { type Clip, type Picture, fileNameOf, identityOf } from './clip.js';

/** A `<video>` element does not tell its frame rate: this one is assumed. */
const STEPS_PER_SECOND = 30;
/** Timeout of opening and of a seek, milliseconds. */
const PATIENCE = 60_000;

/** `null` if the browser cannot play the file. */
export async function openApproximate(file: File, fingerprint: string): Promise<Clip | null> {
  const video = document.createElement('video');
  video.muted = true;
  video.playsInline = true;
  video.preload = 'auto';
  video.src = URL.createObjectURL(file);
  const playable = await first(video, 'loadeddata', 'error').catch(() => 'error');
  if (playable === 'error' || !(video.videoWidth > 0) || !Number.isFinite(video.duration)) {
    release(video);
    return null;
  }
  return new ApproximateClip(file.name, fingerprint, video);
}

class ApproximateClip implements Clip {
  readonly exact = false;
  readonly count: number;
  readonly times: Float64Array;
  readonly width: number;
  readonly height: number;
  /** Seeks run one at a time. */
  #queue: Promise<unknown> = Promise.resolve();

  constructor(
    readonly name: string,
    readonly fingerprint: string,
    readonly video: HTMLVideoElement,
  ) {
    this.count = Math.max(1, Math.floor(video.duration * STEPS_PER_SECOND));
    this.times = Float64Array.from({ length: this.count }, (_, i) => i / STEPS_PER_SECOND);
    this.width = video.videoWidth;
    this.height = video.videoHeight;
  }

  async frame(index: number, longestSide: number): Promise<DecodedFrame> {
    const began = performance.now();
    const bitmap = await this.#at(index, () => createImageBitmap(this.video));
    return frameFromBitmap(bitmap, identityOf(this.name, this.fingerprint, index), longestSide, began);
  }

  async thumbnails(indices: readonly number[], draw: (index: number, picture: Picture) => void): Promise<void> {
    for (const index of indices) {
      await this.#at(index, async () => {
        draw(index, (context, x, y, width, height) => context.drawImage(this.video, x, y, width, height));
      });
    }
  }

  nameOf(index: number): string {
    return fileNameOf(index);
  }

  close(): void {
    release(this.video);
  }

  #at<T>(index: number, use: () => Promise<T>): Promise<T> {
    const turn = this.#queue.then(async () => {
      const time = (index + 0.5) / STEPS_PER_SECOND;
      if (this.video.currentTime !== time) {
        this.video.currentTime = time;
        if ((await first(this.video, 'seeked', 'error')) === 'error') {
          throw new PageError('unreadable-video', strings.errors.unreadableVideo(this.name));
        }
      }
      return use();
    });
    this.#queue = turn.catch(() => undefined);
    return turn;
  }
}

/** Waits for the first of these events and returns its type. */
function first(video: HTMLVideoElement, ...events: string[]): Promise<string> {
  return new Promise((resolve, reject) => {
    const settle = (event: Event): void => {
      clearTimeout(late);
      for (const name of events) video.removeEventListener(name, settle);
      resolve(event.type);
    };
    const late = setTimeout(() => reject(new PageError('unreadable-video', strings.errors.slowVideo)), PATIENCE);
    for (const name of events) video.addEventListener(name, settle);
  });
}

function release(video: HTMLVideoElement): void {
  URL.revokeObjectURL(video.src);
  video.removeAttribute('src');
  video.load();
}
