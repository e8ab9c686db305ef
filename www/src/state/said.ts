//! What a person has said of a clip is seen at once: here is what it changes on screen until the clip answers.

import type { ClipEntry } from 'veronese';
import { type Runs, extentsOf, packed, unpacked } from '../result/runs.js';
import { UNLABELLED } from '../result/masks.js';
import { type Annotated, type ClipState, type Prompt, type TrackedFrame, isObject, lockedIn } from './tracked.js';

/** What is seen of a command. */
export type Effect = (clip: ClipState) => ClipState;

/** An object is painted in a frame: 1 where it is, 0 where it is not, 255 where nothing changes. Of 0: nothing is there where the labels are 0. */
export function painted(index: number, object: number, labels: Uint8Array): Effect {
  const annotated = annotating(index, object);
  // It is seen again whenever anything changes, and mostly of the same masks.
  let last: { readonly frame: TrackedFrame; readonly objects: ClipState['objects']; readonly now: TrackedFrame } | null = null;
  const over = (frame: TrackedFrame, clip: ClipState): TrackedFrame => {
    if (last?.frame !== frame || last.objects !== clip.objects) last = { frame, objects: clip.objects, now: painting(frame, object, labels, lockedIn(clip)) };
    return last.now;
  };
  return (clip) => {
    const frame = clip.frames[index];
    const now = frame && over(frame, clip);
    return annotated(now && now !== frame ? { ...clip, frames: clip.frames.with(index, now) } : clip);
  };
}

function painting(frame: TrackedFrame, object: number, labels: Uint8Array, locked: ReadonlySet<number>): TrackedFrame {
  const { width, height } = frame.runs;
  const now = unpacked(frame.runs);
  let changes = false;
  for (let p = 0; p < now.length; p++) {
    const [label, was] = [labels[p]!, now[p]!];
    if (label === UNLABELLED || locked.has(was) || (label === 0 && object !== 0 && was !== object)) continue;
    now[p] = label === 0 ? 0 : object;
    changes ||= now[p] !== was;
  }
  return changes ? withRuns(frame, packed(now, width, height)) : frame;
}

/** Nothing is seen of a prompt yet; its number is taken. */
export function prompted(index: number, prompt: Prompt): Effect {
  return annotating(index, prompt.object, prompt);
}

/** Objects are merged, or deleted: `became` has their numbers from now on, or 0. */
export function becoming(became: ReadonlyMap<number, number>): Effect {
  return (clip) => ({
    ...clip,
    objects: clip.objects.map((object) => ({ ...object, became: became.get(object.became) ?? object.became })),
    frames: clip.frames.map((frame) => {
      if (frame === null || !frame.objects.some(({ id }) => became.has(id))) return frame;
      return withRuns(frame, { ...frame.runs, labels: frame.runs.labels.map((label) => became.get(label) ?? label) });
    }),
  });
}

/** Something is said of objects as wholes. */
export function about(objects: readonly number[], change: (object: ClipEntry) => Partial<ClipEntry>): Effect {
  return (clip) => ({ ...clip, objects: clip.objects.map((object) => (objects.includes(object.number) ? { ...object, ...change(object) } : object)) });
}

export function accepted(frames: readonly number[]): Effect {
  return (clip) => ({ ...clip, status: clip.status.map((status, index) => (frames.includes(index) ? { ...status, accepted: true } : status)) });
}

function annotating(index: number, object: number, prompt: Prompt | null = null): Effect {
  return (clip) => {
    const { objects, prompts } = clip.annotated.get(index) ?? { objects: [], prompts: [] };
    const now: Annotated = {
      objects: [...new Set([...objects, object])],
      prompts: prompt === null ? prompts : [...prompts.filter((other) => other.object !== object), prompt],
    };
    const isKnown = object === 0 || clip.objects.some(({ number }) => number === object);
    const entry: ClipEntry = { number: object, name: '', class: '', locked: false, annotated: true, became: object };
    return { ...clip, annotated: new Map(clip.annotated).set(index, now), objects: isKnown ? clip.objects : [...clip.objects, entry] };
  };
}

function withRuns(frame: TrackedFrame, runs: Runs): TrackedFrame {
  const known = new Map(frame.objects.map((object) => [object.id, object]));
  const objects = [...extentsOf(runs)]
    .filter(([id]) => isObject(id))
    .map(([id, extent]) => ({ confidence: 1, matrix: null, ...known.get(id), ...extent, id }))
    .sort((one, other) => one.id - other.id);
  return { ...frame, runs, objects };
}
