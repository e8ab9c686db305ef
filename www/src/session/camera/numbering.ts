//! The numbers of the objects before a camera. A stream counts its objects from 1 and has 254 numbers, so that after many objects another
//! one takes over. What it shows first keeps the number, and so the colour, of what was there before.

import type { ClipFrame } from 'veronese';
import { UNLABELLED } from '../../result/masks.js';

/** The largest number of an object. */
const MOST_OBJECTS = 254;

type Numbered = Pick<ClipFrame, 'labels' | 'objects' | 'background'>;

/** Objects of two frames are the same if what both cover is at least this share of what either covers. */
const LEAST_OVERLAP = 0.25;

export class Numbering {
  /** By the numbers of the stream. */
  #numbers = new Map<number, number>();
  #last = 0;
  /** The last frame that showed objects. */
  #shown: Numbered | null = null;
  /** Whether the stream has shown no objects yet. */
  #renewed = false;

  /** The frames that follow are of another stream. */
  renew(): void {
    this.#renewed = true;
    this.#numbers = new Map();
  }

  /** The frame with lasting numbers. */
  numbered({ labels, objects, background }: Numbered): Numbered {
    if (this.#renewed && objects.length > 0) {
      if (this.#shown !== null) this.#numbers = matches(labels, this.#shown);
      this.#renewed = false;
    }
    const table = Uint8Array.from({ length: 256 }, (_, label) => label);
    const renumbered = objects.map((object) => {
      const number = this.#numbers.get(object.id) ?? this.#free();
      this.#numbers.set(object.id, number);
      table[object.id] = number;
      return { ...object, id: number };
    });
    const frame = { labels: labels.map((label) => table[label]!), objects: renumbered, background };
    if (objects.length > 0) this.#shown = frame;
    return frame;
  }

  /** A number that no object of this stream has; each is used again as late as possible. */
  #free(): number {
    const taken = new Set(this.#numbers.values());
    do this.#last = (this.#last % MOST_OBJECTS) + 1;
    while (taken.has(this.#last));
    return this.#last;
  }
}

/** Which label is which number of the frame before, by the pixels that both cover: the best match first, and each only once. */
function matches(labels: Uint8Array, before: Numbered): Map<number, number> {
  const found = new Map<number, number>();
  if (labels.length !== before.labels.length) return found;
  const [own, other] = [new Uint32Array(256), new Uint32Array(256)];
  const both = new Map<number, number>();
  for (const [p, label] of labels.entries()) {
    const number = before.labels[p]!;
    own[label]! += 1;
    other[number]! += 1;
    if (isObject(label) && isObject(number)) both.set(256 * label + number, (both.get(256 * label + number) ?? 0) + 1);
  }
  const pairs = [...both].map(([key, pixels]) => {
    const [label, number] = [key >> 8, key & 255];
    return { label, number, overlap: pixels / (own[label]! + other[number]! - pixels) };
  });
  const used = new Set<number>();
  for (const { label, number, overlap } of pairs.sort((one, two) => two.overlap - one.overlap)) {
    if (overlap < LEAST_OVERLAP || found.has(label) || used.has(number)) continue;
    found.set(label, number);
    used.add(number);
  }
  return found;
}

function isObject(label: number): boolean {
  return label > 0 && label !== UNLABELLED;
}
