// What is to be said of a clip whose result is nothing, or is sure to be wrong.

import type { ClipTracks, Note } from '../../types/index.js';
import { whyNothing } from '../calls/nothing.js';
import { api } from '../entries/codecs.js';
import type { ClipFrames } from './clip-frames.js';

/** Pairs of neighbouring frames that are looked at, all over the clip. */
const PAIRS = 5;
/** Distances at which frames are compared where neighbours show nothing. */
const STEPS = [2, 4, 8, 16];
/** An object that covers more of the picture in most of its frames is none. */
const MOST = 0.5;

export async function notesOnTracks(tracks: ClipTracks, frames: ClipFrames): Promise<Note[]> {
  if (tracks.objects.length === 0) return [await whyEmpty(tracks, frames)];
  const { width, height } = frames.size as { width: number; height: number };
  return tracks.objects.flatMap(({ id, frames: seen }) => {
    const large = seen.filter(({ pixels }) => pixels > MOST * width * height);
    if (2 * large.length <= seen.length) return [];
    const message = `object ${id} covers more than half of the picture in ${large.length} of its ${seen.length} frames: it is likely to be the ground`;
    return [{ code: 'object-is-ground', message }];
  });
}

/** The reason that most of some pairs of neighbours have, and a distance of frames at which something moves. */
async function whyEmpty({ background }: ClipTracks, frames: ClipFrames): Promise<Note> {
  const last = frames.length - 2;
  const some = [...new Set(Array.from({ length: PAIRS }, (_, k) => Math.round((k * last) / (PAIRS - 1))))];
  const reasons: Note[] = [];
  for (const index of some) {
    const matrix = background.find(({ frame }) => frame === index)?.matrix ?? undefined;
    reasons.push(whyNothing(await frames.read(index), await frames.read(index + 1), { matrix }));
  }
  const count = (code: string) => reasons.filter((reason) => reason.code === code).length;
  const [reason] = [...reasons].sort((a, b) => count(b.code) - count(a.code)) as [Note];
  if (reason.code === 'no-contrast' || reason.code === 'cut') return { ...reason, message: `${reason.message}, in ${count(reason.code)} of ${some.length} pairs that were looked at` };
  const step = await tellingStep(frames);
  if (step === undefined) return reason;
  return { code: 'small-steps', message: `between neighbouring frames nothing moves far enough to be told; between frames that are ${step} apart something does: try '--every ${step}'` };
}

/** The smallest of some distances at which a pair in the middle of the clip has more than one motion. */
async function tellingStep(frames: ClipFrames): Promise<number | undefined> {
  for (const step of STEPS) {
    // A clip of every such frame needs two of them.
    if (step >= frames.length) return undefined;
    const from = Math.floor((frames.length - 1 - step) / 2);
    const { count } = await api.segmentPair(await frames.read(from), await frames.read(from + step), { quality: 'fast' });
    if (count > 1) return step;
  }
  return undefined;
}
