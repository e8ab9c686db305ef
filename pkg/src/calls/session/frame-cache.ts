// Pixels of frames that clips have taken: a correction takes a frame several times, and each is read and handed over only once.

import type { Pixels } from '../../../types/index.js';

/** Bytes of all clips together. The frames that were used longest ago make room. */
const MOST = 64 << 20;

export class FrameCache {
  /** In the order of their last use. */
  readonly #frames = new Map<string, Pixels>();
  #bytes = 0;

  has(clip: number, index: number): boolean {
    return this.#frames.has(keyOf(clip, index));
  }

  get(clip: number, index: number): Pixels | undefined {
    const key = keyOf(clip, index);
    const frame = this.#frames.get(key);
    if (frame) this.#frames.delete(key);
    if (frame) this.#frames.set(key, frame);
    return frame;
  }

  add(clip: number, index: number, frame: Pixels): void {
    this.#remove(keyOf(clip, index));
    this.#frames.set(keyOf(clip, index), frame);
    this.#bytes += frame.data.length;
    for (const key of this.#frames.keys()) {
      if (this.#bytes <= MOST) return;
      this.#remove(key);
    }
  }

  forget(clip: number): void {
    for (const key of this.#frames.keys()) if (key.startsWith(`${clip} `)) this.#remove(key);
  }

  #remove(key: string): void {
    this.#bytes -= this.#frames.get(key)?.data.length ?? 0;
    this.#frames.delete(key);
  }
}

function keyOf(clip: number, index: number): string {
  return `${clip} ${index}`;
}
