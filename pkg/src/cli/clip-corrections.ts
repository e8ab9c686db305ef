// Folders of annotations: NAME.png for some frames, edits.json for whole objects. Checked before anything is written.

import { readdirSync, statSync } from 'node:fs';
import { basename, extname, join } from 'node:path';
import type { AnnotationNote } from '../../types/formats.js';
import type { ClipCorrection, ClipEdits, ClipPrompt, ClipPropagation } from '../../types/index.js';
import { editsOf, isObjectNumber, RANGE } from '../calls/clip/edits.js';
import { checkUnlocked, isPropagation, isWithin, promptOf, SPREADS } from '../calls/clip/annotations.js';
import { isListOf, isObject, UNLABELLED, unknownOf } from '../common/checks.js';
import { VeroneseError } from '../common/errors.js';
import type { ClipFrames } from './clip-frames.js';
import { readJson, readLabels } from './label-files.js';
import { encodeColourPng } from '../entries/codecs.js';
import { readAnnotations } from '../formats/reading/annotations.js';
import { Canvas } from '../formats/reading/canvas.js';
import { isPng } from '../formats/reading/frame.js';
import { readInput, sha256 } from './files.js';
import { decoded } from './pair.js';

export const EDITS = 'edits.json';

/** A vertex of a polygon is not meant to be farther away than this, pixels. */
const FARTHEST = 1e5;

/** The content of edits.json. */
interface Edits {
  edits: ClipEdits;
  prompts: FullPrompt[];
  /** Of polygons: where an object is in a frame, and 0 where it is not. */
  outlines: Outline[];
  /** Frames, where there is a list of them. */
  accepted: number[] | undefined;
  /** By frame. */
  propagate: Map<number, ClipPropagation>;
}

type Outline = Required<Pick<ClipCorrection, 'frame' | 'object' | 'labels'>>;
type FullPrompt = Extract<ClipPrompt, { object: number }>;

/** The label images of a folder, by the names of their frames. */
interface Images {
  images: LabelImage[];
  paths: string[];
  notes: AnnotationNote[];
}

interface LabelImage {
  path: string;
  stem: string;
  labels: Uint8Array;
  width: number;
  height: number;
}

/** The annotations of a folder. */
interface Folder extends Edits, Images {
  said: ClipCorrection[];
  sha256: string;
}

export interface Corrections {
  masks: ClipCorrection[];
  corrections: ClipCorrection[];
  prompts: ClipPrompt[];
  /** Frames. */
  accepted: number[];
  edits: ClipEdits;
  /** The files of all. */
  paths: string[];
  /** Hash of the content of each folder that has annotations. */
  hashes: { masks?: string; corrections?: string };
  /** What masks were taken for. */
  notes: AnnotationNote[];
}

/** Undefined without annotations. Throws an error that names the file. */
export async function readCorrections(folders: { [folder in 'masks' | 'corrections']: string | undefined }, frames: ClipFrames): Promise<Corrections | undefined> {
  const masks = folders.masks === undefined ? undefined : await readFolder(folders.masks, frames, givenMasks);
  const corrections = folders.corrections === undefined ? undefined : await readFolder(folders.corrections, frames, paintedLabels);
  const both = [masks, corrections].filter((folder) => folder !== undefined);
  if (both.length === 0) return undefined;
  const all = <T>(read: (edits: ClipEdits) => readonly T[] | undefined) => both.flatMap(({ edits }) => read(edits) ?? []);
  const propagate = new Map(both.flatMap((folder) => [...folder.propagate]));
  const spread = <T extends { frame: number }>(said: T[] = []) => said.map((each) => ({ ...each, propagate: propagate.get(each.frame) }));
  const prompts = both.flatMap((folder) => folder.prompts);
  const edits = {
    merge: all(({ merge }) => merge),
    delete: all((edits) => edits.delete),
    background: all(({ background }) => background),
    locked: all(({ locked }) => locked),
    names: { ...masks?.edits.names, ...corrections?.edits.names },
  };
  const { locked, numbers } = editsOf(edits, (reason) => new VeroneseError('invalid-input', `'${EDITS}' of both folders: ${reason}`));
  checkUnlocked(locked, numbers);
  const outlines = both.flatMap((folder) => folder.outlines);
  // What is merged into an object is not outside its outline either.
  const merged = outlines.flatMap(({ frame, object: into, labels }) => {
    const others = [...numbers.keys()].filter((object) => numbers.get(object) === into && !outlines.some((own) => own.frame === frame && own.object === object));
    return others.map((object) => ({ frame, object, labels: labels.map((label) => (label === 0 ? 0 : UNLABELLED)) }));
  });
  return {
    masks: spread(masks?.said),
    corrections: spread([...(corrections?.said ?? []), ...merged, ...outlines]),
    prompts: spread(prompts),
    accepted: [...new Set(both.flatMap(({ accepted }) => accepted ?? []))],
    edits,
    paths: both.flatMap(({ paths }) => paths),
    hashes: { ...(masks && { masks: masks.sha256 }), ...(corrections && { corrections: corrections.sha256 }) },
    notes: masks?.notes ?? [],
  };
}

