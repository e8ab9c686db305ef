//! Masks from files of annotation tools, taken as corrections of the frames that they are of. Loaded on first use, with its texts.

import type { ClipAnnotation } from 'veronese';
import { type AnnotationNote, type AnnotationOptions, readAnnotations } from 'veronese/formats';
import { PageError, codeOf, sentenceOf } from '../../common/errors.js';
import { strings, withNotes } from '../../common/strings.js';
import { packed, resized, unpacked } from '../../result/runs.js';
import { UNLABELLED } from '../../result/masks.js';
import { pathOf, selectOpenable } from '../../frames/files.js';
import type { Choice, State, Store } from '../../state/state.js';
import { type Tracked, isReady, lockedIn, takesCorrections } from '../../state/tracked.js';
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
  soft: 'Read as a soft mask, above one half',
  exact: 'Take each level for an object',
  first: 'It is ',
};

/** The first names, and how many others there are. */
function listed(names: readonly string[]): string {
  return `${names.slice(0, 3).join(', ')}${names.length > 3 ? ` and ${names.length - 3} others` : ''}`;
}

/** Annotations of other kinds than pictures, and what is beside them, names of classes. */
const ANNOTATIONS = /\.(json|xml|zip)$|^gt\.txt$/i;
const NO_PICTURES = /\.(json|xml|zip|txt|ya?ml)$/i;
/** The beginning of a text of YOLO: a class, and four numbers or more. */
const YOLO = /^\s*\d+(\s+[\d.e+-]+){4}/;
/** Of the header of a PNG: the place of its colour type, and that of indices into a palette. */
const PNG = { colourType: 25, indexed: 3 };
/** The part of a sentence that names options of the command line, in whose place there are choices. */
const OPTIONS = /(, or|, taken is 1:) say with --.*$/s;
/** The class of objects that were given none. */
const CLASS = 'object';

/** Whether files are masks, and no frames: annotations without images, or indexed PNG files called as the frames of the clip are. */
export async function areMasks(files: readonly File[], { tracked }: State): Promise<boolean> {
  const { project, video, images } = selectOpenable(files);
  const pictures = images.filter(({ name }) => !NO_PICTURES.test(name));
  if (tracked === null || project !== null || video !== null) return false;
  if (pictures.length === 0) {
    const heads = files.filter(({ name }) => /\.txt$/i.test(name)).map((file) => file.slice(0, 200).text());
    return files.some(({ name }) => ANNOTATIONS.test(name)) || (await Promise.all(heads)).some((head) => YOLO.test(head));
  }
  const stems = new Set(stemsOf(tracked).map(keyOf));
  if (!pictures.every(({ name }) => /\.png$/i.test(name) && stems.has(keyOf(stemOf(name))))) return false;
  const [type] = new Uint8Array(await pictures[0]!.slice(PNG.colourType, PNG.colourType + 1).arrayBuffer());
  return type === PNG.indexed;
}

/** How files are to be read that do not tell it themselves. */
type Said = Pick<AnnotationOptions, 'levels' | 'firstFrame'>;

/** One step of undo. What cannot be taken ends as a notice, in which a person can choose how to read what nobody knows. */
export async function importMasks(files: readonly File[], store: Store, objects: Objects, shown: Shown, said: Said = {}): Promise<void> {
  const choice = (label: string, more: Said) => ({ label, choose: () => void importMasks(files, store, objects, shown, { ...said, ...more }) });
  const ask = (sentence: string, code: string | null, choices: readonly Choice[]) => store.say(sentence.replace(OPTIONS, ''), code, choices);
  const { tracked } = store.get();
  if (!isReady(tracked)) return store.say(strings.notices.notReady);
  try {
    const imported = await masksFrom(files, tracked, said);
    const { painted, prompts, classes, left, notes } = imported;
    if (store.get().tracked?.clip !== tracked.clip) return; // left meanwhile
    const unknown = notes.find(({ code }) => code === 'first-frame-assumed');
    if (unknown) return ask(unknown.message, null, ([1, 0] as const).map((firstFrame) => choice(texts.first + firstFrame, { firstFrame })));
    shown.objects();
    const annotations = annotationsOf(imported, tracked);
    const frames = [...new Set(annotations.map(({ frame }) => frame))];
    const reach = tracked.status.filter(({ hasMasks }) => hasMasks).length;
    // One step of undo.
    void objects.living.say((clip) => clip.annotate(...annotations), (clip) => clip, { cause: 'corrected', frames, reach }).then((isDone) => isDone && objects.setClasses(classes, true));
    const taken = new Set([...painted.keys(), ...prompts.map(({ frame }) => frame)]).size;
    const sentence = withNotes(left.length > 0 ? texts.taken(taken, left) : '', notes).trim();
    if (sentence !== '') store.say(sentence);
  } catch (error) {
    const sentence = sentenceOf(error);
    if (!OPTIONS.test(sentence)) return report(store, error);
    ask(sentence, codeOf(error), [choice(texts.soft, { levels: 128 }), choice(texts.exact, { levels: 'exact' })]);
  }
}

