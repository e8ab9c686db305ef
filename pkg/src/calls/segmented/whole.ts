// A clip whose frames can be read again: once for their pairs, where corrections want them, and once for their labels.

import type { ClipFrame, Pixels } from '../../../types/index.js';
import { checkedBytes, invalidInput } from '../../common/checks.js';
import { VeroneseError } from '../../common/errors.js';
import type { Annotating, Annotations, ClipSummary, LabelledFrame as Found } from '../messages.js';
import { Ahead } from '../session/ahead.js';
import { taken } from '../taking.js';
import type { CheckedOptions } from './options.js';
import { checkCount, type Frames, reads, upTo } from '../clip/frames.js';
import type { PlacedClip } from './place.js';
import { isWithin, type Prompt, type LabelledFrame } from './annotations.js';
import { sized } from '../clip/tracks.js';
import type { ClipResults } from './clip.js';

/** If the source fails, the frames before come first. */
export async function* segmentedTwice(
  clip: PlacedClip,
  frames: Frames,
  task: CheckedOptions,
  results: ClipResults,
): AsyncGenerator<ClipFrame, void, undefined> {
  const { transfer, onProgress } = task;
  const { read, length: of } = task.source;
  // A state may be of the frames before one that failed.
  if (!task.state) checkCount(of);
  const { length, dropped } = task.state ? await restored(clip, frames, task, task.state) : await solved(clip, frames, task);
  const { failure } = frames;
  const { changed, changes } = await annotated(clip, frames, task, length);
  results.state = await clip.step<Uint8Array>({ call: 'saveSegmented' });
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

/** Solves the pairs that are not known. Without a look-ahead, who solves them does not matter. */
async function solved(clip: PlacedClip, frames: Frames, task: CheckedOptions): Promise<ClipSummary> {
  const { settings } = task;
  const { read, length } = task.source;
  const { size, anywhere } = clip.place;
  const onPairs = (index: number, pairs: Uint8Array) => clip.wait(task.onPairs?.(index, pairs));
  const known = new Map<number, Uint8Array>();
  for (const index of task.knownPairs ? upTo(length) : []) {
    const pairs = await clip.wait(task.knownPairs?.(index));
    if (pairs) known.set(index, taken([checkedBytes(`the pairs of frame ${index}`, pairs)], false)[0] as Uint8Array);
  }
  const solve = async (index: number, first: Pixels, second: Pixels) => {
    const { motions, quality, subject } = settings;
    const frames = [copyOf(first), copyOf(second)] as const;
    const pairs = (await anywhere?.(
      { call: 'solvePair', frames, settings: { motions, quality, subject } },
      { signal: task.signal },
    )) as Uint8Array;
    await onPairs(index, pairs.slice());
    return pairs;
  };
  const isShared = size > 1 && settings['lookAhead'] === 'all';
  const ahead = new Ahead((index) => frames.one(read, index), isShared ? solve : undefined, isShared ? size : 1, length - 1);
  for (const index of upTo(length)) {
    const next = await clip.wait(
      ahead.at(index, (index) => known.has(index)).catch((thrown) => ((frames.failure = { thrown }), undefined)),
    );
    if (!next) break;
    if (index === 0) checkSizes(task, next.frame);
    task.onProgress?.({ frame: index, of: length, stage: 'pairs' });
    const pairs = known.get(index) ?? next.pairs;
    const step = clip.step<Uint8Array | undefined>({ call: 'pushClip', frame: copyOf(next.frame), ...(pairs && { known: pairs }) });
    const seen = task.onPreview ? clip.step<Found | undefined>({ call: 'previewClip' }) : undefined;
    const [own, preview] = await Promise.all([step, seen]);
    if (own) await onPairs(index, own);
    if (preview) await clip.wait(task.onPreview?.(sized(preview, next.frame)));
  }
  clip.place.endIdle?.();
  return clip.step({ call: 'concludeClip' });
}

/** A frame goes to more than one worker. */
function copyOf({ data, ...size }: Pixels): Pixels {
  return { ...size, data: data.slice() };
}

async function restored(clip: PlacedClip, frames: Frames, task: CheckedOptions, state: Uint8Array): Promise<ClipSummary> {
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

/** Applies all annotations; returns the indices of the frames that change, and what objects gain and lose. */
async function annotated(
  clip: PlacedClip,
  frames: Frames,
  task: CheckedOptions,
  length: number,
): Promise<Required<Pick<Annotating, 'changes'>> & { changed: Set<number> }> {
  const { source, onProgress, onChange } = task;
  const { read } = source;
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
    const { wanted, changes = [] } = step;
    if (wanted === undefined) return { changed, changes };
    onProgress?.({ frame: wanted, of: source.length, stage: 'corrections' });
    step = await clip.step<Annotating>({ call: 'takeAnnotations', frame: await frames.one(read, wanted) });
  }
}

/** The source may have failed before it came to an annotated frame. */
function annotationsOf({ corrections, prompts, accepted, locked, edits }: CheckedOptions, length: number): Annotations {
  const isThere = ({ frame }: { frame: number }) => frame < length;
  const maps = corrections.filter(({ object, propagate }) => object === undefined && propagate !== undefined);
  const ways = new Map(maps.map(({ frame, propagate }) => [frame, propagate]));
  const spread = <T extends LabelledFrame | Prompt>(annotations: readonly T[]) =>
    annotations.filter(isThere).map((each) => ({ ...each, propagate: each.propagate ?? ways.get(each.frame) }));
  return {
    masks: [],
    corrections: spread(corrections),
    prompts: spread(prompts),
    accepted: accepted?.filter(isThere),
    locked,
    named: edits.named,
    numbers: Uint8Array.from([...edits.numbers].flat()),
  };
}

function checkSizes({ corrections, prompts, accepted = [] }: CheckedOptions, size: { width: number; height: number }): void {
  for (const [option, list] of Object.entries({ corrections, accepted }) as [string, readonly Partial<LabelledFrame>[]][]) {
    for (const { frame, labels } of list) {
      if (labels === undefined || labels.length === size.width * size.height) continue;
      const sentence = `that of frame ${frame} has ${labels.length} labels, a frame has ${size.width}×${size.height} pixels`;
      throw new VeroneseError('invalid-option', `option '${option}': ${sentence}`);
    }
  }
  const outside = prompts.find((prompt) => !isWithin(prompt, size));
  if (outside === undefined) return;
  const sentence = `what points to object ${outside.object} in frame ${outside.frame} is not within ${size.width}×${size.height} pixels`;
  throw new VeroneseError('invalid-option', `option '${outside.option}': ${sentence}`);
}