/** Undefined without annotations. */
async function readFolder(folder: string, frames: ClipFrames, read: (folder: string, names: string[]) => Promise<Images>): Promise<Folder | undefined> {
  const names = namesIn(folder).sort();
  const found = await read(folder, names);
  const said: ClipCorrection[] = [];
  for (const { path, stem, labels, width, height } of found.images) {
    const frame = frames.files.findIndex((file) => file.stem === stem);
    if (frame < 0) throw new VeroneseError('invalid-input', `'${path}' has the name of no frame of the clip`);
    if (said.some((other) => other.frame === frame)) throw new VeroneseError('invalid-input', `'${path}' corrects a frame for the second time`);
    const size = frames.size ?? (await frames.read(0));
    if (width !== size.width || height !== size.height) {
      throw new VeroneseError('frame-size-mismatch', `'${path}' has ${width}×${height} pixels, the frames have ${size.width}×${size.height}`);
    }
    said.push({ frame, labels });
  }
  said.sort((one, other) => one.frame - other.frame);
  const none: Edits = { edits: {}, prompts: [], outlines: [], accepted: undefined, propagate: new Map() };
  const told = names.includes(EDITS) ? await readEdits(join(folder, EDITS), frames) : none;
  const { edits, prompts, outlines, accepted, propagate } = told;
  if (said.length === 0 && Object.keys(edits).length + prompts.length + outlines.length + propagate.size === 0 && accepted === undefined) return undefined;
  const hashes = [...said, ...outlines].map(({ frame, object, labels }: ClipCorrection) => [frame, sha256(labels), ...(object === undefined ? [] : [object])]);
  const content = [hashes, edits, ...propagate, prompts, accepted];
  const paths = [...new Set([...names.map((name) => join(folder, name)), ...found.paths])];
  return { ...found, said, ...told, paths, sha256: sha256(JSON.stringify(content)) };
}

/** Label images as the program writes them, painted over: 255 says nothing. */
async function paintedLabels(folder: string, names: string[]): Promise<Images> {
  const images: LabelImage[] = [];
  for (const name of names.filter((name) => isImage(name) && extname(name).toLowerCase() === '.png')) {
    const path = join(folder, name);
    images.push({ path, stem: stemOf(name), ...(await readLabels(path, { foreign: true })) });
  }
  return { images, paths: [], notes: [] };
}

/** Masks as people have them, in the folder or in one for each object. */
async function givenMasks(folder: string, names: string[]): Promise<Images> {
  const objects = names.filter((name) => /^\d+$/.test(name) && statSync(join(folder, name)).isDirectory());
  const inside = [...names, ...objects.flatMap((name) => namesIn(join(folder, name)).sort().map((file) => join(name, file)))];
  const paths = inside.filter(isImage).map((name) => join(folder, name));
  if (paths.length === 0) return { images: [], paths, notes: [] };
  const files = await Promise.all(paths.map(async (path) => ({ name: path.replaceAll('\\', '/'), bytes: await pngOf(path) })));
  const { frames, notes } = readAnnotations(files);
  const pathOf = (stem: string) => paths.find((path) => stemOf(basename(path)) === stem) as string;
  const images = [...frames].map(([stem, frame]) => ({ path: pathOf(stem), stem, labels: frame.read(), width: frame.width, height: frame.height }));
  return { images, paths, notes };
}

