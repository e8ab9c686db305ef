// A Label Studio task with boxes on a video: a sequence of key frames per label, in percentages, frames from 1.

import { type Encoder, json } from './frames.js';
import type { Mask } from './masks.js';
import type { Settings } from './metadata.js';

interface KeyFrame extends ReturnType<typeof shares> {
  /** From 1. */
  frame: number;
  /** False where the object is gone in the next frame; boxes between two key frames are interpolated otherwise. */
  enabled: boolean;
  rotation: 0;
  /** Seconds. */
  time: number;
}

export function labelStudioVideo({ clip, fromName = 'box', toName = 'video', modelVersion, time, duration }: Settings): Encoder {
  const tracks = new Map<number, { name: string; sequence: KeyFrame[] }>();
  return {
    add({ index, width, height, masks }) {
      for (const mask of masks) {
        const track = tracks.get(mask.label) ?? { name: mask.name, sequence: [] };
        tracks.set(mask.label, track);
        leave(track.sequence, index);
        track.sequence.push({ frame: index + 1, enabled: true, rotation: 0, ...shares(mask, width, height), time: time(index) });
      }
    },
    finish({ length }) {
      const result = [...tracks]
        .sort(([a], [b]) => a - b)
        .map(([label, { name, sequence }]) => {
          leave(sequence, length);
          const value = { framesCount: length, duration: duration(length), labels: [name], sequence };
          return { id: `object-${label}`, type: 'videorectangle', from_name: fromName, to_name: toName, value };
        });
      return [json('label-studio-video.json', [{ data: { video: clip }, predictions: [{ model_version: modelVersion, result }] }])];
    },
  };
}

/** The next frame shows whether the last box goes on. */
function leave(sequence: readonly KeyFrame[], index: number): void {
  const last = sequence.at(-1);
  if (last) last.enabled = last.frame === index;
}

function shares({ left, top, width, height }: Mask, imageWidth: number, imageHeight: number) {
  const [x, y] = [(value: number) => (100 * value) / imageWidth, (value: number) => (100 * value) / imageHeight];
  return { x: x(left), y: y(top), width: x(width), height: y(height) };
}
