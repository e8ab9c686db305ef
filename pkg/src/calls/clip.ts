// Clips: frames in, labelled frames and tracks out. Direct calls and workers share this.

import type { Clip, ClipFrame, ClipOptions, ClipSource } from '../../types/index.js';
import { reading } from '../common/checks.js';
import { cancelled } from '../common/errors.js';
import { checkedOptions } from './clip/options.js';
import { Frames } from './clip/frames.js';
import type { Places } from './places.js';
import { type Place, PlacedClip } from './clip/place.js';
import { streamed } from './clip/stream.js';
import { type ClipResults, Tracks } from './clip/tracks.js';
import { segmentedTwice } from './clip/whole.js';

/** `reserve` finds a place for the clip. Arguments are checked when the first frame is requested, as generators do. */
export function clipOf(frames: ClipSource, options: ClipOptions | undefined, reserve: (signal?: AbortSignal) => Promise<Place>, places?: Places): Clip {
  const results: ClipResults = { tracks: new Tracks() };
  const rest = { tracks: () => results.tracks.value(), state: async () => results.state?.slice(), changes: async () => structuredClone(results.changes ?? []) };
  const clip = Object.assign(segmented(frames, options, reserve, places, results), rest);
  dropped.register(clip, results);
  return clip;
}

/** Ends clips whose iterators were dropped before their end. */
const dropped = new FinalizationRegistry<ClipResults>(({ clip }) => void clip?.end());

async function* segmented(
  frames: ClipSource,
  options: ClipOptions | undefined,
  reserve: (signal?: AbortSignal) => Promise<Place>,
  places: Places | undefined,
  results: ClipResults,
): AsyncGenerator<ClipFrame, void, undefined> {
  const task = reading(() => checkedOptions(frames, options));
  const { signal } = task;
  if (signal?.aborted) throw cancelled(signal);
  const place = await reserve(signal);
  const clip = new PlacedClip(place, signal);
  results.clip = clip;
  try {
    const whole = 'read' in task.source;
    await clip.begin(whole, task.settings);
    const taken = new Frames(task, places);
    for await (const frame of whole ? segmentedTwice(clip, taken, task, results) : streamed(clip, taken, task, results)) {
      place.pause?.(true);
      yield frame;
      place.pause?.(false);
    }
    const { tracks, missing } = results;
    if (missing || tracks.isEmpty || tracks.grounds().length > 0) tracks.notes = await (await import('./clip/notes.js')).notesOn(clip, taken, task, results);
  } finally {
    delete results.clip;
    // Nobody waits for that.
    void clip.end();
  }
}
