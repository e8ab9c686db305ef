//! A cache of labels solved with strokes, so that undo, redo and stepping need not solve them again. The strokes determine the labels, so
//! entries can be dropped at any time.

import type { Segmentation } from 'veronese';
import { labellingOf } from './parts.js';
import { type Runs, packed, sizeOf, unpacked } from './runs.js';
import type { Stroke } from './strokes.js';

/** A result with its labels run-length encoded. */
export interface Packed {
  readonly report: Omit<Segmentation, 'labels'>;
  readonly runs: Runs;
}

export function packedResult({ labels, ...report }: Segmentation, runs = packed(labels, report.width, report.height)): Packed {
  return { report, runs };
}

export function unpackedResult({ report, runs }: Packed): Segmentation {
  return { ...report, labels: unpacked(runs) };
}

/** Capacity of the cache, bytes: some hundred labellings of frames of 4096 pixels. */
const MOST = 64 * 2 ** 20;

export class Solutions {
  /** By the last stroke, oldest first. */
  readonly #answers = new Map<Stroke, { readonly of: Runs; readonly packed: Packed }>();
  #bytes = 0;

  /** The labels solved with the strokes up to `last`; undefined if they are not in the cache. */
  get(last: Stroke, found: Segmentation): Segmentation | undefined {
    const answer = this.#answers.get(last);
    return answer?.of === labellingOf(found) ? unpackedResult(answer.packed) : undefined;
  }

  add(last: Stroke, found: Segmentation, solved: Segmentation): void {
    this.#drop(last);
    const answer = { of: labellingOf(found), packed: packedResult(solved) };
    this.#answers.set(last, answer);
    this.#bytes += sizeOf(answer.packed.runs);
    for (const oldest of this.#answers.keys()) {
      if (this.#bytes <= MOST) break;
      this.#drop(oldest);
    }
  }

  #drop(last: Stroke): void {
    const answer = this.#answers.get(last);
    if (answer === undefined) return;
    this.#answers.delete(last);
    this.#bytes -= sizeOf(answer.packed.runs);
  }
}
