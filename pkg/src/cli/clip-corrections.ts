// Folders of annotations: NAME.png for some frames, edits.json for whole objects. Checked before anything is written.

import { readdirSync, statSync } from 'node:fs';
import { basename, extname, join } from 'node:path';
import type { AnnotationNote, Levels } from '../../types/formats.js';
import type { ClipAnnotation, ClipClick, ClipDeclaration } from '../../types/index.js';
import { isListOf, isNumber, isObject, isWhole, UNLABELLED, unknownOf } from '../common/checks.js';
import { VeroneseError } from '../common/errors.js';
import { scaledLabels, scaledSize } from '../common/scaling.js';
import type { ClipCommand } from './arguments.js';
import {
  checkUnlocked,
  type Edits,
  editsOf,
  isObjectNumber,
  isPropagation,
  type ObjectEdits,
  type Propagation,
  promptOf,
  RANGE,
  SPREADS,
  withMerged,
} from './clip-edits.js';
import type { ClipFrames } from './clip-frames.js';
import { UNREAD_IMAGE } from './frames.js';
import { readJson, readLabels } from './label-files.js';
import { encodePng } from '../entries/codecs.js';
import { readAnnotations } from '../formats/reading/annotations.js';
import { Canvas } from '../formats/reading/canvas.js';
import { isPng } from '../formats/reading/frame.js';
import { readInput, sha256 } from './files.js';
import { decoded } from './pair.js';

export const EDITS = 'edits.json';

/** A vertex of a polygon is not meant to be farther away than this, pixels. */
const FARTHEST = 1e5;

/** The content of edits.json. */
interface Content {
  edits: Edits;
  prompts: Prompt[];
  /** Of polygons: where an object is in a frame, and 0 where it is not. */
  outlines: Outline[];
  /** Frames, where there is a list of them. */
  accepted: number[] | undefined;
  /** By frame. */
  propagate: Map<number, Propagation>;
}

/** Labels of a frame. */
interface Labelled {
  frame: number;
  labels: Uint8Array;
}

interface Outline extends Labelled {
  object: number;
}

interface Prompt {
  frame: number;
  object: number;
  clicks?: ClipClick[];
  box?: [x: number, y: number, width: number, height: number];
}

/** The label images of a folder, by the names of their frames. */
interface Images {
  images: LabelImage[];
  paths: string[];
  notes: AnnotationNote[];
  /** What is in the folder, and what of it may be meant and is not read. */
  names: string[];
  left: string[];
  /** What is read. */
  expected: string;
}

interface LabelImage {
  path: string;
  stem: string;
  labels: Uint8Array;
  width: number;
  height: number;
}

/** The annotations of a folder. */
interface Folder extends Content, Images {
  labels: Labelled[];
  sha256: string;
}

export interface Corrections {
  declaration: ClipDeclaration & { annotations: ClipAnnotation[]; accepted: number[] };
  /** Objects that are edited, and not annotated as well. */
  edited: number[];
  /** The files of all. */
  paths: string[];
  /** Hash of the content of each folder that has annotations. */
  hashes: { masks?: string; corrections?: string };
  /** What masks were taken for. */
  notes: AnnotationNote[];
}

