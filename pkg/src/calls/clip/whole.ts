// A clip whose frames can be read again: once for their pairs, where corrections want them, and once for their labels.

import type { ClipFrame } from '../../../types/index.js';
import { checkedBytes, invalidInput } from '../../common/checks.js';
import { VeroneseError } from '../../common/errors.js';
import type { Annotating, Annotations, ClipSummary, LabelledFrame as Found } from '../messages.js';
import { inOrder } from '../ordered.js';
import { taken } from '../taking.js';
import type { CheckedOptions, Whole } from './options.js';
import { checkCount, type Frames, reads, upTo } from './frames.js';
import type { PlacedClip } from './place.js';
import { isWithin, type Prompt, type LabelledFrame } from './annotations.js';
import type { Looked, SharedPairs } from './shared-pairs.js';
import { type ClipResults, sized } from './tracks.js';

/** The options, with masks that are checked as well. */
type Task = Omit<CheckedOptions, 'masks'> & { masks: readonly LabelledFrame[] };

/** If the source fails, the frames before come first. */
export async function* segmentedTwice(clip: PlacedClip, frames: Frames, asked: CheckedOptions, results: ClipResults): AsyncGenerator<ClipFrame, void, undefined> {
  const { transfer, onProgress } = asked;
  const task = { ...asked, masks: asked.masks === undefined ? [] : await masksOf(asked) };
  const { read, length: of } = task.source as Whole;
  // A state may be of the frames before one that failed.
  if (!task.state) checkCount(of);
  const { length, dropped } = task.state ? await restored(clip, frames, task, task.state) : await solved(clip, frames, task);
  const { failure } = frames;
  const unsaid = unsaidOf(task);
  const { changed, changes, objects } = await annotated(clip, frames, task, length);
  const numbers = unsaid.filter((number) => !objects.includes(number));
  if (numbers.length > 0) results.missing = { numbers, objects };
  results.state = await clip.step<Uint8Array>({ call: 'saveClip' });
  results.changes = changes;
  results.tracks.dropped = dropped;
  results.tracks.names = task.edits.names;
  const indices = [...upTo(length)].filter((index) => !task.changesOnly || changed.has(index));
  let done = 0;
  for await (const frame of frames.each(reads(read, indices), { indices, transfer })) {
    const index = indices[done++] as number;
    onProgress?.({ frame: index, of, stage: 'labels' });
    const step = clip.step<Found>({ call: 'clipFrame', index, frame });
    frames.ahead();
    yield results.tracks.see(await step, frame);
  }
  const failed = frames.failure ?? failure;
  if (failed) throw failed.thrown;
}

async function masksOf({ masks, source }: CheckedOptions): Promise<LabelledFrame[]> {
  const { checkedMasks } = await import('./given-masks.js');
  return checkedMasks(masks, source.length as number);
}

/** Solves the pairs that are not known. Without a look-ahead, who solves them does not matter. */
async function solved(clip: PlacedClip, frames: Frames, task: Task): Promise<ClipSummary> {
  const onPairs = (index: number, pairs: Uint8Array) => clip.wait(task.onPairs?.(index, pairs));
  const { signal, settings } = task;
  const { workers } = clip.place;
  let shared: SharedPairs | undefined;
  if (settings['lookAhead'] === 'all' && workers && workers.size > 1) {
    // A single worker does without that code.
    const { SharedPairs } = await import('./shared-pairs.js');
    shared = new SharedPairs(clip, workers, settings);
  }
  const all = looked(clip, frames, task);
  for await (const { index, frame, pairs: known } of shared ? shared.solved(all, inOrder, { signal, onPairs }) : all) {
    task.onProgress?.({ frame: index, of: task.source.length, stage: 'pairs' });
    const step = clip.step<Uint8Array | undefined>({ call: 'pushClip', frame, ...(known && { known }) });
    const seen = task.onPreview ? clip.step<Found | undefined>({ call: 'previewClip' }) : undefined;
    (shared ?? frames).ahead();
    const [pairs, preview] = await Promise.all([step, seen]);
    if (pairs) await onPairs(index, pairs);
    if (preview) await clip.wait(task.onPreview?.(sized(preview, frame)));
    shared?.taken();
  }
  return clip.step({ call: 'concludeClip' });
}

