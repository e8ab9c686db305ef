// A clip whose frames come once: each is labelled when the frames that it waits for have come.

import type { ClipFrame, ClipStream, Pixels, StreamOptions, StreamSource } from '../../types/index.js';
import { entriesOf, invalidInput, reading } from '../common/checks.js';
import { cancelled, VeroneseError } from '../common/errors.js';
import { checkCount, Frames } from './clip/frames.js';
import { type SeenPair, Tracks } from './clip/tracks.js';
import type { LabelledFrame, StreamEnd, StreamTask } from './messages.js';
import type { Places } from './places.js';
import type { Home } from './session/clip.js';
import { parted } from './tasks.js';

const OPTIONS = ['motions', 'quality', 'markUnknown', 'subject', 'lookAhead', 'maxSize'];
/** Default look-ahead, frames: the longest there is. */
const LOOK_AHEAD = 8;

/** Number of streams so far: each number is used once. */
let streams = 0;

/** The stream of frames in a home, which is had when the first frame is asked for. Arguments are checked then, as generators do. */
export function streamOf(
  frames: StreamSource,
  options: StreamOptions | undefined,
  house: () => Home,
  places: Places | undefined,
): ClipStream {
  const results: StreamResults = { tracks: new Tracks() };
  const stream = Object.assign(streamed(frames, options, house, places, results), { tracks: () => results.tracks.value() });
  dropped.register(stream, results);
  return stream;
}

/** The results of a stream besides its frames, and what frees it until it ends. */
interface StreamResults {
  tracks: Tracks;
  /** While nothing was found: the latest pair whose first frame has 0 or a power of two as its index. */
  pair?: SeenPair;
  end?: () => void;
}

/** Ends streams that were dropped before their end. */
const dropped = new FinalizationRegistry<StreamResults>(({ end }) => end?.());

async function* streamed(
  source: StreamSource,
  options: StreamOptions | undefined,
  house: () => Home,
  places: Places | undefined,
  results: StreamResults,
): AsyncGenerator<ClipFrame, void, undefined> {
  const { call, transfer, maxSize, settings } = reading(() =>
    parted(entriesOf(options, [...OPTIONS, 'signal', 'onProgress', 'transfer']), OPTIONS),
  );
  const isIterable = reading(() => {
    const { [Symbol.asyncIterator]: asynchronous, [Symbol.iterator]: synchronous } = Object(source) as Partial<
      AsyncIterable<unknown> & Iterable<unknown>
    >;
    return typeof asynchronous === 'function' || typeof synchronous === 'function';
  });
  if (!isIterable) throw invalidInput('the frames must be an iterable or async iterable of pixels');
  const { signal } = call;
  const onProgress = call.onProgress as StreamOptions['onProgress'];
  if (signal?.aborted) throw cancelled(signal);
  const home = house();
  const stream = streams++;
  let isOpen = true;
  const end = (results.end = () => {
    delete results.end;
    // Nobody waits for that.
    if (isOpen) home.perform({ call: 'finishStream', stream }, {}).then(home.release, home.release);
    else home.release();
  });
  const step = async <T>(task: StreamTask): Promise<T> => {
    if (signal?.aborted) throw cancelled(signal);
    const result = await home.perform(task, { signal });
    if (result === null) throw new VeroneseError('internal', 'the stream was lost when another call failed');
    return result as T;
  };
  try {
    await step({ call: 'beginStream', stream, settings: { lookAhead: LOOK_AHEAD, ...settings } });
    const { tracks } = results;
    const taken = new Frames({ signal, maxSize }, places);
    const observe = observer(tracks, results);
    let index = 0;
    for await (const frame of taken.each(source as Iterable<unknown>, { transfer })) {
      onProgress?.({ frame: index });
      observe(index++, frame);
      const pushed = step<LabelledFrame | undefined>({ call: 'pushStream', stream, frame });
      taken.ahead();
      const found = await pushed;
      if (found) yield tracks.see(found, frame);
    }
    // A live stream may end at any time: its frames were answered as they came.
    if (!taken.failure && settings['lookAhead'] !== 0) checkCount(index);
    const { frames, dropped } = await step<StreamEnd>({ call: 'finishStream', stream });
    isOpen = false;
    for (const frame of frames) {
      if (signal?.aborted) throw cancelled(signal);
      yield tracks.see(frame, taken.size as Pixels);
    }
    tracks.end(dropped);
    if (taken.failure) throw taken.failure.thrown;
    if (settings['motions'] !== 1 && (tracks.isEmpty || tracks.grounds().length > 0)) {
      const { notesOn } = await import('./clip/notes.js');
      tracks.notes = await notesOn(tracks, undefined, results.pair);
    }
  } finally {
    end();
  }
}

/** Keeps a pair of neighbours while nothing is found. */
function observer(tracks: Tracks, results: StreamResults): (index: number, frame: Pixels) => void {
  let first: Pixels | undefined;
  return (index, frame) => {
    const isFirst = (index & (index - 1)) === 0;
    if (!tracks.isEmpty) delete results.pair;
    else if (isFirst || first) {
      const copy = { ...frame, data: frame.data.slice() };
      if (first) results.pair = { index: index - 1, frames: [first, copy] };
      first = isFirst ? copy : undefined;
    }
  };
}
