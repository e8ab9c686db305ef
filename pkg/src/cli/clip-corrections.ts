// Folders of annotations: NAME.png for some frames, edits.json for whole objects. Checked before anything is written.

import { basename, extname, join } from 'node:path';
import type { Levels } from '../../types/formats.js';
import type { ClipAnnotation, ClipDeclaration } from '../../types/index.js';
import { invalidInput, isListOf, isNumber, isObject, isWhole, UNLABELLED, unknownOf } from '../common/checks.js';
import { VeroneseError } from '../common/errors.js';
import { scaledLabels, scaledSize } from '../common/scaling.js';
import { encodePng } from '../entries/codecs.js';
import { readAnnotations } from '../formats/reading/annotations.js';
import { Canvas } from '../formats/reading/canvas.js';
import { isPng } from '../formats/reading/frame.js';
import type { ClipCommand } from './arguments.js';
import type { ClipFrames } from './clip-frames.js';
import { entriesOf, isFolder, readInput, sha256 } from './files.js';
import { IMAGE, UNREAD_IMAGE } from './frames.js';
import { readJson, readLabels } from './label-files.js';
import { decoded } from './pair.js';

export const EDITS = 'edits.json';

const RANGE = `numbers from 1 to ${UNLABELLED - 1}`;

type Wrong = (reason: string) => VeroneseError;

const isObjectNumber = (value: unknown): value is number => isWhole(value, 1, UNLABELLED - 1);

/** The clip that annotations are of. */
interface Target {
  /** Names of the frames. */
  stems: string[];
  length: number;
  width: number;
  height: number;
  maxSize: number | undefined;
}

/** Labels of a frame; with an object where that is, and 0 where it is not. */
interface Labelled {
  frame: number;
  labels: Uint8Array;
  object?: number;
}

type Prompt = Extract<ClipAnnotation, { clicks?: unknown }>;
type Propagation = Exclude<ClipAnnotation['propagate'], 'exact' | undefined>;

/** The edits of edits.json that are about objects. */
interface Edits {
  merge?: number[][];
  delete?: number[];
  background?: number[];
  names?: Record<string, string>;
  locked?: number[];
}

type Content = Awaited<ReturnType<typeof readEdits>>;
type Found = Awaited<ReturnType<typeof givenMasks>>;
export type Corrections = NonNullable<Awaited<ReturnType<typeof readCorrections>>>;

/** Undefined where no folder is given. Throws an error that names the file, or the folder of which nothing is read. */
export async function readCorrections(command: Pick<ClipCommand, 'masks' | 'corrections' | 'levels' | 'maxSize'>, frames: ClipFrames) {
  const { levels, maxSize } = command;
  if (command.masks === undefined && command.corrections === undefined) return undefined;
  const { width, height } = frames.size ?? (await frames.read(0));
  const target = { stems: frames.files.map(({ stem }) => stem), length: frames.length, width, height, maxSize };
  const read = async (folder: string | undefined, find: typeof givenMasks) =>
    folder === undefined ? undefined : readFolder(folder, await find(folder, levels), target);
  const masks = await read(command.masks, givenMasks);
  const corrections = await read(command.corrections, paintedLabels);
  const both = [masks, corrections].filter((folder) => folder !== undefined);
  const wrong = (reason: string) => invalidInput(`'${EDITS}': ${reason}`);
  const edits = both.map((folder) => folder.edits);
  const numbers = numbersOf(edits, wrong);
  const names = new Map(edits.flatMap((each) => Object.entries(each.names ?? {})).map(([object, name]) => [Number(object), name]));
  const ownLocks = edits.flatMap((each) => each.locked ?? []);
  const locked = withMerged(ownLocks, numbers);
  const deleted = locked.find((object) => numbers.get(object) === 0);
  if (deleted !== undefined) throw new VeroneseError('object-locked', `object ${deleted} is locked: unlock it to change it`);
  const prompts = both.flatMap((folder) => folder.prompts);
  const outlines = both.flatMap((folder) => folder.outlines);
  for (const list of [prompts, outlines]) {
    const again = list.find(({ frame, object }, at) => list.findIndex((other) => other.frame === frame && other.object === object) < at);
    if (again) throw wrong(`object ${again.object} is annotated in '${target.stems[again.frame]}' twice`);
  }
  const labels = both.flatMap((folder) => folder.labels);
  const propagate = new Map(both.flatMap((folder) => [...folder.propagate]));
  const idle = [...propagate.keys()].find((frame) => ![...labels, ...prompts, ...outlines].some((each) => each.frame === frame));
  if (idle !== undefined) throw wrong(`'propagate' has '${target.stems[idle]}', which has no annotation`);
  const annotations = [
    ...(masks?.labels ?? []).map((each) => ({ ...each, own: true })),
    ...(corrections?.labels ?? []),
    ...[...outsideOf(outlines, numbers), ...outlines].map(({ frame, object = 0, labels }) => ({
      frame,
      object,
      mask: labels.map((label) => (label === object ? 1 : label)),
    })),
    ...prompts,
  ];
  const annotated = new Set([
    ...labels.flatMap((each) => [...new Set(each.labels)]),
    ...[...prompts, ...outlines].map(({ object }) => object),
  ]);
  const edited = [...[...numbers].flat(), ...names.keys(), ...locked].filter((object) => object > 0 && !annotated.has(object));
  const declaration: ClipDeclaration & { annotations: ClipAnnotation[]; accepted: number[] } = {
    ...declared(numbers, names),
    locked,
    annotations: annotations.map((each) => ({ ...each, propagate: propagate.get(each.frame) })),
    accepted: [...new Set(both.flatMap(({ accepted }) => accepted ?? []))],
  };
  return {
    declaration,
    /** Objects that are edited, and not annotated as well. */
    edited: [...new Set(edited)].sort((one, other) => one - other),
    /** The files of all. */
    paths: both.flatMap(({ paths }) => paths),
    /** Hash of the content of each folder that has annotations. */
    hashes: { ...(masks && { masks: masks.sha256 }), ...(corrections && { corrections: corrections.sha256 }) },
    /** What masks were taken for. */
    notes: both.flatMap(({ notes }) => notes),
  };
}