/** Label maps and boxes of frames, without what is locked. */
function annotationsOf({ painted, prompts }: Imported, tracked: Tracked): ClipAnnotation[] {
  const locked = lockedIn(tracked);
  const maps = [...painted].map(([frame, all]): ClipAnnotation => ({ frame, labels: all.map((label) => (locked.has(label) ? UNLABELLED : label)) }));
  return [...maps, ...prompts.filter((one) => 'object' in one && !locked.has(one.object))];
}

interface Imported {
  /** Labels by index of the frame: numbers of objects here, and 255 where that is left open. */
  readonly painted: ReadonlyMap<number, Uint8Array>;
  /** Boxes of objects that have no mask there. */
  readonly prompts: readonly ClipAnnotation[];
  readonly classes: ReadonlyMap<number, string>;
  /** Frames of the files that have no masks here, by name. */
  readonly left: readonly string[];
  /** What files were taken for, and what of them was left out. */
  readonly notes: readonly AnnotationNote[];
}

/** Throws the package's errors, or a {@link PageError} if no frame is one of the clip's or the sizes differ. */
async function masksFrom(files: readonly File[], tracked: Tracked, said: Said): Promise<Imported> {
  const { clip, frames } = tracked;
  const read = async (file: File) => ({ name: pathOf(file).join('/'), bytes: new Uint8Array(await file.arrayBuffer()) });
  const stems = stemsOf(tracked);
  const found = readAnnotations(await Promise.all(files.map(read)), { frames: stems, size: { width: clip.width, height: clip.height }, ...said });
  const indices = new Map(stems.map((stem, index) => [keyOf(stem), index]));
  const masked = (name: string) => {
    const index = indices.get(keyOf(name)) ?? -1;
    const runs = frames[index]?.runs;
    return runs === undefined || !takesCorrections(tracked, index) ? null : { index, runs };
  };
  const numbers = numbersFor(tracked);
  const [painted, left] = [new Map<number, Uint8Array>(), new Set<string>()];
  for (const [name, frame] of found.frames) {
    const here = masked(name);
    if (here === null) {
      left.add(name);
      continue;
    }
    const { index, runs } = here;
    const fits = frame.width === clip.width && frame.height === clip.height;
    if (!fits) throw new PageError('frame-size-mismatch', texts.otherSize(name, frame, clip));
    const labels = resized(packed(frame.read(), clip.width, clip.height), runs);
    painted.set(index, unpacked(labels).map((label) => numbers[label]!));
    // The page stays responsive between frames.
    await new Promise((resolve) => setTimeout(resolve));
  }
  const prompts = found.boxes.flatMap(({ frame, object, box: [x, y, width, height] }): ClipAnnotation[] => {
    const here = masked(frame);
    if (here === null) return left.add(frame) && [];
    // Masks can be smaller than frames; a box has at least a pixel of theirs.
    const scale = here.runs.width / clip.width;
    const [column, row] = [Math.floor(x * scale), Math.floor(y * scale)];
    const [right, bottom] = [Math.min(Math.ceil((x + width) * scale), here.runs.width), Math.min(Math.ceil((y + height) * scale), here.runs.height)];
    const box = [column, row, right - column, bottom - row] as const;
    return [{ frame: here.index, object: numbers[object]!, box }];
  });
  if (painted.size === 0 && prompts.length === 0) throw new PageError('invalid-input', texts.none([...left]));
  const given = Object.entries(found.names).filter(([, name]) => name !== CLASS);
  return { painted, prompts, left: [...left], notes: found.notes, classes: new Map(given.map(([label, name]) => [numbers[Number(label)]!, name])) };
}

/** The number of an object here by that in a file. One that was merged goes on in the other; one that was deleted is a new object. */
function numbersFor({ objects }: Tracked): Uint8Array {
  const numbers = Uint8Array.from({ length: 256 }, (_, label) => label);
  let next = Math.max(0, ...objects.map(({ number }) => number));
  for (const { number, became } of objects) numbers[number] = became === 0 && next < UNLABELLED - 1 ? ++next : became;
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