/** Undefined where no folder is given. Throws an error that names the file, or the folder of which nothing is read. */
export async function readCorrections(
  command: Pick<ClipCommand, 'masks' | 'corrections' | 'levels' | 'maxSize'>,
  frames: ClipFrames,
): Promise<Corrections | undefined> {
  const { levels, maxSize } = command;
  const read = async (
    folder: string | undefined,
    reader: (folder: string, names: string[], levels: Levels | undefined) => Promise<Images>,
  ) => (folder === undefined ? undefined : readFolder(folder, frames, maxSize, await reader(folder, namesIn(folder).sort(), levels)));
  const masks = await read(command.masks, givenMasks);
  const corrections = await read(command.corrections, paintedLabels);
  const both = [masks, corrections].filter((folder) => folder !== undefined);
  if (both.length === 0) return undefined;
  const ofBoth = (reason: string) => new VeroneseError('invalid-input', `'${EDITS}' of both folders: ${reason}`);
  const edits = editsOfBoth(both, ofBoth);
  const [prompts, outlines] = [both.flatMap((folder) => folder.prompts), both.flatMap((folder) => folder.outlines)];
  for (const list of [prompts, outlines]) {
    const again = list.find(({ frame, object }, at) => list.findIndex((other) => other.frame === frame && other.object === object) < at);
    if (again) throw ofBoth(`object ${again.object} is annotated in '${frames.files[again.frame]?.stem}' twice`);
  }
  const labels = both.flatMap((folder) => folder.labels);
  const propagate = new Map(both.flatMap((folder) => [...folder.propagate]));
  const idle = [...propagate.keys()].find((frame) => ![...labels, ...prompts, ...outlines].some((each) => each.frame === frame));
  if (idle !== undefined)
    throw new VeroneseError('invalid-input', `'${EDITS}': 'propagate' has '${frames.files[idle]?.stem}', which has no annotation`);
  const annotations: ClipAnnotation[] = [
    ...(masks?.labels ?? []).map((each) => ({ ...each, own: true })),
    ...(corrections?.labels ?? []),
    ...[...outsideOf(outlines, edits), ...outlines].map(({ frame, object, labels }) => ({
      frame,
      object,
      mask: labels.map((label) => (label === object ? 1 : label)),
    })),
    ...prompts,
  ];
  const annotated = new Set([
    ...[...labels, ...outlines].flatMap(({ labels }) => [...new Set(labels)]),
    ...prompts.map(({ object }) => object),
  ]);
  const edited = [...[...edits.numbers].flat(), ...edits.names.keys(), ...edits.locked].filter(
    (object) => object > 0 && !annotated.has(object),
  );
  return {
    declaration: {
      ...declared(edits),
      annotations: annotations.map((each) => ({ ...each, propagate: propagate.get(each.frame) })),
      accepted: [...new Set(both.flatMap(({ accepted }) => accepted ?? []))],
    },
    edited: [...new Set(edited)].sort((one, other) => one - other),
    paths: both.flatMap(({ paths }) => paths),
    hashes: { ...(masks && { masks: masks.sha256 }), ...(corrections && { corrections: corrections.sha256 }) },
    notes: both.flatMap(({ notes }) => notes),
  };
}

function editsOfBoth(both: readonly Folder[], wrong: (reason: string) => VeroneseError): ObjectEdits {
  const all = <T>(read: (edits: Edits) => readonly T[] | undefined) => both.flatMap(({ edits }) => read(edits) ?? []);
  const joined = {
    merge: all(({ merge }) => merge),
    delete: [...all((edits) => edits.delete), ...all(({ background }) => background)],
    locked: all(({ locked }) => locked),
    names: Object.assign({}, ...both.map(({ edits }) => edits.names)),
  };
  const edits = editsOf(joined, wrong);
  checkUnlocked(edits);
  return edits;
}

/** What is merged into a deleted object is deleted. What is merged into a named one is part of it at once, and so protected as it is. */
function declared({ numbers, names, locked }: ObjectEdits): ClipDeclaration {
  const deleted = new Set([...numbers.keys()].filter((object) => numbers.get(object) === 0));
  for (const _ of numbers) for (const [object, number] of numbers) if (deleted.has(number)) deleted.add(object);
  const nameOf = (object: number) => names.get(object) ?? names.get(numbers.get(object) ?? object);
  const named = withMerged(names.keys(), numbers);
  return {
    locked,
    descriptions: Object.fromEntries(named.map((object) => [object, { name: nameOf(object) }])),
    merged: [...numbers].filter(([object]) => !deleted.has(object)).map(([object, into]) => [into, object]),
    deleted: [...deleted],
  };
}

