// A clip whose frames come once.

import type { ClipFrame } from '../../../types/index.js';
import { cancelled } from '../../common/errors.js';
import type { ClipEnd } from '../messages.js';
import type { CheckedOptions, Stream } from './options.js';
import type { Frames } from './frames.js';
import type { PlacedClip } from './place.js';
import type { Tracks } from './tracks.js';

/** If the source fails, the frames before come first. */
export async function* streamed(
  clip: PlacedClip,
  frames: Frames,
  { source, signal, transfer, onProgress }: CheckedOptions,
  tracks: Tracks,
): AsyncGenerator<ClipFrame, void, undefined> {
  const { each, length: of } = source as Stream;
  let index = 0;
  for await (const frame of frames.each(each, { transfer })) {
    onProgress?.({ frame: index++, of, stage: 'pairs' });
    const step = clip.step<ClipFrame | undefined>({ call: 'pushClip', frame });
    frames.ahead();
    const done = await step;
    if (done) yield tracks.add(done);
  }
  const { frames: rest, dropped } = await clip.step<ClipEnd>({ call: 'finishClip' });
  for (const frame of rest) {
    if (signal?.aborted) throw cancelled(signal);
    yield tracks.add(frame);
  }
  tracks.end(dropped);
  if (frames.failure) throw frames.failure.thrown;
}
