// Annotations of frames, read back as labels. The format is recognised by the content, and each frame is drawn when it is asked for.

import { unzipSync } from 'fflate';
import type {
  AnnotatedFrame,
  AnnotationFile,
  AnnotationFormat,
  AnnotationNote,
  AnnotationOptions,
  Annotations,
  Levels,
} from '../../../types/formats.js';
import {
  checkedBytes,
  entriesOf,
  invalidInput,
  invalidOption,
  isListOf,
  isObject,
  keyOf,
  reading,
  UNLABELLED,
} from '../../common/checks.js';
import { VeroneseError } from '../../common/errors.js';
import { checkPath } from '../file-names.js';
import type { Size } from '../png-reader.js';
import { Canvas } from './canvas.js';
import { readCoco, readYouTubeVis } from './coco.js';
import { readCvat } from './cvat.js';
import { addTo, checkSize, type Context, isPng, type Known, naming, type ReadFrame, type Source } from './frame.js';
import { readLabelStudio } from './label-studio.js';
import { isLevels, wrongLevels } from './mask.js';
import { readMasks } from './masks.js';
import { IGNORED, isMots, numbersOfMots, readMots, readMotsPng } from './mots.js';
import { isYolo, namesInYaml, readYolo, sizeOfPicture } from './yolo.js';

/** Most bytes in an archive: more than the annotations of any clip. */
const LARGEST = 2 ** 30;
/** Byte order mark and white space, which may stand before text. */
const BEFORE = [0xef, 0xbb, 0xbf, 0x20, 0x09, 0x0a, 0x0d];
/** Lists of the names of YOLO's classes: of Ultralytics, of Darknet and CVAT (obj.names), of Roboflow (_darknet.labels) and of labelImg. */
const NAMES = /\.(ya?ml|names|labels)$|(^|\/)(names|(predefined_)?classes)\.txt$/i;
/** What stands beside annotations and is none: whatever it begins with, such as a class that is called <other>. */
const BESIDE = /(^|\/)(labels|seqinfo)\.(txt|ini)$/i;
/** The class of what is no object. */
const BACKGROUND = 'background';

interface Recognised {
  source: Source;
  format: AnnotationFormat;
  read: (context: Context) => ReadFrame[];
}

export function readAnnotations(files: Iterable<AnnotationFile>, options?: AnnotationOptions): Annotations {
  const { clip, sources } = reading(() => ({ clip: clipOf(options), sources: [...files].map(checkedSource) }));
  const all = sources.flatMap((source) => (isArchive(source.bytes) ? naming(source.name, () => unpacked(source)) : [source]));
  // Images beside a document are the frames that it is about.
  const pictures = all.filter(({ bytes }) => isPng(bytes));
  const documents = all.flatMap((source) => (isPng(source.bytes) ? [] : naming(source.name, () => recognised(source))));
  const [first, ...others] = documents;
  if (!first && pictures.length === 0) throw invalidInput(nothingIn(sources));
  const other = others.find(({ format }) => format !== first?.format);
  if (first && other) {
    const sentence = `'${first.source.name}' is ${first.format} and '${other.source.name}' is ${other.format}: give one of them`;
    throw invalidInput(sentence);
  }
  const { context, notes: noted } = contextOf(all, clip);
  const { format, read } = first
    ? { format: first.format, read: readDocuments(all, documents, context) }
    : readPictures(pictures, clip, context);
  const found = numbered(read);
  const notes = [...noted(), ...unknownIn(all, documents), ...found.notes];
  if (first && found.frames.size + found.boxes.length === 0)
    throw invalidInput(`'${first.source.name}' annotates no frame${notes[0] ? `: ${notes[0].message}` : ''}`);
  if (first && found.boxes.length > 0)
    notes.push({ code: 'boxes-taken', message: `'${first.source.name}': boxes without a mask are prompts (${found.boxes.length})` });
  return { format, ...found, notes };
}

function readDocuments(all: readonly Source[], documents: readonly Recognised[], context: Context): ReadFrame[] {
  const blank = documents[0]?.format === 'yolo' ? blankIn(all, documents) : [];
  return [...documents, ...blank].flatMap(({ source, read }) => naming(source.name, () => read(context)));
}

