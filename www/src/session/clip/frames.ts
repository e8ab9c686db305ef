//! The frames of a clip as the package reads them: whenever it needs one, so that few stay in memory, or none.

import type { ClipFrame } from 'veronese';
import type { Clip } from '../../clips/clip.js';
import { packed } from '../../correction/runs.js';
import { smaller } from '../../frames/frame.js';
import type { LoadedFrame } from '../../state/pair.js';
import type { Range, TrackedFrame } from '../../state/tracked.js';

type Picture = Pick<LoadedFrame, 'data' | 'width' | 'height'>;

/** Thrown instead of reading a frame after `stop`. */
export const STOPPED = new Error('stopped');

export class ClipFrames {
  /** Of all frames, once one has been read. */
  readonly size = { width: 0, height: 0 };
  /** Number of frames that have been read, from the first of the range on. */
  #read = 0;
  #stopped = false;
  /** The pixels of the first frame that was read, while all others are the same. */
  #first: Uint8ClampedArray | null = null;
  #differ = false;
  /** Frames that were read lately, the latest last. */
  readonly #kept = new Map<number, Picture>();

  constructor(
    readonly clip: Clip,
    readonly longestSide: number,
    readonly range: Range,
    /** A correction reads frames several times, and finds these without decoding: frames on screen, and so many bytes of others. */
    readonly at: { readonly hand: readonly LoadedFrame[]; readonly room: number } = { hand: [], room: 0 },
  ) {}

  get length(): number {
    return this.range.last - this.range.first + 1;
  }

  get stopped(): boolean {
    return this.#stopped;
  }

  /** Whether all frames that have been read have the same pixels. */
  get same(): boolean {
    return this.#first !== null;
  }

  /** Ends the clip after the frames that have been read: the package labels those. */
  stop(): void {
    this.#stopped = true;
  }

  /** `index` counts from the first frame of the range. */
  async read(index: number): Promise<Picture> {
    if (this.#stopped && index >= this.#read) throw STOPPED;
    this.#read = Math.max(this.#read, index + 1);
    const kept = this.#kept.get(index);
    const { data, width, height } = kept === undefined ? await this.#frame(this.range.first + index) : copyOf(kept);
    this.size.width = width;
    this.size.height = height;
    if (kept === undefined) this.#compare(data);
    if (kept === undefined && data.length <= this.at.room) this.#keep(index, copyOf({ data, width, height }));
    return { data, width, height };
  }

  async #frame(index: number): Promise<Picture> {
    const shown = this.at.hand.find((frame) => isFrameOf(frame, this.clip, index, this.longestSide));
    if (shown !== undefined) return copyOf(shown);
    const { data, width, height, bitmap } = await this.clip.frame(index, this.longestSide);
    bitmap.close();
    return { data, width, height };
  }

  #keep(index: number, pixels: Picture): void {
    this.#kept.set(index, pixels);
    while (this.#kept.size * pixels.data.length > this.at.room) this.#kept.delete(this.#kept.keys().next().value!);
  }

  #compare(data: Uint8ClampedArray): void {
    if (this.#differ) return;
    const first = this.#first;
    this.#differ = first !== null && !data.every((value, k) => value === first[k]);
    this.#first = this.#differ ? null : (first ?? data.slice());
  }
}

/** Whether a frame is that of the clip with this index, at the size for this longest side. */
export function isFrameOf({ origin, full, width }: LoadedFrame, clip: Clip, index: number, longestSide: number): boolean {
  return origin?.clip === clip && origin.index === index && smaller(full, longestSide).width === width;
}

/** The package may take the buffer. */
function copyOf({ data, width, height }: Picture): Picture {
  return { data: data.slice(), width, height };
}

export async function bytesOf(blob: Blob): Promise<Uint8Array> {
  return new Uint8Array(await blob.arrayBuffer());
}

export function blobOf(bytes: Uint8Array): Blob {
  return new Blob([new Uint8Array(bytes)]);
}

export function masksOf({ labels, objects, background }: ClipFrame, { width, height }: ClipFrames['size']): TrackedFrame {
  return { runs: packed(labels, width, height), objects, background };
}