/** Each object that gets another number, 0 for the background, and that number. */
function numbersOf(edits: readonly Edits[], wrong: Wrong): Map<number, number> {
  const numbers = new Map<number, number>();
  const called = (number: number | undefined) => (number === 0 ? 'background' : `object ${number}`);
  const give = (object: number, number: number) => {
    const other = numbers.get(object) ?? number;
    if (other !== number) throw wrong(`object ${object} cannot become ${called(other)} and ${called(number)}`);
    if (object !== number) numbers.set(object, number);
  };
  for (const [first = 0, ...others] of edits.flatMap(({ merge = [] }) => merge)) for (const other of others) give(other, first);
  for (const object of edits.flatMap((each) => [...(each.delete ?? []), ...(each.background ?? [])])) give(object, 0);
  return numbers;
}

/** Some objects, and those that are merged into one of them. */
function withMerged(objects: Iterable<number>, numbers: ReadonlyMap<number, number>): number[] {
  const all = new Set(objects);
  for (const [object, number] of numbers) if (all.has(number)) all.add(object);
  return [...all];
}

/** What is merged into a deleted object is deleted. What is merged into a named one is part of it at once, and so protected as it is. */
function declared(numbers: ReadonlyMap<number, number>, names: ReadonlyMap<number, string>): ClipDeclaration {
  const deleted = new Set([...numbers.keys()].filter((object) => numbers.get(object) === 0));
  for (const _ of numbers) for (const [object, number] of numbers) if (deleted.has(number)) deleted.add(object);
  const nameOf = (object: number) => names.get(object) ?? names.get(numbers.get(object) ?? object);
  return {
    descriptions: Object.fromEntries(withMerged(names.keys(), numbers).map((object) => [object, { name: nameOf(object) }])),
    merged: [...numbers].filter(([object]) => !deleted.has(object)).map(([object, into]) => [into, object]),
    deleted: [...deleted],
  };
}

/** Where objects are not that are merged into an outlined one: outside its outline, as it is. */
function outsideOf(outlines: readonly Labelled[], numbers: ReadonlyMap<number, number>): Labelled[] {
  return outlines.flatMap(({ frame, object: into, labels }) =>
    [...numbers.keys()]
      .filter((object) => numbers.get(object) === into && !outlines.some((own) => own.frame === frame && own.object === object))
      .map((object) => ({ frame, object, labels: labels.map((label) => (label === 0 ? 0 : UNLABELLED)) })),
  );
}

