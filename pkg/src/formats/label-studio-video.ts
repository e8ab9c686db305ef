// A Label Studio task with boxes on a video: a sequence of key frames per label, in percentages, frames from 1.

import type { ClipMeta, Encoded, LabelFrames, LabelStudioVideoTask } from '../../types/formats.js';
import { gathered, type Gathering } from './frames.js';
import { checkedOptions, type Mask } from './input.js';

/** Names of the labelling configuration, and who made the prediction. */
const NAMES = { fromName: 'box', toName: 'video', modelVersion: 'veronese' };

type Sequence = LabelStudioVideoTask['predictions'][number]['result'][number]['value']['sequence'];

export function encodeLabelStudioVideo<Frames extends LabelFrames>(
  frames: Frames,
  meta?: ClipMeta,
  options?: Partial<typeof NAMES>,
): Encoded<Frames, LabelStudioVideoTask> {
  const { fromName, toName, modelVersion } = checkedOptions(options, [], NAMES);
  return gathered(frames, meta, (clip): Gathering<LabelStudioVideoTask> => {
    const tracks = new Map<number, { name: string; sequence: Sequence }>();
    return {
      add({ index, width, height, masks }) {
        for (const mask of masks) {
          const track = tracks.get(mask.label) ?? { name: mask.name, sequence: [] };
          tracks.set(mask.label, track);
          // Until the next frame shows whether it goes on; boxes between two key frames are interpolated otherwise.
          const last = track.sequence.at(-1);
          if (last) last.enabled = last.frame === index;
          track.sequence.push({ frame: index + 1, enabled: true, rotation: 0, ...shares(mask, width, height), time: clip.time(index) });
        }
      },
      finish({ length }) {
        const duration = clip.duration(length);
        const result = [...tracks].sort(([a], [b]) => a - b).map(([label, { name, sequence }]) => {
          const last = sequence.at(-1);
          if (last) last.enabled = last.frame === length;
          const value = { framesCount: length, duration, labels: [name], sequence };
          return { id: `object-${label}`, type: 'videorectangle' as const, from_name: fromName, to_name: toName, value };
        });
        return { data: { video: clip.name }, predictions: [{ model_version: modelVersion, result }] };
      },
    };
  });
}

function shares({ left, top, width, height }: Mask, imageWidth: number, imageHeight: number) {
  const [x, y] = [(value: number) => (100 * value) / imageWidth, (value: number) => (100 * value) / imageHeight];
  return { x: x(left), y: y(top), width: x(width), height: y(height) };
}
