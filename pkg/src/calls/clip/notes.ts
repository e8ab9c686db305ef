// Why a clip has no object, or which of its objects are likely to be none. Loaded when there is something to say.

import type { ClipTracks, Note, Pixels, Segmentation } from '../../../types/index.js';
import { whyNothing } from '../nothing.js';
import type { Ground, SeenPair, Tracks } from './tracks.js';

/** Pairs of neighbouring frames that are looked at, all over the clip. */
const PAIRS = 5;
/** Distances at which frames are compared where those up to eight apart, which a clip compares itself, show nothing. */
const STEPS = [16, 32];

/** The frames of a clip that can be read once more. */
export interface SeenFrames {
  length: number;
  read: (index: number) => Promise<Pixels>;
  /** Quickly. */
  segment: (first: Pixels, second: Pixels) => Promise<Segmentation>;
}

/** Notes on a clip without annotations, from its frames, or from a pair if these came once. */
export async function notesOn(tracks: Tracks, frames: SeenFrames | undefined, pair?: SeenPair): Promise<Note[]> {
  if (!tracks.isEmpty) return tracks.grounds().map(groundNote);
  if (frames && frames.length > 1) return [await whyEmpty(tracks.value(), frames)];
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
  if (reason.code === 'no-contrast' || reason.code === 'cut')
    return { ...reason, message: `${reason.message}, in ${count(reason.code)} of ${some.length} pairs that were looked at` };
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