async function readFolder(folder: string, found: Found, target: Target) {
  const { images, names, left, expected } = found;
  const labelled: Labelled[] = [];
  for (const { path, stem, ...image } of images) {
    const frame = target.stems.indexOf(stem);
    if (frame < 0) throw invalidInput(`'${path}' has the name of no frame of the clip`);
    if (labelled.some((other) => other.frame === frame)) throw invalidInput(`'${path}' corrects a frame for the second time`);
    const { labels, ...size } = scaledLabels(image, target.maxSize);
    if (size.width !== target.width || size.height !== target.height) {
      const sizes = `${image.width}×${image.height} pixels, the frames have ${target.width}×${target.height}`;
      throw new VeroneseError('frame-size-mismatch', `'${path}' has ${sizes}`);
    }
    labelled.push({ frame, labels });
  }
  labelled.sort((one, other) => one.frame - other.frame);
  const hasEdits = names.includes(EDITS);
  const none: Content = { edits: {}, prompts: [], outlines: [], accepted: undefined, propagate: new Map() };
  const content = hasEdits ? await readEdits(join(folder, EDITS), target) : none;
  const { edits, prompts, outlines, accepted, propagate } = content;
  if ([labelled, prompts, outlines, accepted ?? [], ...Object.values(edits)].every((list) => Object.keys(list as object).length === 0)) {
    const [first = ''] = left;
    const remedy = IMAGE.test(first) || UNREAD_IMAGE.test(first) ? 'save it as PNG' : "'convert --to corrections' reads annotations";
    const which = first !== '' ? `'${first}' is not read: ${remedy}` : hasEdits ? `'${EDITS}' is empty` : 'there is no file of these';
    throw invalidInput(`nothing is read of the folder '${folder}': ${expected}, named as frames of the clip are, and '${EDITS}'; ${which}`);
  }
  const note = { code: 'file-left-out', message: `'${folder}': not read: ${left.join(', ')}` };
  const hashes = [...labelled, ...outlines].map(({ frame, object, labels }) => [frame, sha256(labels), ...(object ? [object] : [])]);
  return {
    ...content,
    labels: labelled,
    notes: [...found.notes, ...(left.length > 0 ? [note] : [])],
    paths: [...new Set([...names.map((name) => join(folder, name)), ...found.paths])],
    sha256: sha256(JSON.stringify([hashes, edits, ...propagate, prompts, accepted])),
  };
}

/** Label images as the program writes them, painted over: 255 is not annotated. */
async function paintedLabels(folder: string, levels: Levels | undefined): Promise<Found> {
  const names = namesIn(folder);
  const isRead = (name: string) => isImage(name) && extname(name).toLowerCase() === '.png';
  const images: Found['images'] = [];
  for (const name of names.filter(isRead)) {
    const path = join(folder, name);
    images.push({ path, stem: stemOf(name), ...(await readLabels(path, { foreign: true, levels })) });
  }
  const left = names.filter((name) => !isRead(name) && isMeant(folder, name));
  return { images, paths: [], notes: [], names, left, expected: 'labels are NAME.png' };
}

/** Masks as people have them, in the folder or in one for each object. */
async function givenMasks(folder: string, levels: Levels | undefined) {
  const names = namesIn(folder);
  const isOfObject = (name: string) => /^\d+$/.test(name) && isFolder(join(folder, name));
  const inside = names.filter(isOfObject).reduce(
    (all, name) => [...all, ...namesIn(join(folder, name)).map((file) => join(name, file))],
    names.filter((name) => !isOfObject(name)),
  );
  const paths = inside.filter(isImage).map((name) => join(folder, name));
  const left = inside.filter((name) => !isImage(name) && isMeant(folder, name));
  const files = await Promise.all(paths.map(async (path) => ({ name: path.replaceAll('\\', '/'), bytes: await pngOf(path) })));
  const { frames, notes } = paths.length > 0 ? readAnnotations(files, levels === undefined ? {} : { levels }) : { frames: [], notes: [] };
  const images = [...frames].map(([stem, frame]) => ({
    path: paths.find((path) => stemOf(basename(path)) === stem) as string,
    stem,
    labels: frame.read(),
    width: frame.width,
    height: frame.height,
  }));
  return {
    images,
    /** Those that are not in the folder itself, too. */ paths,
    notes,
    names,
    left,
    expected: 'masks are NAME.png, or 3/NAME.png of object 3',
  };
}

