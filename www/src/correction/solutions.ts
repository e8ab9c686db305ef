//! Labels that were solved under strokes, so that undoing and stepping back need not solve them again. Strokes alone decide the
//! answer: what is forgotten here is solved anew.

import type { Segmentation } from 'veronese';
import { labellingOf } from './parts.js';
import { type Runs, packed, sizeOf, unpacked } from './runs.js';
import type { Stroke } from './strokes.js';

/** A result without its labels, and these apart. */
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

/** Bytes; some hundred answers for frames of 4096 pixels. */
const MOST = 64 * 2 ** 20;

export class Solutions {
  /** By the last stroke, the oldest first. */
  readonly #answers = new Map<Stroke, { readonly of: Runs; readonly packed: Packed }>();
  #bytes = 0;

  /** The answer to these strokes, by the last of them, of what was found; undefined where it is not known (any more). */
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
