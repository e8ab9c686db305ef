// Whole clips whose states the caller keeps, for the page: frames in, labelled frames, tracks and a state out.

import type { ClipChange, ClipFrame, Pixels, Segmentation } from '../../../types/index.js';
import { reading } from '../../common/checks.js';
import { cancelled } from '../../common/errors.js';
import { Frames } from '../clip/frames.js';
import { Tracks } from '../clip/tracks.js';
import type { Places } from '../places.js';
import type { Home } from '../session/clip.js';
import type { ClipOptions, ClipSource, SegmentedClip } from './types.js';

/** The results of a clip besides its frames. */
export interface ClipResults {
  tracks: Tracks;
  state?: Uint8Array;
  /** The changes by annotations. */
  changes?: ClipChange[];
}

/** `house` finds a home for the clip. Arguments are checked when the first frame is requested, as generators do. */
export function segmentedClip(frames: ClipSource, options: ClipOptions | undefined, house: () => Home, places?: Places): SegmentedClip {
  const results: ClipResults = { tracks: new Tracks() };
  const rest = {
    tracks: () => results.tracks.value(),
    state: async () => results.state?.slice(),
    changes: async () => structuredClone(results.changes ?? []),
  };
  return Object.assign(segmented(frames, options, house, places, results), rest);
}

async function* segmented(
  frames: ClipSource,
  options: ClipOptions | undefined,
  house: () => Home,
  places: Places | undefined,
  results: ClipResults,
): AsyncGenerator<ClipFrame, void, undefined> {
  const [{ checkedOptions }, { PlacedClip }, { segmentedTwice }] = await Promise.all([
    import('./options.js'),
    import('./place.js'),
    import('./whole.js'),
  ]);
  const task = reading(() => checkedOptions(frames, options));
  const { signal, source, settings } = task;
  if (signal?.aborted) throw cancelled(signal);
  const home = house();
  const clip = new PlacedClip(home, signal);
  try {
    await clip.begin(task.settings);
    const taken = new Frames(task, places);
    yield* segmentedTwice(clip, taken, task, results);
    const { tracks, changes = [] } = results;
    const isFound = !task.changesOnly && !task.accepted && task.edits.numbers.size + changes.length === 0;
    if (isFound && settings['motions'] !== 1 && (tracks.isEmpty || tracks.grounds().length > 0)) {
      const { notesOn } = await import('../clip/notes.js');
      const segment = (first: Pixels, second: Pixels) =>
        home.perform({ call: 'segmentPair', frames: [first, second], settings: { quality: 'fast' } }, { signal }) as Promise<Segmentation>;
      tracks.notes = await notesOn(tracks, { length: source.length, read: (index) => taken.one(source.read, index), segment });
    }
  } finally {
    // Nobody waits for that.
    void clip.end();
  }
}
