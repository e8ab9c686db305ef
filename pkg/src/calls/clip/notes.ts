// What is to be said of a clip whose result is nothing, or is sure to be wrong. Loaded when there is something to say.

import type { ClipTracks, Note, Pixels, Segmentation } from '../../../types/index.js';
import { whyNothing } from '../nothing.js';
import type { Frames } from './frames.js';
import type { CheckedOptions, Stream, Whole } from './options.js';
import type { PlacedClip } from './place.js';
import type { ClipResults, Ground, SeenPair } from './tracks.js';

/** Pairs of neighbouring frames that are looked at, all over the clip. */
const PAIRS = 5;
/** Distances at which frames are compared where those up to eight apart, which a clip compares itself, show nothing. */
const STEPS = [16, 32];

/** The frames of a clip that can be read once more. */
interface SeenFrames {
  length: number;
  read: (index: number) => Promise<Pixels>;
  /** Quickly. */
  segment: (first: Pixels, second: Pixels) => Promise<Segmentation>;
}

/** Says which edits change nothing, and of the result what {@link ofResult} does. */
export async function notesOn(clip: PlacedClip, taken: Frames, task: CheckedOptions, results: ClipResults): Promise<Note[]> {
  return [...(results.missing ? [missingNote(results.missing)] : []), ...(await ofResult(clip, taken, task, results))];
}

function missingNote({ numbers, objects }: NonNullable<ClipResults['missing']>): Note {
  const there = objects.length > 0 ? `the objects are ${objects.join(', ')}` : 'there is no object';
  return { code: 'object-missing', message: `edits of objects that are not there change nothing: ${numbers.join(', ')}; ${there}` };
}

/** Says why nothing was found, or what is likely to be wrong; of annotated clips a person knows more. */
async function ofResult(clip: PlacedClip, taken: Frames, { source, settings, signal, ...task }: CheckedOptions, { tracks, changes = [], pair }: ClipResults): Promise<Note[]> {
  if (task.changesOnly || task.accepted || task.edits.numbers.size + changes.length > 0) return [];
  if (!tracks.isEmpty) return tracks.grounds().map(groundNote);
  if (settings['motions'] === 1) return [];
  const { length = 0, read, again = read } = source as Partial<Stream & Whole>;
  const segment = (first: Pixels, second: Pixels) =>
    clip.place.perform({ call: 'segmentPair', frames: [first, second], settings: { quality: 'fast' } }, { signal }) as Promise<Segmentation>;
  if (again && length > 1) return [await whyEmpty(tracks.value(), { length, read: (index) => taken.one(again, index), segment })];
  return pair ? [whyPair(tracks.value(), pair)] : [];
}

function groundNote({ id, large, of }: Ground): Note {
  const message = `object ${id} covers more than half of the picture, or nearly all of its border, in ${large} of its ${of} frames: it is likely to be the ground`;
  return { code: 'object-is-ground', message };
}

/** The reason that most of some pairs of neighbours have, and a distance of frames at which something moves. */
async function whyEmpty(tracks: ClipTracks, frames: SeenFrames): Promise<Note> {
  const last = frames.length - 2;
  const some = [...new Set(Array.from({ length: PAIRS }, (_, k) => Math.round((k * last) / (PAIRS - 1))))];
  const reasons: Note[] = [];
  for (const index of some) reasons.push(whyPair(tracks, { index, frames: [await frames.read(index), await frames.read(index + 1)] }));
  const count = (code: string) => reasons.filter((reason) => reason.code === code).length;
  const [reason] = [...reasons].sort((a, b) => count(b.code) - count(a.code)) as [Note];
  if (reason.code === 'no-contrast' || reason.code === 'cut') return { ...reason, message: `${reason.message}, in ${count(reason.code)} of ${some.length} pairs that were looked at` };
  const step = await tellingStep(frames);
  if (step === undefined) return reason;
  const message = `between frames that are up to 8 apart nothing moves far enough to be told; between frames that are ${step} apart something does`;
  return { code: 'small-steps', message, step };
}

function whyPair({ background }: ClipTracks, { index, frames: [first, second] }: SeenPair): Note {
  return whyNothing(first, second, { matrix: background.find(({ frame }) => frame === index)?.matrix });
}

/** The smallest of some distances at which a pair in the middle of the clip has more than one motion. */
async function tellingStep({ length, read, segment }: SeenFrames): Promise<number | undefined> {
  for (const step of STEPS) {
    // A clip of every such frame needs two of them.
    if (step >= length) return undefined;
    const from = Math.floor((length - 1 - step) / 2);
    const { count } = await segment(await read(from), await read(from + step));
    if (count > 1) return step;
  }
  return undefined;
}