/** Annotations that are pictures themselves. */
function readPictures(pictures: readonly Source[], { levels }: Clip, context: Context): { format: AnnotationFormat; read: ReadFrame[] } {
  const numbers = numbersOfMots(pictures);
  if (!numbers) {
    const { frames, notes } = readMasks(pictures, levels);
    for (const note of notes) context.note(note);
    return { format: 'png', read: frames };
  }
  const message = `'${pictures[0]?.name}': pictures with levels from 1000 on are MOTS, in which ${IGNORED} says nothing`;
  if (numbers.has(IGNORED)) context.note({ code: 'mots-ignored', message });
  return { format: 'mots-png', read: pictures.map((source) => naming(source.name, () => readMotsPng(source, context))) };
}

/** Documents beside others that are in no format that is read. */
function unknownIn(all: readonly Source[], documents: readonly Recognised[]): AnnotationNote[] {
  const isKnown = (source: Source) => documents.some((document) => document.source === source);
  const others = all.filter((source) => /\.(json|xml)$/i.test(source.name) && !isKnown(source));
  return others.map(({ name }) => ({ code: 'file-left-out', message: nothingIn([{ name }]) }));
}

/** Texts of YOLO that say that there is nothing: those without a line, beside others. */
function blankIn(all: readonly Source[], documents: readonly Recognised[]): Recognised[] {
  const folders = new Set(documents.map(({ source }) => folderOf(source.name)));
  const isBlank = ({ name, bytes }: Source) =>
    /\.txt$/i.test(name) && folders.has(folderOf(name)) && bytes.every((byte) => BEFORE.includes(byte));
  return all.filter(isBlank).map((source) => ({ source, format: 'yolo', read: (context) => [readYolo(source, '', context)] }));
}

/** {@link AnnotationOptions}, checked. */
interface Clip {
  names: readonly string[] | undefined;
  size: Size | undefined;
  levels: Levels | undefined;
  firstFrame: 0 | 1 | undefined;
}

function clipOf(options: unknown): Clip {
  const { frames, size, levels, firstFrame } = entriesOf(options, ['frames', 'size', 'levels', 'firstFrame']);
  const isName = (name: unknown): name is string => typeof name === 'string';
  if (frames !== undefined && !isListOf(frames, isName)) throw invalidOption('frames', 'a list of names', frames);
  if (size !== undefined && !isObject(size)) throw invalidOption('size', 'a width and a height', size);
  if (levels !== undefined && !isLevels(levels)) throw wrongLevels(levels);
  if (firstFrame !== undefined && firstFrame !== 0 && firstFrame !== 1) throw invalidOption('firstFrame', '0 or 1', firstFrame);
  return { names: frames, size: size && checkSize(size['width'], size['height'], 'the frames'), levels, firstFrame };
}

function folderOf(name: string): string {
  return name.slice(0, name.lastIndexOf('/') + 1);
}

function checkedSource(file: unknown): Source {
  if (!isObject(file) || typeof file['name'] !== 'string') throw invalidInput('a file must have a name, and its bytes');
  return { name: file['name'], bytes: checkedBytes(`'${file['name']}'`, file['bytes']) };
}