/** Where objects are not that are merged into an outlined one: outside its outline, as it is. */
function outsideOf(outlines: readonly Outline[], { numbers }: ObjectEdits): Outline[] {
  return outlines.flatMap(({ frame, object: into, labels }) => {
    const others = [...numbers.keys()].filter(
      (object) => numbers.get(object) === into && !outlines.some((own) => own.frame === frame && own.object === object),
    );
    return others.map((object) => ({ frame, object, labels: labels.map((label) => (label === 0 ? 0 : UNLABELLED)) }));
  });
}

async function readFolder(folder: string, frames: ClipFrames, maxSize: number | undefined, found: Images): Promise<Folder> {
  const labelled: Labelled[] = [];
  for (const { path, stem, ...image } of found.images) {
    const frame = frames.files.findIndex((file) => file.stem === stem);
    if (frame < 0) throw new VeroneseError('invalid-input', `'${path}' has the name of no frame of the clip`);
    if (labelled.some((other) => other.frame === frame))
      throw new VeroneseError('invalid-input', `'${path}' corrects a frame for the second time`);
    const size = frames.size ?? (await frames.read(0));
    const { labels, width, height } = scaledLabels(image, maxSize);
    if (width !== size.width || height !== size.height) {
      throw new VeroneseError(
        'frame-size-mismatch',
        `'${path}' has ${image.width}×${image.height} pixels, the frames have ${size.width}×${size.height}`,
      );
    }
    labelled.push({ frame, labels });
  }
  labelled.sort((one, other) => one.frame - other.frame);
  const none: Content = { edits: {}, prompts: [], outlines: [], accepted: undefined, propagate: new Map() };
  const hasEdits = found.names.includes(EDITS);
  const content = hasEdits ? await readEdits(join(folder, EDITS), frames, maxSize) : none;
  const { edits, prompts, outlines, accepted, propagate } = content;
  const lists = [labelled, prompts, outlines, accepted ?? [], ...Object.values(edits).map((list) => Object.keys(list))];
  if (lists.every((list) => list.length === 0)) {
    const [left] = found.left;
    const remedy =
      left !== undefined && (isImage(left) || UNREAD_IMAGE.test(left)) ? 'save it as PNG' : "'convert --to corrections' reads annotations";
    const which = left !== undefined ? `'${left}' is not read: ${remedy}` : hasEdits ? `'${EDITS}' is empty` : 'there is no file of these';
    throw new VeroneseError(
      'invalid-input',
      `nothing is read of the folder '${folder}': ${found.expected}, named as frames of the clip are, and '${EDITS}'; ${which}`,
    );
  }
  const notes =
    found.left.length > 0
      ? [...found.notes, { code: 'file-left-out', message: `'${folder}': not read: ${found.left.join(', ')}` }]
      : found.notes;
  const hashes = [...labelled, ...outlines].map(({ frame, object, labels }: Labelled & Partial<Outline>) => [
    frame,
    sha256(labels),
    ...(object === undefined ? [] : [object]),
  ]);
  const all = [hashes, edits, ...propagate, prompts, accepted];
  const paths = [...new Set([...found.names.map((name) => join(folder, name)), ...found.paths])];
  return { ...found, notes, ...content, labels: labelled, paths, sha256: sha256(JSON.stringify(all)) };
}

/** Label images as the program writes them, painted over: 255 is not annotated. */
async function paintedLabels(folder: string, names: string[], levels: Levels | undefined): Promise<Images> {
  const images: LabelImage[] = [];
  const isRead = (name: string) => isImage(name) && extname(name).toLowerCase() === '.png';
  for (const name of names.filter(isRead)) {
    const path = join(folder, name);
    images.push({ path, stem: stemOf(name), ...(await readLabels(path, { foreign: true, levels })) });
  }
  return {
    images,
    paths: [],
    notes: [],
    names,
    left: names.filter((name) => !isRead(name) && isMeant(folder, name)),
    expected: 'labels are NAME.png',
  };
}

