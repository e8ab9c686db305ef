// "CVAT for video 1.1": one <track> per label with a shape for each frame. CVAT does not track masks: a mask is one polygon.

import { cvatDocument, cvatPoints, escaped } from './cvat-images.js';
import type { Encoder } from './frames.js';
import type { Mask } from './masks.js';
import type { Settings } from './metadata.js';
import { Outlines, type Ring } from './outline.js';

interface Track {
  name: string;
  shapes: string[];
  /** The last frame it was seen in, and its shape there. */
  frame: number;
  shape: string;
}

export function cvatVideo({ clip, classes, shape, tolerance }: Settings): Encoder {
  const outlines = new Outlines(tolerance, 'clip');
  const tracks = new Map<number, Track>();
  return {
    add(frame) {
      const { index, masks } = frame;
      const rings = shape === 'box' ? [] : outlines.singles(frame);
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
      const names = [...classes, ...all.map(([, track]) => track.name)];
      const elements = all.flatMap(([label, track]) => [
        `  <track id="${label}" label="${escaped(track.name)}" source="auto">`,
        ...track.shapes,
        '  </track>',
      ]);
      const content = cvatDocument('interpolation', length, names, [size, `<source>${escaped(clip)}</source>`], elements);
      return [{ name: 'cvat-video.xml', content }];
    },
  };
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
