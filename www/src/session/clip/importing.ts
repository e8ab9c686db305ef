//! Masks from files of annotation tools, taken as corrections of the frames that they are of. Loaded on first use, with its texts.

import { readAnnotations } from 'veronese/formats';
import { PageError } from '../../common/errors.js';
import { strings } from '../../common/strings.js';
import { packed, resized, unpacked } from '../../correction/runs.js';
import { UNLABELLED } from '../../result/masks.js';
import { pathOf, selectOpenable } from '../../frames/files.js';
import { MOST_OBJECTS, spanAt } from '../../state/spans.js';
import type { State, Store } from '../../state/state.js';
import type { Painted } from '../../state/annotation.js';
import type { Tracked } from '../../state/tracked.js';
import { report } from '../failures.js';
import type { Shown } from '../shown.js';
import type { Objects } from './objects.js';

interface Size {
  readonly width: number;
  readonly height: number;
}

const texts = {
  taken: (taken: number, left: readonly string[]): string =>
    `Took the masks of ${taken} of ${taken + left.length} frames. No frame with masks here is called ${listed(left)}.`,
  none: (left: readonly string[]): string => `No frame with masks here is called ${listed(left)}.`,
  otherSize: (name: string, other: Size, all: Size): string =>
    `The masks of “${name}” are ${strings.size(other.width, other.height)}, the frames ${strings.size(all.width, all.height)}.`,
};

/** The first names, and how many others there are. */
function listed(names: readonly string[]): string {
  return `${names.slice(0, 3).join(', ')}${names.length > 3 ? ` and ${names.length - 3} others` : ''}`;
}

/** Annotations of other kinds than pictures, and what is beside them, names of classes. */
const ANNOTATIONS = /\.(json|xml|zip)$|^gt\.txt$/i;
const NO_PICTURES = /\.(json|xml|zip|txt)$/i;
/** Of the header of a PNG: the place of its colour type, and that of indices into a palette. */
const PNG = { colourType: 25, indexed: 3 };
/** The class of objects that were given none. */
const CLASS = 'object';

/** Whether files are masks, and no frames: annotations without images, or indexed PNG files called as the frames of the clip are. */
export async function areMasks(files: readonly File[], { tracked }: State): Promise<boolean> {
  const { project, video, images } = selectOpenable(files);
  const pictures = images.filter(({ name }) => !NO_PICTURES.test(name));
  if (tracked === null || project !== null || video !== null) return false;
  if (pictures.length === 0) return files.some(({ name }) => ANNOTATIONS.test(name));
  const stems = new Set(stemsOf(tracked).map(keyOf));
  if (!pictures.every(({ name }) => /\.png$/i.test(name) && stems.has(keyOf(stemOf(name))))) return false;
  const [type] = new Uint8Array(await pictures[0]!.slice(PNG.colourType, PNG.colourType + 1).arrayBuffer());
  return type === PNG.indexed;
}

/** One step of undo. What cannot be taken ends as a notice. */
export async function importMasks(files: readonly File[], store: Store, objects: Objects, shown: Shown): Promise<void> {
  const { tracked } = store.get();
  if (tracked === null || tracked.spans.length === 0) return store.say(strings.notices.notReady);
  try {
    const { painted, classes, left } = await masksFrom(files, tracked);
    if (store.get().tracked?.clip !== tracked.clip) return; // left meanwhile
    shown.kind('objects');
    void objects.carrying.correct({ annotations: mapsOf(painted, tracked), notes: objects.withClasses(classes) });
    if (left.length > 0) store.say(texts.taken(painted.size, left));
  } catch (error) {
    report(store, error);
  }
}

/** Label maps of frames, without what is locked. */
function mapsOf(painted: Imported['painted'], { frames, locked }: Tracked): Painted[] {
  return [...painted].flatMap(([frame, all]) => {
    const { width, height } = frames[frame]!.runs;
    return { frame, object: 0, propagate: 'both', labels: packed(all.map((label) => (locked.has(label) ? UNLABELLED : label)), width, height) };
  });
}

interface Imported {
  /** Labels by index of the frame: numbers of objects here, and 255 where that is left open. */
  readonly painted: ReadonlyMap<number, Uint8Array>;
  readonly classes: ReadonlyMap<number, string>;
  /** Frames of the files that have no masks here, by name. */
  readonly left: readonly string[];
}

/** Throws the package's errors, or a {@link PageError} if no frame is one of the clip's or the sizes differ. */
async function masksFrom(files: readonly File[], tracked: Tracked): Promise<Imported> {
  const { clip, frames, spans } = tracked;
  const read = async (file: File) => ({ name: pathOf(file).join('/'), bytes: new Uint8Array(await file.arrayBuffer()) });
  const stems = stemsOf(tracked);
  const found = readAnnotations(await Promise.all(files.map(read)), { frames: stems });
  const indices = new Map(stems.map((stem, index) => [keyOf(stem), index]));
  const numbers = numbersFor(tracked);
  const [painted, left] = [new Map<number, Uint8Array>(), [] as string[]];
  for (const [name, frame] of found.frames) {
    const index = indices.get(keyOf(name)) ?? -1;
    const runs = frames[index]?.runs;
    if (runs === undefined || spanAt(spans, index) === null) {
      left.push(name);
      continue;
    }
    const fits = frame.width === clip.width && frame.height === clip.height;
    if (!fits) throw new PageError('frame-size-mismatch', texts.otherSize(name, frame, clip));
    const labels = resized(packed(frame.read(), clip.width, clip.height), runs);
    painted.set(index, unpacked(labels).map((label) => numbers[label]!));
    // The page stays responsive between frames.
    await new Promise((resolve) => setTimeout(resolve));
  }
  if (painted.size === 0) throw new PageError('invalid-input', texts.none(left));
  const given = Object.entries(found.names).filter(([, name]) => name !== CLASS);
  return { painted, left, classes: new Map(given.map(([label, name]) => [numbers[Number(label)]!, name])) };
}

/** The number of an object here by that in a file. One that was merged goes on in the other; one that was deleted is a new object. */
function numbersFor({ became, largest }: Tracked): Uint8Array {
  const numbers = Uint8Array.from({ length: 256 }, (_, label) => became.get(label) ?? label);
  let next = largest;
  for (const [id, into] of became) if (into === 0 && next < MOST_OBJECTS) numbers[id] = ++next;
  return numbers;
}

function stemsOf({ clip }: Tracked): string[] {
  return Array.from({ length: clip.count }, (_, index) => stemOf(clip.nameOf(index)));
}

/** A name without folder and extension. */
function stemOf(name: string): string {
  return name.replace(/^.*\//, '').replace(/(?<=.)\.[^.]*$/, '');
}

/** Names with the same key are one file on some systems. */
function keyOf(name: string): string {
  return name.normalize('NFC').toLowerCase();
}