/** Masks as people have them, in the folder or in one for each object. */
async function givenMasks(folder: string, names: string[], levels: Levels | undefined): Promise<Images> {
  const objects = names.filter((name) => /^\d+$/.test(name) && isFolder(join(folder, name)));
  const inside = [
    ...names.filter((name) => !objects.includes(name)),
    ...objects.flatMap((name) =>
      namesIn(join(folder, name))
        .sort()
        .map((file) => join(name, file)),
    ),
  ];
  const paths = inside.filter(isImage).map((name) => join(folder, name));
  const left = inside.filter((name) => !isImage(name) && isMeant(folder, name));
  const about = { paths, names, left, expected: 'masks are NAME.png, or 3/NAME.png of object 3' };
  if (paths.length === 0) return { ...about, images: [], notes: [] };
  const files = await Promise.all(paths.map(async (path) => ({ name: path.replaceAll('\\', '/'), bytes: await pngOf(path) })));
  const { frames, notes } = readAnnotations(files, levels === undefined ? {} : { levels });
  const pathOf = (stem: string) => paths.find((path) => stemOf(basename(path)) === stem) as string;
  const images = [...frames].map(([stem, frame]) => ({
    path: pathOf(stem),
    stem,
    labels: frame.read(),
    width: frame.width,
    height: frame.height,
  }));
  return { ...about, images, notes };
}

/** A mask as PNG; of the other formats its pixels. */
async function pngOf(path: string): Promise<Uint8Array> {
  const bytes = await readInput(path);
  if (isPng(bytes)) return bytes;
  const { width, height, data, range } = await decoded({ name: path, bytes });
  if (range) throw new VeroneseError('invalid-input', `'${path}' has samples of 16 bits, and 8 of them would be lost: save it as PNG`);
  return encodePng(width, height, data);
}

function isFolder(path: string): boolean {
  return statSync(path, { throwIfNoEntry: false })?.isDirectory() === true;
}

/** Whether something in a folder that is not read may be meant to be: a picture, an annotation, or a folder of them. */
function isMeant(folder: string, name: string): boolean {
  if (basename(name).startsWith('.') || name === EDITS) return false;
  return isFolder(join(folder, name)) || isImage(name) || UNREAD_IMAGE.test(name) || /\.(json|xml|zip|npy|npz|mat)$/i.test(name);
}

function isImage(name: string): boolean {
  return /\.(png|jpe?g|webp|bmp|p[bgpn]m)$/i.test(name) && !basename(name).startsWith('.');
}

function stemOf(name: string): string {
  return name.slice(0, -extname(name).length);
}

function namesIn(folder: string): string[] {
  try {
    return readdirSync(folder);
  } catch (thrown) {
    const { code, message } = thrown as NodeJS.ErrnoException;
    if (code === 'ENOENT') throw new VeroneseError('file-not-found', `there is no folder '${folder}'`);
    if (code === 'ENOTDIR') throw new VeroneseError('unreadable-file', `'${folder}' is not a folder`);
    throw new VeroneseError('unreadable-file', `'${folder}' cannot be read: ${message}`);
  }
}