/** A mask as PNG; of the other formats its pixels. */
async function pngOf(path: string): Promise<Uint8Array> {
  const bytes = await readInput(path);
  if (isPng(bytes)) return bytes;
  const { width, height, data, range } = await decoded({ name: path, bytes });
  if (range) throw invalidInput(`'${path}' has samples of 16 bits, and 8 of them would be lost: save it as PNG`);
  return encodePng(width, height, data);
}

/** Whether something in a folder that is not read may be meant to be: a picture, an annotation, or a folder of them. */
function isMeant(folder: string, name: string): boolean {
  if (basename(name).startsWith('.') || name === EDITS) return false;
  return isFolder(join(folder, name)) || IMAGE.test(name) || UNREAD_IMAGE.test(name) || /\.(json|xml|zip|npy|npz|mat)$/i.test(name);
}

function isImage(name: string): boolean {
  return IMAGE.test(name) && !basename(name).startsWith('.');
}

function stemOf(name: string): string {
  return name.slice(0, -extname(name).length);
}

function namesIn(folder: string): string[] {
  return entriesOf(folder).map(({ name }) => name);
}

/** Frames are called by their names. */
async function readEdits(path: string, target: Target) {
  const wrong = (reason: string) => invalidInput(`'${path}': ${reason}`);
  const all = await readJson(path);
  const { annotationOf } = await import('../calls/session/clip.js');
  if (!isObject(all)) throw wrong('must be an object');
  const edits = ['merge', 'delete', 'background', 'names', 'locked'];
  const unknown = unknownOf(all, [...edits, 'prompts', 'polygons', 'accepted', 'propagate', 'size']);
  if (unknown !== undefined) throw wrong(`there is no edit ${unknown}`);
  const { propagate = {}, prompts = [], polygons = [], accepted, size, ...content } = all;
  const frameOf = (list: string, name: unknown) => {
    const frame = target.stems.indexOf(name as string);
    if (frame < 0) throw wrong(`'${list}' has '${String(name)}', the name of no frame of the clip`);
    return frame;
  };
  const scale = size === undefined ? 1 : scaleOf(size, target, wrong);
  /** The entries of a list, each about an object in a frame. */
  const entriesOf = (list: string, value: unknown, parts: readonly string[]) => {
    if (!isListOf(value, isObject)) throw wrong(`'${list}' must be a list of { frame, object, ${parts.join(', ')} }`);
    return value.map((entry, at) => {
      const bad = (reason: string) => wrong(`'${list}', number ${at}: ${reason}`);
      const unknown = unknownOf(entry, ['frame', 'object', ...parts]);
      if (unknown !== undefined) throw bad(`there is no ${unknown}`);
      if (typeof entry['frame'] !== 'string') throw bad('must have a frame, the name of one');
      if (!isObjectNumber(entry['object'])) throw bad(`must have an object, ${RANGE}`);
      return { ...(entry as { points?: unknown }), frame: frameOf(list, entry['frame']), object: entry['object'], bad };
    });
  };
  const outlines = new Map<string, Labelled & { object: number }>();
  for (const { frame, object, bad, points } of entriesOf('polygons', polygons, ['points'])) {
    const isPoint = (point: unknown): point is number[] => isListOf(point, isNumber) && point.length === 2;
    if (!isListOf(points, isPoint) || points.length < 3) throw bad('must have points, three or more [x, y]');
    const canvas = new Canvas(target.width, target.height);
    // Whole numbers are centres of pixels here, corners there.
    const ring = points.flat().map((value) => scale * (value + 0.5));
    canvas.polygon(ring, object);
    if (!canvas.labels.includes(object)) throw bad('has no pixel of the frame');
    // Several are parts of one.
    const before = outlines.get(`${frame} ${object}`)?.labels;
    outlines.set(`${frame} ${object}`, { frame, object, labels: canvas.labels.map((label, p) => label || (before?.[p] ?? 0)) });
  }
  if (!isObject(propagate))
    throw wrong("'propagate' must be an object, from names of frames to the directions in which annotations spread");
  if (accepted !== undefined && !Array.isArray(accepted)) throw wrong("'accepted' must be a list of names of frames");
  return {
    /** Of objects. */
    edits: editsIn(content, wrong),
    // One after another: the first keeps its pixels.
    prompts: entriesOf('prompts', prompts, ['clicks', 'box']).map(({ bad, ...entry }) => {
      const prompt = scaledPrompt(entry, scale);
      if (prompt['clicks'] === undefined && prompt['box'] === undefined) throw bad('must have clicks, a box, or both');
      annotationOf(target, prompt, bad);
      const { clicks = [], box, ...rest } = prompt as unknown as Prompt;
      const own = clicks.filter(([, , sign]) => sign === 1);
      if (!box && own.length === 0) throw bad(`must have a box or a click that belongs to object ${rest.object}`);
      const [left, top, width, height] = box ?? [0, 0, Infinity, Infinity];
      const stray = own.find(([x, y]) => x < left || x >= left + width || y < top || y >= top + height);
      if (stray) throw bad(`has a click at ${stray[0]}, ${stray[1]} that belongs to object ${rest.object} and is not in its box`);
      return prompt as unknown as Prompt;
    }),
    /** Of polygons. */
    outlines: [...outlines.values()],
    /** Frames, where there is a list of them. */
    accepted: (accepted as unknown[] | undefined)?.map((name) => frameOf('accepted', name)),
    propagate: new Map(
      Object.entries(propagate).map(([name, way]): [number, Propagation] => {
        const frame = frameOf('propagate', name);
        if (['both', 'forward', 'backward', 'none'].includes(way as string)) return [frame, way as Propagation];
        throw wrong(`'propagate' must have 'both', 'forward', 'backward' or 'none' for '${name}'`);
      }),
    ),
  };
}

