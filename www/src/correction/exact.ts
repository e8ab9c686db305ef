//! Labels drawn exactly on the masks of a pair are kept pixel for pixel, whatever is solved around them.

import type { Segmentation } from 'veronese';
import { UNLABELLED } from '../result/masks.js';
import { type Edits, type Exact, grouped } from './edits.js';
import { continuation, labellingOf } from './parts.js';
import { type Runs, extentsOf, packed, resized, unpacked } from './runs.js';
import { type Path, type Stroke, allowedLabels, eachPixel } from './strokes.js';

/** The labels of a path over these: the mask's pixels stay as they are, others get its first label; erased ones get the first of all others. */
export function drawnExactly(path: Path, { tool, mask }: Pick<Stroke, 'tool' | 'mask'>, labels: Uint8Array, found: Segmentation): Exact {
  const { width, height } = found;
  const allowed = allowedLabels({ tool, mask }, found);
  const drawn = new Uint8Array(labels.length).fill(UNLABELLED);
  eachPixel(path, width, height, (p) => {
    const label = labels[p]!;
    const stays = isIn(allowed, label) || (tool === 'eraser' && label === UNLABELLED && mask.labels !== 0);
    if (!stays) drawn[p] = 31 - Math.clz32(allowed & -allowed);
    else if (tool === 'brush') drawn[p] = label;
  });
  return { of: labellingOf(found), labels: packed(drawn, width, height) };
}

/** A solution with the edits: what was drawn exactly, unless a later stroke changed it, and the user's groups. */
export function withEdits(solved: Segmentation, edits: Edits, found: Segmentation): Segmentation {
  const actions = edits.actions.slice(0, edits.done);
  if (!actions.some((action) => 'exact' in action)) return grouped(solved, edits, found);
  const { width, height } = found;
  const drawn = new Uint8Array(width * height).fill(UNLABELLED);
  for (const action of actions) {
    if ('exact' in action) {
      const numbers = numbersIn(action.exact.of, found);
      unpacked(resized(action.exact.labels, found)).forEach((label, p) => {
        if (label !== UNLABELLED) drawn[p] = numbers.get(label) ?? UNLABELLED;
      });
    } else if ('stroke' in action) {
      const allowed = allowedLabels(action.stroke, found);
      eachPixel(action.stroke, width, height, (p) => {
        if (allowed !== 0 && !isIn(allowed, drawn[p]!)) drawn[p] = UNLABELLED;
      });
    }
  }
  const labels = solved.labels.map((label, p) => (drawn[p] === UNLABELLED ? label : drawn[p]!));
  const extents = extentsOf(packed(labels, width, height));
  const motions = solved.motions.map((motion) => {
    const { pixels, bbox } = extents.get(motion.label) ?? { pixels: 0, bbox: [0, 0, 0, 0] };
    return { ...motion, pixels, bbox, share: pixels / labels.length };
  });
  return grouped({ ...solved, labels, motions, unlabelled: extents.get(UNLABELLED)?.pixels ?? 0 }, edits, found);
}

/** The labels that those of another labelling have in this result; of several the one that overlaps most. */
function numbersIn(of: Runs, found: Segmentation): ReadonlyMap<number, number> {
  const now = labellingOf(found);
  if (of === now) return new Map(found.motions.map(({ label }) => [label, label]));
  return new Map([...continuation(of, now)].toReversed().map(([is, was]) => [was, is]));
}

/** Whether a set of labels has this one, which may be 255. */
function isIn(labels: number, label: number): boolean {
  return label < 32 && ((labels >> label) & 1) === 1;
}
