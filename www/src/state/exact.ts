//! Labels drawn exactly in frames of a clip lie over all that is found there. The package does not get them, so that nothing follows.

import { type Runs, extentsOf, over } from '../correction/runs.js';
import { UNLABELLED } from '../result/masks.js';
import type { TrackedFrame, Version } from './tracked.js';

/** The masks of a frame with labels over them, and its objects as they are then; the same masks if that changes none. */
export function overlaid(frame: TrackedFrame, above: Runs | undefined): TrackedFrame {
  const runs = above === undefined ? frame.runs : over(frame.runs, above);
  return runs === frame.runs ? frame : withRuns(frame, runs);
}

/** The masks of a frame with what became of objects; the same masks if none of them is there. */
export function relabelled(frame: TrackedFrame, became: Version['became']): TrackedFrame {
  const { runs } = frame;
  return runs.labels.some((label) => became.has(label)) ? withRuns(frame, { ...runs, labels: runs.labels.map((label) => became.get(label) ?? label) }) : frame;
}

function withRuns(frame: TrackedFrame, runs: Runs): TrackedFrame {
  const known = new Map(frame.objects.map((object) => [object.id, object]));
  const objects = [...extentsOf(runs)]
    .filter(([id]) => id !== 0 && id !== UNLABELLED)
    .map(([id, extent]) => ({ confidence: 1, matrix: null, ...known.get(id), ...extent, id }))
    .sort((one, other) => one.id - other.id);
  return { ...frame, runs, objects };
}

/** The masks with what was drawn exactly over them. */
export function exactly<V extends Version>(version: V): V {
  const { frames, exact } = version;
  return exact.size === 0 ? version : { ...version, frames: frames.map((frame, index) => frame && overlaid(frame, exact.get(index))) };
}