/** What readers need beside their file; what they note and leave out, counted, is in `notes`. */
function contextOf(all: readonly Source[], { names, size, firstFrame }: Clip): { context: Context; notes: () => AnnotationNote[] } {
  const lists = all
    .filter(({ name }) => NAMES.test(name))
    .map(({ name, bytes }) => ({
      folder: folderOf(name),
      names: naming(name, () => (/\.ya?ml$/i.test(name) ? namesInYaml(textOf(bytes)) : textOf(bytes).trim().split(/\s*\n/))),
    }));
  // The nearest one in a folder around the file.
  lists.sort((a, b) => b.folder.length - a.folder.length);
  const pictures = new Map<string, Source[]>();
  const stem = (name: string) => keyOf(name.replace(/^.*\//s, '').replace(/\.[^.]*$/s, ''));
  for (const picture of all) if (/\.(png|jpe?g)$/i.test(picture.name)) addTo(pictures, stem(picture.name), picture);
  const noted: AnnotationNote[] = [];
  const left = new Map<string, string[]>();
  const context: Context = {
    namesOf: (file) => lists.find(({ folder, names }) => file.startsWith(folder) && names.length > 0)?.names ?? [],
    sizeOf(file) {
      const folder = folderOf(file).replace(/(^|\/)labels\//, '$1images/');
      const some = pictures.get(stem(file)) ?? [];
      const picture = some.find(({ name }) => folderOf(name) === folder) ?? some[0];
      const known = (picture && naming(picture.name, () => sizeOfPicture(picture.bytes))) ?? size;
      if (known) return known;
      throw invalidInput('it does not say the size of its image: give that as PNG or JPEG as well, or the clip (--clip)');
    },
    nameOf(index) {
      const name = names ? names[index] : String(index).padStart(5, '0');
      if (name === undefined) throw invalidInput(`it has a frame ${index}, and the clip has ${names?.length}`);
      checkPath(name);
      return name;
    },
    classesOf(file) {
      const list = all.find(({ name }) => name === `${folderOf(file)}labels.txt`);
      return list ? textOf(list.bytes).split(/[ \t\r]*\n/) : [];
    },
    leaveOut: (file, kind) => addTo(left, file, kind),
    note: (note) => noted.push(note),
    count: names?.length,
    firstFrame,
  };
  const notes = () =>
    [...left].map(([file, kinds]) => {
      const counts = [...new Set(kinds)].map((kind) => `${kind} (${kinds.filter((other) => other === kind).length})`);
      return { code: 'shapes-left-out', message: `'${file}': left out ${counts.join(', ')}` };
    });
  return { context, notes: () => [...noted, ...notes()] };
}

/** The format of the file, unless it is none of those known. Throws `invalid-input` where it begins like one and is damaged. */
function recognised(source: Source): Recognised[] {
  const { name, bytes } = source;
  if (NAMES.test(name) || BESIDE.test(name)) return [];
  const start = bytes.find((byte) => !BEFORE.includes(byte));
  if (start === 0x3c) return [{ source, format: 'cvat', read: (context) => readCvat(textOf(bytes), name, context) }];
  if (start === 0x7b || start === 0x5b) return recognisedJson(source);
  const text = start !== undefined && start >= 0x30 && start <= 0x39 ? textOf(bytes) : '';
  if (isMots(text)) return [{ source, format: 'mots', read: (context) => readMots(source, text, context) }];
  return isYolo(text) ? [{ source, format: 'yolo', read: (context) => [readYolo(source, text, context)] }] : [];
}

function recognisedJson(source: Source): Recognised[] {
  const { name, bytes } = source;
  const json = parsed(textOf(bytes));
  const tasks = isObject(json) ? [json] : json;
  if (isObject(json) && 'annotations' in json && 'images' in json)
    return [{ source, format: 'coco', read: (context) => readCoco(json, name, context) }];
  if (isObject(json) && 'annotations' in json && 'videos' in json)
    return [{ source, format: 'youtube-vis', read: (context) => readYouTubeVis(json, name, context) }];
  if (!isListOf(tasks, isTask) || tasks.length === 0) return [];
  return [{ source, format: 'label-studio', read: (context) => readLabelStudio(tasks, name, context) }];
}

function isTask(value: unknown): value is Record<string, unknown> {
  return (
    isObject(value) && isObject(value['data']) && ['annotations', 'completions', 'predictions'].some((name) => Array.isArray(value[name]))
  );
}

/** JSON, also as Python writes it: what is no number there is nothing here. */
function parsed(text: string): unknown {
  try {
    return JSON.parse(text);
  } catch {
    try {
      return JSON.parse(text.replace(/"(?:[^"\\]|\\.)*"|-?\b(?:NaN|Infinity)\b/g, (token) => (token.startsWith('"') ? token : 'null')));
    } catch {
      throw invalidInput('it is not JSON');
    }
  }
}

function nothingIn(files: readonly Pick<Source, 'name'>[]): string {
  const which = files.length === 1 ? `'${files[0]?.name}' is not an annotation` : 'no file is an annotation';
  return `${which} in a format that is read: COCO, YouTube-VIS, CVAT, Label Studio, MOTS, YOLO, PNG masks`;
}

/**
 * Objects keep the numbers that they have in the file, where that is possible; the others get those that are free, in their order. What they are
 * called by in the file is their name, if they have no other one.
 */
function numbered(read: readonly ReadFrame[]): Omit<Annotations, 'format'> {
  const objects = new Map<string, Known & { file: string }>();
  for (const { file, objects: some } of read)
    for (const object of some) objects.set(object.key, { file, ...object, ...objects.get(object.key) });
  const labels = new Map<string, number>();
  const taken = new Set<number>();
  const give = (key: string, label: number) => void (labels.set(key, label), taken.add(label));
  for (const [key, { number, name }] of objects) {
    if (name === BACKGROUND) labels.set(key, 0);
    else if (number !== undefined && !taken.has(number)) give(key, number);
  }
  let free = 1;
  const changed: (Known & { file: string; label: number })[] = [];
  for (const [key, object] of objects) {
    if (labels.has(key)) continue;
    while (taken.has(free)) free++;
    if (free >= UNLABELLED) throw invalidInput(`'${read[0]?.file}' has more than ${UNLABELLED - 1} objects`);
    give(key, free);
    if (object.original !== undefined) changed.push({ ...object, label: free });
  }
  const names: Record<number, string> = {};
  for (const [key, label] of labels) {
    const { name, original = label } = objects.get(key) as Known;
    const called = name ?? (original === label ? undefined : String(original));
    if (label !== 0 && called) names[label] = called;
  }
  const [one] = changed;
  const all = changed.map(({ original, label }) => `${original} is ${label}`).join(', ');
  const message = `'${one?.file}': objects have other numbers here, each its own from 1 to ${UNLABELLED - 1}: ${all}`;
  const notes: AnnotationNote[] = one ? [{ code: 'numbers-changed', message }] : [];
  const frames = new Map<string, AnnotatedFrame>();
  const files = new Map<string, string>();
  const boxes: Annotations['boxes'] = [];
  const [{ width, height } = { width: 0, height: 0 }] = read;
  const size = { width, height };
  for (const { name, file, width, height, draw, boxes: some = [], isOpen } of read) {
    const before = files.get(keyOf(name));
    if (before === file) throw invalidInput(`'${file}' has two frames called '${name}'`);
    if (before !== undefined) throw invalidInput(`'${file}' and '${before}' are both of the frame '${name}'`);
    files.set(keyOf(name), file);
    if (size.width !== width || size.height !== height) {
      const sentence = `'${file}': frame '${name}' has ${width}×${height} pixels, others have ${size.width}×${size.height}`;
      throw new VeroneseError('frame-size-mismatch', sentence);
    }
    for (const { key, box } of some) if (labels.get(key)) boxes.push({ frame: name, object: labels.get(key) as number, box });
    if (isOpen) continue;
    frames.set(name, {
      width,
      height,
      read: () =>
        naming(file, () => {
          const canvas = new Canvas(width, height);
          draw(canvas, (key) => labels.get(key) as number);
          return canvas.labels;
        }),
    });
  }
  return { frames, size, names, boxes, notes };
}

function isArchive(bytes: Uint8Array): boolean {
  return bytes[0] === 0x50 && bytes[1] === 0x4b;
}

/** The files in an archive that may be annotations, called by its name and their paths in it. */
function unpacked({ name: archive, bytes }: Source): Source[] {
  let size = 0;
  const filter = ({ name, originalSize }: { name: string; originalSize: number }) => {
    if (!/\.(json|xml|png|jpe?g|txt|ya?ml|names|labels)$/i.test(name) || /(^|\/)(\.|__MACOSX\/)/.test(name)) return false;
    size += originalSize;
    if (size > LARGEST) throw invalidInput('the archive is too large');
    return true;
  };
  try {
    return Object.entries(unzipSync(bytes, { filter })).map(([name, content]) => ({ name: `${archive}/${name}`, bytes: content }));
  } catch (thrown) {
    if (size > LARGEST) throw thrown;
    throw invalidInput('the archive is damaged');
  }
}

function textOf(bytes: Uint8Array): string {
  try {
    return new TextDecoder('utf-8', { fatal: true }).decode(bytes);
  } catch {
    throw invalidInput('its text is not in UTF-8, or too long');
  }
}
