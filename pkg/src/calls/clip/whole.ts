// A clip whose frames can be read again: once for their pairs, where corrections want them, and once for their labels.

import type { ClipFrame } from '../../../types/index.js';
import { checkedBytes } from '../../common/checks.js';
import { VeroneseError } from '../../common/errors.js';
import type { ClipSummary } from '../messages.js';
import { taken } from '../taking.js';
import type { Asked, Whole } from './asked.js';
import { type Frames, reads } from './frames.js';
import type { PlacedClip } from './place.js';
import type { Told } from './tracks.js';

/** If the source fails, the frames before come first. */
export async function* segmentedTwice(clip: PlacedClip, frames: Frames, task: Asked, told: Told): AsyncGenerator<ClipFrame, void, undefined> {
  const { transfer, onProgress } = task;
  const { read, length: of } = task.source as Whole;
  const { length, dropped } = task.state ? await restored(clip, frames, task, task.state) : await solved(clip, frames, task);
  const { failure } = frames;
  const changed = await edited(clip, frames, task, length);
  told.state = await clip.step<Uint8Array>({ call: 'saveClip' });
  told.tracks.dropped = dropped;
  told.tracks.names = task.edits.names;
  const indices = [...upTo(length)].filter((index) => !task.changesOnly || changed.has(index));
  let done = 0;
  for await (const frame of frames.each(reads(read, indices), { indices, transfer })) {
    const index = indices[done++] as number;
    onProgress?.({ frame: index, of, stage: 'labels' });
    const step = clip.step<ClipFrame>({ call: 'clipFrame', index, frame });
    frames.ahead();
    yield told.tracks.add(await step);
  }
  const failed = frames.failure ?? failure;
  if (failed) throw failed.thrown;
}

/** Solves the pairs that are not known. */
async function solved(clip: PlacedClip, frames: Frames, task: Asked): Promise<ClipSummary> {
  const { read, length: of } = task.source as Whole;
  let index = 0;
  for await (const frame of frames.each(reads(read, upTo(of)))) {
    if (index === 0) checkSizes(task, frame);
    task.onProgress?.({ frame: index, of, stage: 'pairs' });
    const known = await clip.wait(task.knownPairs?.(index));
    const bytes = known === undefined ? undefined : (taken([checkedBytes(`the pairs of frame ${index}`, known)], false)[0] as Uint8Array);
    const step = clip.step<Uint8Array | undefined>({ call: 'pushClip', frame, ...(bytes && { known: bytes }) });
    frames.ahead();
    const pairs = await step;
    if (pairs) await clip.wait(task.onPairs?.(index, pairs));
    index += 1;
  }
  return clip.step({ call: 'concludeClip' });
}

async function restored(clip: PlacedClip, frames: Frames, task: Asked, state: Uint8Array): Promise<ClipSummary> {
  const summary = await clip.step<ClipSummary>({ call: 'restoreClip', state, markUnknown: task.settings['markUnknown'] === true });
  const { length } = task.source;
  if (summary.length !== length) {
    throw new VeroneseError('invalid-option', `option 'state': it is of a clip of ${summary.length} frames, not ${length}`);
  }
  if (length > 0) {
    frames.size = summary;
    checkSizes(task, summary);
  }
  return summary;
}

/** Applies corrections and edits; returns the indices of the frames that they change. */
async function edited(clip: PlacedClip, frames: Frames, { source, corrections, edits, onProgress }: Asked, length: number): Promise<Set<number>> {
  const changed = new Set<number>();
  // The source may have failed before it came to a corrected frame.
  for (const { frame: index, labels } of corrections.filter(({ frame }) => frame < length)) {
    await clip.step({ call: 'correctClip', index, labels });
    let next: number | number[] = index;
    while (typeof next === 'number') {
      onProgress?.({ frame: next, of: source.length, stage: 'corrections' });
      const frame = await frames.one((source as Whole).read, next);
      next = await clip.step<number | number[]>({ call: 'takeCorrection', frame });
    }
    for (const index of next) changed.add(index);
  }
  for (const [object, number] of edits.numbers) {
    const seen = await clip.step<number[]>({ call: 'renumberClip', object, number });
    for (const index of seen) changed.add(index);
  }
  return changed;
}

/** Numbers from 0, one by one: a source may claim any length. */
function* upTo(length: number): Generator<number, void, undefined> {
  for (let index = 0; index < length; index++) yield index;
}

function checkSizes({ corrections }: Asked, { width, height }: { width: number; height: number }): void {
  for (const { frame, labels } of corrections) {
    if (labels.length === width * height) continue;
    const sentence = `that of frame ${frame} has ${labels.length} labels, a frame has ${width}×${height} pixels`;
    throw new VeroneseError('invalid-option', `option 'corrections': ${sentence}`);
  }
}
