// A clip whose frames come once.

import type { ClipFrame, Pixels } from '../../../types/index.js';
import { cancelled } from '../../common/errors.js';
import type { ClipEnd, LabelledFrame } from '../messages.js';
import type { CheckedOptions, Stream } from './options.js';
import { checkCount, type Frames } from './frames.js';
import type { PlacedClip } from './place.js';
import type { ClipResults } from './tracks.js';

/** If the source fails, the frames before come first. */
export async function* streamed(
  clip: PlacedClip,
  frames: Frames,
  { source, signal, transfer, onProgress, settings }: CheckedOptions,
  results: ClipResults,
): AsyncGenerator<ClipFrame, void, undefined> {
  const { each, length: of, again } = source as Stream;
  const { tracks } = results;
  let index = 0;
  let first: Pixels | undefined;
  for await (const frame of frames.each(each, { transfer })) {
    onProgress?.({ frame: index, of, stage: 'pairs' });
    const isFirst = (index & (index - 1)) === 0;
    if (!tracks.isEmpty) delete results.pair;
    else if (!again && (isFirst || first)) {
      const copy = { ...frame, data: frame.data.slice() };
      if (first) results.pair = { index: index - 1, frames: [first, copy] };
      first = isFirst ? copy : undefined;
    }
    index += 1;
    const step = clip.step<LabelledFrame | undefined>({ call: 'pushClip', frame });
    frames.ahead();
    const done = await step;
    if (done) yield tracks.see(done, frame);
  }
  // A live stream may end at any time: its frames were answered as they came.
  if (!frames.failure && settings['lookAhead'] !== 0) checkCount(index);
  const { frames: rest, dropped } = await clip.step<ClipEnd>({ call: 'finishClip' });
  for (const frame of rest) {
    if (signal?.aborted) throw cancelled(signal);
    yield tracks.see(frame, frames.size as Pixels);
  }
  tracks.end(dropped);
  if (frames.failure) throw frames.failure.thrown;
}