/** A mask as PNG; of the other formats its pixels. */
async function pngOf(path: string): Promise<Uint8Array> {
  const bytes = await readInput(path);
  if (isPng(bytes)) return bytes;
  const { width, height, data } = await decoded({ name: path, bytes });
  return encodeColourPng(width, height, data);
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
async function readEdits(path: string, frames: ClipFrames): Promise<Edits> {
  const wrong = (reason: string) => new VeroneseError('invalid-input', `'${path}': ${reason}`);
  const content = await readJson(path);
  editsOf(content, wrong, ['boxes', 'clicks', 'prompts', 'polygons', 'accepted', 'propagate']);
  const { propagate = {}, boxes = {}, clicks = {}, prompts: listed = [], polygons = [], accepted, ...edits } = content as Record<string, unknown>;
  if (!isObject(propagate)) throw wrong("'propagate' must be an object, from names of frames to where what is said of them spreads");
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
  // One after another: the first keeps its pixels.
  const prompts: FullPrompt[] = [];
  const add = async (entry: Record<string, unknown>, bad: (reason: string) => VeroneseError) => {
    const pointed = promptOf(entry, bad);
    if (!isWithin(pointed, await sizeOf())) throw bad('is not within the frame');
    const before = prompts.find(({ frame, object }) => frame === pointed.frame && object === pointed.object);
    if (before) throw bad(`has a ${before.box ? 'box' : 'click'} already`);
    const { label, click, object = label, clicks = click && [[...(click as number[]), 1]], ...rest } = entry;
    prompts.push({ ...rest, object, clicks } as FullPrompt);
  };
  for (const { entry, frame, bad } of entriesOf('prompts', listed, ['clicks', 'box'])) {
    if (entry['clicks'] === undefined && entry['box'] === undefined) throw bad('must have clicks, a box, or both');
    await add({ ...entry, frame }, bad);
  }
  const outlines = new Map<string, Outline>();
  for (const { entry: { object, points }, frame, bad } of entriesOf('polygons', polygons, ['points'])) {
    if (!isObjectNumber(object)) throw bad(`must have an object, ${RANGE}`);
    if (!isListOf(points, isPoint) || points.length < 3) throw bad('must have points, three or more [x, y]');
    const { width, height } = await sizeOf();
    const canvas = new Canvas(width, height);
    // Whole numbers are centres of pixels here, corners there.
    canvas.polygon(points.flat().map((value) => value + 0.5), object);
    if (!canvas.labels.includes(object)) throw bad('has no pixel of the frame');
    // Several are parts of one.
    const before = outlines.get(`${frame} ${object}`)?.labels;
    outlines.set(`${frame} ${object}`, { frame, object, labels: canvas.labels.map((label, p) => label || (before?.[p] ?? 0)) });
  }
  for (const [list, key, value] of [['boxes', 'box', boxes], ['clicks', 'click', clicks]] as const) {
    if (!isObject(value)) throw wrong(`'${list}' must be an object, from names of frames to a ${key} of each object`);
    for (const [name, objects] of Object.entries(value)) {
      const frame = frameOf(list, name);
      if (!isObject(objects)) throw wrong(`'${list}' must have an object for '${name}', from numbers of objects to a ${key} of each`);
      for (const [number, at] of Object.entries(objects)) {
        await add({ frame, label: Number(number), [key]: at ?? [] }, (reason) => wrong(`'${list}' of '${name}', object ${number}: ${reason}`));
      }
    }
  }
  const isName = (name: unknown): name is string => typeof name === 'string';
  if (accepted !== undefined && !isListOf(accepted, isName)) throw wrong("'accepted' must be a list of names of frames");
  const spreads = Object.entries(propagate).map(([name, way]): [number, ClipPropagation] => {
    const frame = frameOf('propagate', name);
    if (!isPropagation(way)) throw wrong(`'propagate' must have ${SPREADS} for '${name}'`);
    return [frame, way];
  });
  return { edits, prompts, outlines: [...outlines.values()], accepted: accepted?.map((name) => frameOf('accepted', name)), propagate: new Map(spreads) };
}

function isPoint(value: unknown): value is [x: number, y: number] {
  return isListOf(value, (side): side is number => typeof side === 'number' && Math.abs(side) <= FARTHEST) && value.length === 2;
}
