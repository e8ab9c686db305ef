//! The masks of a clip as they are exported: one frame after another at the size of the file, with the objects that are ticked.

import type { LabelFrame, Metadata } from 'veronese/formats';
import type { Clip } from '../clips/clip.js';
import { inFileNames } from '../common/naming.js';
import { UNLABELLED } from '../result/masks.js';
import type { State } from '../state/state.js';
import { type Life, type Tracked, livesOf, objectsOf } from '../state/tracked.js';
import { atSize } from './full-size.js';

/** The class of objects that have neither a class nor a name, as of `veronese convert`. */
const CLASS = 'object';

export interface ClipFile extends LabelFrame {
  /** Of the frame in the clip. */
  readonly index: number;
  readonly image: string;
  /** The name of the frame's own files, without extension. */
  readonly stem: string;
}

/** Frames in their order, and the facts about all of them. */
interface Sequence {
  readonly meta: Metadata & { readonly clip: string; readonly names: Readonly<Record<number, string>>; readonly labels: readonly number[] };
  /** The frames in their order, each made when it is asked for. */
  frames(): AsyncGenerator<ClipFile, void, undefined>;
}

/** The frames that have masks. */
export interface ClipExport extends Sequence {
  readonly clip: Clip;
  /** The objects that are exported. */
  readonly objects: readonly Life[];
  readonly count: number;
  /** The names of the frames' own files, without extension. */
  readonly stems: readonly string[];
  /** The same with all frames from the first of the clip on, without objects in those that have no masks: for formats that count the frames. */
  readonly fromStart: Sequence;
}

/** A format of clips. It makes files by name: one is saved as it is, several as an archive. */
export interface ClipFormat {
  readonly id: string;
  readonly title: string;
  readonly hint: string;
  /** The names of all files that `make` gives, in their order. */
  names(exported: ClipExport): readonly string[] | Promise<readonly string[]>;
  make(exported: ClipExport): Promise<Record<string, string | Uint8Array | Blob>>;
  /** A picture of a frame, if the file itself cannot show it. */
  picture?(exported: ClipExport): Promise<Blob>;
}

/** Which objects are ticked, and the list of classes. */
type Shown = Pick<State, 'look' | 'classList'>;

/** The frames that have masks. `onFrame` is called when a frame has been made. */
export function exportOfClip(tracked: Tracked, shown: Shown, onFrame: (done: number, of: number) => void = () => undefined): ClipExport {
  return exportOfFrames(tracked, shown, [...tracked.frames.keys()].filter((index) => tracked.frames[index] !== null), onFrame);
}

/** One frame of {@link exportOfClip}; `null` if it has no masks. */
export function exportOfFrame(tracked: Tracked, shown: Shown, index: number): ClipExport | null {
  return (tracked.frames[index] ?? null) === null ? null : exportOfFrames(tracked, shown, [index], () => undefined);
}

/** The objects are those of all frames. */
function exportOfFrames(tracked: Tracked, { look, classList }: Shown, indices: readonly number[], onFrame: (done: number, of: number) => void): ClipExport {
  const { clip, frames } = tracked;
  const count = indices.length;
  const objects = livesOf(tracked).filter(({ id }) => !look.hidden.has(id));
  const names = Object.fromEntries(objects.map(({ id }) => [id, classOf(tracked, id)]));
  const wanted = new Set(objects.map(({ id }) => id));
  const sequence = (exported: readonly number[]): Sequence => ({
    meta: {
      clip: inFileNames(clip.name),
      names,
      ...(classList.length > 0 && { classes: classList }),
      labels: [...wanted],
      tracked: true,
      ...(clip.times === null ? {} : { timestamps: exported.map((index) => clip.times![index]! - clip.times![exported[0]!]!) }),
    },
    async *frames() {
      for (const index of exported) {
        const image = clip.nameOf(index);
        const named = { index, image, stem: stemOf(image) };
        const at = indices.indexOf(index);
        const frame = at < 0 ? null : (frames[index] ?? null);
        if (frame === null) {
          const { width, height } = clip;
          yield { ...named, labels: new Uint8Array(width * height), width, height };
          continue;
        }
        const full = atSize(frame, clip);
        const labels = full.labels.map((label) => (wanted.has(label) || label === UNLABELLED ? label : 0));
        yield { ...full, ...named, labels, objects: full.objects.filter(({ id }) => wanted.has(id)) };
        onFrame(at + 1, count);
        // The page stays responsive between frames.
        await new Promise((resolve) => setTimeout(resolve));
      }
    },
  });
  const stems = indices.map((index) => stemOf(clip.nameOf(index)));
  const fromStart = Array.from({ length: (indices.at(-1) ?? -1) + 1 }, (_, index) => index);
  return { clip, objects, count, stems, ...sequence(indices), fromStart: sequence(fromStart) };
}

/** Without a class, the name of an object is its category. */
function classOf(tracked: Tracked, id: number): string {
  const { class: named = '', name = '' } = objectsOf(tracked).get(id) ?? {};
  return named || name || CLASS;
}

function stemOf(name: string): string {
  return name.replace(/\.[^./]*$/, '');
}
