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
  /** Of the frame in the clip. */
  readonly index: number;
  readonly image: string;
  /** The name of the frame's own files, without extension. */
  readonly stem: string;
}

export interface ClipExport {
  readonly clip: Clip;
  /** The objects that are exported. */
  readonly objects: readonly Life[];
  readonly count: number;
  /** The names of the frames' own files, without extension. */
  readonly stems: readonly string[];
  readonly meta: ClipMeta & { readonly clip: string; readonly names: Readonly<Record<number, string>>; readonly labels: readonly number[] };
  /** The frames in their order, each made when it is asked for. */
  frames(): AsyncGenerator<ClipFile, void, undefined>;
}

/** A format of clips. It makes files by name: one is saved as it is, several as an archive. */
export interface ClipFormat {
  readonly id: string;
  readonly title: string;
  readonly hint: string;
  /** The names of all files that `make` gives, in their order. */
  names(exported: ClipExport): readonly string[];
  make(exported: ClipExport): Promise<Record<string, string | Uint8Array | Blob>>;
  /** What a frame looks like, if the file itself cannot show it. */
  picture?(exported: ClipExport): Promise<Blob>;
}

/** `told` is called when a frame has been made. */
export function exportOfClip(tracked: Tracked, look: Look, told: (done: number, of: number) => void = () => undefined): ClipExport {
  const frames = framesOf(tracked);
  return exportOfFrames(tracked, look, 0, frames.length, told);
}

/** One frame of {@link exportOfClip}; `null` if it is not in it. */
export function exportOfFrame(tracked: Tracked, look: Look, index: number): ClipExport | null {
  return index < framesOf(tracked).length ? exportOfFrames(tracked, look, index, index + 1, () => undefined) : null;
}

/** The frames with masks, up to the first without. */
function framesOf({ frames }: Tracked): readonly TrackedFrame[] {
  const end = frames.indexOf(null);
  return (end < 0 ? frames : frames.slice(0, end)) as readonly TrackedFrame[];
}

/** The frames from `from` up to, but not including, `to`. The objects are those of all frames. */
function exportOfFrames(tracked: Tracked, look: Look, from: number, to: number, told: (done: number, of: number) => void): ClipExport {
  const { clip } = tracked;
  const all = framesOf(tracked);
  const frames = all.slice(from, to);
  const objects = livesOf({ frames: all }).filter(({ id }) => !look.hidden.has(id));
  const names = Object.fromEntries(objects.map(({ id }) => [id, tracked.names[keyOf('objects', id)] ?? CLASS]));
  const wanted = new Set(objects.map(({ id }) => id));
  return {
    clip,
    objects,
    count: frames.length,
    stems: frames.map((_, k) => stemOf(clip.nameOf(from + k))),
    meta: {
      clip: stemOf(clip.name).replace(/[\\/:*?"<>|#]/g, '_'),
      names,
      labels: [...wanted],
      tracked: true,
      ...(clip.times === null ? {} : { timestamps: [...clip.times.subarray(from, to)].map((time) => time - clip.times![0]!) }),
    },
    async *frames() {
      for (const [k, frame] of frames.entries()) {
        const { labels, motions, width, height } = atSize(segmentationOf(frame), clip);
        const image = clip.nameOf(from + k);
        const kept = labels.map((label) => (wanted.has(label) || label === UNLABELLED ? label : 0));
        // An object that is not seen in the next frame has no motion.
        const moving = new Set(frame.objects.filter(({ id, matrix }) => matrix !== null && wanted.has(id)).map(({ id }) => id));
        if (frame.background !== null) moving.add(0);
        yield { index: from + k, labels: kept, width, height, image, stem: stemOf(image), motions: motions.filter(({ label }) => moving.has(label)) };
        told(k + 1, frames.length);
        // The page stays responsive between frames.
        await new Promise((resolve) => setTimeout(resolve));
      }
    },
  };
}

function stemOf(name: string): string {
  return name.replace(/\.[^./]*$/, '');
}