/** Frames are called by their names. */
async function readEdits(path: string, frames: ClipFrames, maxSize: number | undefined): Promise<Content> {
  const wrong = (reason: string) => new VeroneseError('invalid-input', `'${path}': ${reason}`);
  const content = await readJson(path);
  editsOf(content, wrong, ['prompts', 'polygons', 'accepted', 'propagate', 'size']);
  const { propagate = {}, prompts: listed = [], polygons = [], accepted, size: own, ...edits } = content as Record<string, unknown>;
  if (!isObject(propagate))
    throw wrong("'propagate' must be an object, from names of frames to the directions in which annotations spread");
  const frameOf = (list: string, name: string) => {
    const frame = frames.files.findIndex(({ stem }) => stem === name);
    if (frame < 0) throw wrong(`'${list}' has '${name}', the name of no frame of the clip`);
    return frame;
  };
  const sizeOf = async () => frames.size ?? (await frames.read(0));
  /** The entries of a list, each about an object in a frame. */
  const entriesOf = (list: string, value: unknown, parts: readonly string[]) => {
    if (!isListOf(value, isObject)) throw wrong(`'${list}' must be a list of { frame, object, ${parts.join(', ')} }`);
    return value.map((entry, at) => {
      const bad = (reason: string) => wrong(`'${list}', number ${at}: ${reason}`);
      const unknown = unknownOf(entry, ['frame', 'object', ...parts]);
      if (unknown !== undefined) throw bad(`there is no ${unknown}`);
      if (typeof entry['frame'] !== 'string') throw bad('must have a frame, the name of one');
      return { entry, frame: frameOf(list, entry['frame']), bad };
    });
  };
  const scale = own === undefined ? 1 : await scaleOf(own, frames, maxSize, wrong);
  // One after another: the first keeps its pixels.
  const prompts: Prompt[] = [];
  for (const { entry, frame, bad } of entriesOf('prompts', listed, ['clicks', 'box'])) {
    if (entry['clicks'] === undefined && entry['box'] === undefined) throw bad('must have clicks, a box, or both');
    const prompt = scaledPrompt({ ...entry, frame }, scale);
    const object = promptOf(prompt, await sizeOf(), bad);
    if (prompts.some((other) => other.frame === frame && other.object === object))
      throw bad(`is the second one of object ${object} in its frame`);
    prompts.push({ ...prompt, frame, object });
  }
  const outlines = new Map<string, Outline>();
  for (const {
    entry: { object, points },
    frame,
    bad,
  } of entriesOf('polygons', polygons, ['points'])) {
    if (!isObjectNumber(object)) throw bad(`must have an object, ${RANGE}`);
    if (!isListOf(points, isPoint) || points.length < 3) throw bad('must have points, three or more [x, y]');
    const { width, height } = await sizeOf();
    const canvas = new Canvas(width, height);
    // Whole numbers are centres of pixels here, corners there.
    canvas.polygon(
      points.flat().map((value) => scale * (value + 0.5)),
      object,
    );
    if (!canvas.labels.includes(object)) throw bad('has no pixel of the frame');
    // Several are parts of one.
    const before = outlines.get(`${frame} ${object}`)?.labels;
    outlines.set(`${frame} ${object}`, { frame, object, labels: canvas.labels.map((label, p) => label || (before?.[p] ?? 0)) });
  }
  const isName = (name: unknown): name is string => typeof name === 'string';
  if (accepted !== undefined && !isListOf(accepted, isName)) throw wrong("'accepted' must be a list of names of frames");
  const spreads = Object.entries(propagate).map(([name, way]): [number, Propagation] => {
    const frame = frameOf('propagate', name);
    if (!isPropagation(way)) throw wrong(`'propagate' must have ${SPREADS} for '${name}'`);
    return [frame, way];
  });
  return {
    edits,
    prompts,
    outlines: [...outlines.values()],
    accepted: accepted?.map((name) => frameOf('accepted', name)),
    propagate: new Map(spreads),
  };
}

function isPoint(value: unknown): value is [x: number, y: number] {
  return isListOf(value, (side): side is number => typeof side === 'number' && Math.abs(side) <= FARTHEST) && value.length === 2;
}

/** The factor by which annotations in pixels of a size are scaled, as the frames are. */
async function scaleOf(
  own: unknown,
  frames: ClipFrames,
  maxSize: number | undefined,
  wrong: (reason: string) => VeroneseError,
): Promise<number> {
  const isSide = (side: unknown): side is number => isWhole(side, 1, Number.MAX_SAFE_INTEGER);
  if (!isListOf(own, isSide) || own.length !== 2) throw wrong("'size' must be a width and a height");
  const [width, height] = own as [number, number];
  const size = frames.size ?? (await frames.read(0));
  const scaled = scaledSize({ width, height }, maxSize);
  if (scaled.width === size.width && scaled.height === size.height) return scaled.width / width;
  throw new VeroneseError(
    'frame-size-mismatch',
    wrong(`it is about frames of ${width}×${height} pixels, these have ${size.width}×${size.height}`).message,
  );
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
