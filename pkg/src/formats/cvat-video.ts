// "CVAT for video 1.1": one <track> per label with a shape for each frame. CVAT does not track masks: a mask is one polygon.

import type { ClipMeta, Encoded, FormatOptions, LabelFrames } from '../../types/formats.js';
import { cvatHead, cvatPoints } from './cvat-xml.js';
import { gathered, type Gathering } from './frames.js';
import { checkedOptions, type Mask } from './input.js';
import { Outlines, type Ring } from './outline.js';
import { escaped } from './xml.js';

interface Track {
  name: string;
  shapes: string[];
  /** The last frame it was seen in, and its shape there. */
  frame: number;
  shape: string;
}

export function encodeCvatVideo<Frames extends LabelFrames>(
  frames: Frames,
  meta?: ClipMeta,
  options?: FormatOptions<'polygon' | 'box'>,
): Encoded<Frames, string> {
  const { shape, tolerance } = checkedOptions(options, ['polygon', 'box']);
  return gathered(frames, meta, ({ name, classes = [] }): Gathering<string> => {
    const outlines = new Outlines(tolerance, 'clip');
    const tracks = new Map<number, Track>();
    return {
      add({ index, masks, width, height }) {
        const rings = shape === 'box' ? [] : outlines.singles({ masks, width, height });
        for (const [at, mask] of masks.entries()) {
          const track: Track = tracks.get(mask.label) ?? { name: mask.name, shapes: [], frame: index, shape: '' };
          tracks.set(mask.label, track);
          leave(track, index, shape);
          track.shape = shape === 'box' ? corners(mask) : `points="${cvatPoints(rings[at] as Ring)}"`;
          track.frame = index;
          track.shapes.push(element(shape, index, track.shape, false));
        }
      },
      finish({ width, height, length }) {
        const all = [...tracks].sort(([a], [b]) => a - b);
        for (const [, track] of all) leave(track, length, shape);
        const size = `<original_size><width>${width}</width><height>${height}</height></original_size>`;
        return [
          ...cvatHead('interpolation', length, [...classes, ...all.map(([, track]) => track.name)], [size, `<source>${escaped(name)}</source>`]),
          ...all.flatMap(([label, track]) => [
            `  <track id="${label}" label="${escaped(track.name)}" source="auto">`,
            ...track.shapes,
            '  </track>',
          ]),
          '</annotations>',
          '',
        ].join('\n');
      },
    };
  });
}

/** Where the track was not seen in the frame before `index`, it leaves after the last one that it was seen in. */
function leave(track: Track, index: number, shape: 'polygon' | 'box'): void {
  if (track.frame + 1 < index) track.shapes.push(element(shape, track.frame + 1, track.shape, true));
}

function element(shape: 'polygon' | 'box', frame: number, place: string, outside: boolean): string {
  return `    <${shape} frame="${frame}" keyframe="1" outside="${Number(outside)}" occluded="0" ${place} z_order="0"></${shape}>`;
}

function corners({ left, top, width, height }: Mask): string {
  return `xtl="${left}.00" ytl="${top}.00" xbr="${left + width}.00" ybr="${top + height}.00"`;
}