function editsIn(content: Record<string, unknown>, wrong: Wrong): Edits {
  const { merge = [], names = {}, delete: deleted = [], background = [], locked = [] } = content;
  const isGroup = (list: unknown): list is number[] => isListOf(list, isObjectNumber) && list.length >= 2;
  if (!isListOf(merge, isGroup)) throw wrong(`'merge' must be lists of two or more objects, ${RANGE}`);
  for (const [name, list] of Object.entries({ delete: deleted, background, locked }))
    if (!isListOf(list, isObjectNumber)) throw wrong(`'${name}' must be a list of objects, ${RANGE}`);
  const isNamed = ([number, name]: [string, unknown]) => isObjectNumber(Number(number)) && typeof name === 'string' && name !== '';
  if (!isObject(names) || !Object.entries(names).every(isNamed))
    throw wrong(`'names' must be an object with a text for each object, ${RANGE}`);
  return content;
}

/** The factor by which annotations in pixels of a size are scaled, as the frames are. */
function scaleOf(own: unknown, { width, height, maxSize }: Target, wrong: Wrong): number {
  const isSide = (side: unknown): side is number => isWhole(side, 1, Number.MAX_SAFE_INTEGER);
  if (!isListOf(own, isSide) || own.length !== 2) throw wrong("'size' must be a width and a height");
  const [ownWidth = 0, ownHeight = 0] = own;
  const scaled = scaledSize({ width: ownWidth, height: ownHeight }, maxSize);
  if (scaled.width === width && scaled.height === height) return width / ownWidth;
  const { message } = wrong(`it is about frames of ${own.join('×')} pixels, these have ${width}×${height}`);
  throw new VeroneseError('frame-size-mismatch', message);
}

function scaledPrompt(entry: Record<string, unknown>, scale: number): Record<string, unknown> {
  if (scale === 1) return entry;
  const { box, clicks } = entry;
  const number = (value: unknown) => (isNumber(value) ? value : NaN);
  const point = (at: unknown) => (Array.isArray(at) ? at.map((value, k) => (k < 2 ? Math.floor(scale * number(value)) : value)) : at);
  const [x = 0, y = 0, width = 0, height = 0] = Array.isArray(box) ? box.map((value) => scale * number(value)) : [];
  const [left, top] = [Math.floor(x), Math.floor(y)];
  return {
    ...entry,
    ...(box !== undefined && { box: [left, top, Math.ceil(x + width) - left, Math.ceil(y + height) - top] }),
    ...(clicks !== undefined && { clicks: Array.isArray(clicks) ? clicks.map(point) : clicks }),
  };
}