/** The frames of a clip with what is known of their pairs. */
async function* looked(clip: PlacedClip, frames: Frames, task: Task): AsyncGenerator<Looked, void, undefined> {
  const { read, length } = task.source as Whole;
  let index = 0;
  for await (const frame of frames.each(reads(read, upTo(length)))) {
    if (index === 0) checkSizes(task, frame);
    const known = await clip.wait(task.knownPairs?.(index));
    const pairs = known === undefined ? undefined : (taken([checkedBytes(`the pairs of frame ${index}`, known)], false)[0] as Uint8Array);
    yield { index, frame, pairs };
    index += 1;
  }
}

async function restored(clip: PlacedClip, frames: Frames, task: Task, state: Uint8Array): Promise<ClipSummary> {
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

/** The numbers in edits, but those that annotations of the same call are about: of what is deleted as well nothing is left. */
function unsaidOf({ edits: { numbers, names }, locked, masks, corrections, prompts }: Task): number[] {
  const isPainted = (number: number) => numbers.get(number) === 0 && [...masks, ...corrections].some(({ labels }) => labels.includes(number));
  const isSaid = (number: number) => number === 0 || prompts.some(({ object }) => object === number) || isPainted(number);
  return [...new Set([...[...numbers].flat(), ...names.keys(), ...(locked ?? [])])].filter((number) => !isSaid(number)).sort((one, other) => one - other);
}

/** Applies all annotations; returns the indices of the frames that change, what objects gain and lose, and their numbers before any edit. */
async function annotated(clip: PlacedClip, frames: Frames, task: Task, length: number): Promise<Required<Omit<Annotating, 'wanted' | 'changed'>> & { changed: Set<number> }> {
  const { source, onProgress, onChange } = task;
  const { read } = source as Whole;
  const changed = new Set<number>();
  let step = await clip.step<Annotating>({ call: 'annotateClip', annotations: annotationsOf(task, length) });
  for (;;) {
    for (const index of step.changed) {
      changed.add(index);
      if (!onChange) continue;
      let isCalled = true;
      const segmented = async () => {
        if (!isCalled) throw invalidInput(`frame ${index} was asked for when 'onChange' had ended`);
        const frame = await frames.one(read, index);
        return sized(await clip.step<Found>({ call: 'clipFrame', index, frame }), frame);
      };
      await clip.wait(onChange(index, segmented));
      isCalled = false;
    }
    const { wanted, changes = [], objects = [] } = step;
    if (wanted === undefined) return { changed, changes, objects };
    onProgress?.({ frame: wanted, of: source.length, stage: 'corrections' });
    step = await clip.step<Annotating>({ call: 'takeAnnotations', frame: await frames.one(read, wanted) });
  }
}

/** The source may have failed before it came to an annotated frame. */
function annotationsOf({ masks, corrections, prompts, accepted, locked, edits }: Task, length: number): Annotations {
  const isThere = ({ frame }: { frame: number }) => frame < length;
  const maps = [...masks, ...corrections].filter(({ object, propagate }) => object === undefined && propagate !== undefined);
  const ways = new Map(maps.map(({ frame, propagate }) => [frame, propagate]));
  const spread = <T extends LabelledFrame | Prompt>(said: readonly T[]) => said.filter(isThere).map((each) => ({ ...each, propagate: each.propagate ?? ways.get(each.frame) }));
  return {
    masks: spread(masks),
    corrections: spread(corrections),
    prompts: spread(prompts),
    accepted: accepted?.filter(isThere),
    locked,
    named: edits.named,
    numbers: Uint8Array.from([...edits.numbers].flat()),
  };
}

function checkSizes({ masks, corrections, prompts, accepted = [] }: Task, size: { width: number; height: number }): void {
  for (const [option, said] of Object.entries({ masks, corrections, accepted }) as [string, readonly Partial<LabelledFrame>[]][]) {
    for (const { frame, labels, width = size.width } of said) {
      if (labels === undefined || (labels.length === size.width * size.height && width === size.width)) continue;
      const sentence = `that of frame ${frame} has ${labels.length} labels, a frame has ${size.width}×${size.height} pixels`;
      throw new VeroneseError('invalid-option', `option '${option}': ${sentence}`);
    }
  }
  const outside = prompts.find((prompt) => !isWithin(prompt, size));
  if (outside === undefined) return;
  const sentence = `what points to object ${outside.object} in frame ${outside.frame} is not within ${size.width}×${size.height} pixels`;
  throw new VeroneseError('invalid-option', `option '${outside.option}': ${sentence}`);
}
