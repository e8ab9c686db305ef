//! The masks of a clip as they are exported: one frame after another at the size of the file, with the objects that are ticked.

import type { ClipMeta, LabelFrame } from 'veronese/formats';
import type { Clip } from '../clips/clip.js';
import { UNLABELLED, keyOf } from '../result/masks.js';
import { segmentationOf } from '../state/objects.js';
import type { Look } from '../state/state.js';
import { type Life, type Tracked, type TrackedFrame, livesOf } from '../state/tracked.js';
import { atSize } from './full-size.js';

/** The class of objects without a name of their own, as of `veronese convert`. */
const CLASS = 'object';

export interface ClipFile extends LabelFrame {
  readonly image: string;
  /** The name of the frame's own files, without extension. */
  readonly stem: string;
}

export interface ClipExport {
  readonly clip: Clip;
  /** The objects that are exported. */
  readonly objects: readonly Life[];
  readonly count: number;
  readonly meta: ClipMeta & { readonly clip: string; readonly names: Readonly<Record<number, string>>; readonly labels: readonly number[] };
  /** The frames in their order, each made when it is asked for. */
  frames(): AsyncGenerator<ClipFile, void, undefined>;
}

/** A format of clips. It makes files by name: one is saved as it is, several as an archive. */
export interface ClipFormat {
  readonly id: string;
  readonly title: string;
  readonly hint: string;
  make(exported: ClipExport): Promise<Record<string, string | Uint8Array>>;
}

/** `told` is called when a frame has been made. */
export function exportOfClip(tracked: Tracked, look: Look, told: (done: number, of: number) => void): ClipExport {
  const { clip } = tracked;
  const end = tracked.frames.indexOf(null);
  const frames = (end < 0 ? tracked.frames : tracked.frames.slice(0, end)) as readonly TrackedFrame[];
  const objects = livesOf({ frames }).filter(({ id }) => !look.hidden.has(id));
  const names = Object.fromEntries(objects.map(({ id }) => [id, tracked.names[keyOf('objects', id)] ?? CLASS]));
  const wanted = new Set(objects.map(({ id }) => id));
  return {
    clip,
    objects,
    count: frames.length,
    meta: {
      clip: stemOf(clip.name).replace(/[\\/:*?"<>|#]/g, '_'),
      names,
      labels: [...wanted],
      tracked: true,
      ...(clip.times === null ? {} : { timestamps: [...clip.times.subarray(0, frames.length)].map((time) => time - clip.times![0]!) }),
    },
    async *frames() {
      for (const [index, frame] of frames.entries()) {
        const { labels, motions, width, height } = atSize(segmentationOf(frame), clip);
        const image = clip.nameOf(index);
        const kept = labels.map((label) => (wanted.has(label) || label === UNLABELLED ? label : 0));
        // An object that is not seen in the next frame has no motion.
        const moving = new Set(frame.objects.filter(({ id, matrix }) => matrix !== null && wanted.has(id)).map(({ id }) => id));
        if (frame.background !== null) moving.add(0);
        yield { labels: kept, width, height, image, stem: stemOf(image), motions: motions.filter(({ label }) => moving.has(label)) };
        told(index + 1, frames.length);
        // The page stays responsive between frames.
        await new Promise((resolve) => setTimeout(resolve));
      }
    },
  };
}

function stemOf(name: string): string {
  return name.replace(/\.[^./]*$/, '');
}
