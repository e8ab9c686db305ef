// Which frames a batch is made of: folders, patterns, files and lists of them, in a stated order.

import { constants, openSync, statSync } from 'node:fs';
import { readFile } from 'node:fs/promises';
import { Socket } from 'node:net';
import { basename, extname, join, parse, sep } from 'node:path';
import { text } from 'node:stream/consumers';
import type { Note } from '../../types/index.js';
import { VeroneseError } from '../common/errors.js';
import { entriesOf, notFound, readInput, unreadable } from './files.js';
import { isFileName } from './sequence.js';

export const IMAGE = /\.(png|jpe?g|webp|bmp|p[bgpn]m)$/i;
/** Pictures that are not read. */
export const UNREAD_IMAGE = /\.(tiff?|avif|jp2|j2k|jxl|heic|heif|gif|exr|dng)$/i;
const READ = 'PNG, JPEG, WebP, BMP or PNM';
const MAGIC = /[*?[\]]/;
/** An animation declares that it is one within so many bytes from the beginning. */
const ANIMATED = 65_536;
/** Folders below each other that `**` follows. */
const DEPTH = 32;

export interface Frame {
  name: string;
  /** Of a frame that is no file to read: its content, and what its results are called by. */
  bytes?: Uint8Array;
  stem?: string;
}

/**
 * The paths of all frames. What is named keeps its order; what is found in a folder or by a pattern is sorted by name, numbers
 * by their value (frame-9 before frame-10). Throws `file-not-found`, `unreadable-file`, or `invalid-input` where a name cannot stand in
 * the results.
 */
export function findFrames(names: readonly string[], listed: readonly string[] = []): string[] {
  const paths = [...names.flatMap(framesOf), ...listed];
  for (const path of paths) checkName(path);
  const [only] = paths;
  if (paths.length === 1 && only !== undefined && kindOf(only) === undefined) throw notFound(only);
  return paths;
}

/** Throws `invalid-input` where results cannot be called by the name of a file. */
export function checkName(path: string): void {
  const name = basename(path);
  if (isFileName(name) && isFileName(basename(name, extname(name)))) return;
  throw new VeroneseError(
    'invalid-input',
    `${JSON.stringify(path)} cannot name results: it has control characters, a backslash or only dots`,
  );
}

/** The video that is given instead of frames: the one file that is not an image, or that is an animation. */
export async function videoIn({ frames, list }: { frames: readonly string[]; list: string | undefined }): Promise<string | undefined> {
  const [name = ''] = frames;
  return frames.length === 1 && list === undefined && (isVideo(name) || (await isAnimation(name))) ? name : undefined;
}

function isVideo(name: string): boolean {
  const kind = kindOf(name);
  return kind === undefined ? !MAGIC.test(name) && !IMAGE.test(name) : kind === 'file' && !IMAGE.test(name);
}

/** Whether an image has several frames: a PNG with the control of an animation, a WebP with its flag. */
async function isAnimation(name: string): Promise<boolean> {
  if (!/\.(png|webp)$/i.test(name)) return false;
  const bytes = await readInput(name, ANIMATED).catch(() => new Uint8Array());
  const text = Buffer.from(bytes).toString('latin1');
  if (text.startsWith('RIFF')) return text.slice(8, 16) === 'WEBPVP8X' && ((bytes[20] ?? 0) & 2) > 0;
  const control = text.indexOf('acTL');
  return control > 0 && control < `${text}IDAT`.indexOf('IDAT');
}

/** Says which pictures in folders of frames are not read. */
export function leftOutNotes(names: readonly string[]): Note[] {
  return names
    .filter((name) => kindOf(name) === 'folder')
    .flatMap((name) => {
      const [first, ...others] = unreadIn(name);
      const more = others.length > 0 ? ` and ${others.length} more` : '';
      return first === undefined ? [] : [{ code: 'file-left-out', message: `'${name}': not read: ${first}${more}; frames are ${READ}` }];
    });
}

/** The names in a folder that fit and are not hidden, in order. */
function shownIn(folder: string, fits: RegExp): string[] {
  return entries(folder)
    .filter((entry) => fits.test(entry) && !entry.startsWith('.'))
    .sort(byNumbers);
}

const unreadIn = (folder: string): string[] => shownIn(folder, UNREAD_IMAGE);

function framesOf(name: string): string[] {
  const kind = kindOf(name);
  if (kind === 'folder') {
    const frames = shownIn(name, IMAGE);
    const [unread] = unreadIn(name);
    if (frames.length > 0) return frames.map((entry) => join(name, entry));
    if (unread === undefined) throw new VeroneseError('file-not-found', `there is no image in the folder '${name}'`);
    throw new VeroneseError('unreadable-image', `no image in the folder '${name}' is read, such as '${unread}': frames are ${READ}`);
  }
  if (kind || !MAGIC.test(name)) return [name];
  const found = matching(name);
  if (found.length === 0) throw new VeroneseError('file-not-found', `no file matches '${name}'`);
  return found.sort(byNumbers);
}

/** The lines of a file, or with `-` of standard input. None if there is no list. */
export async function readList(list: string | undefined, stdin: NodeJS.ReadableStream): Promise<string[]> {
  if (list === undefined) return [];
  try {
    return (await contentOf(list, stdin)).split(/\r?\n/).filter((line) => line.trim() !== '');
  } catch (thrown) {
    throw unreadable(list, thrown);
  }
}

/** A pipe is read as sockets are: a thread that waits for it would keep the process from ending when it is told to. */
async function contentOf(list: string, stdin: NodeJS.ReadableStream): Promise<string> {
  if (list === '-') return text(stdin);
  if (!statSync(list).isFIFO()) return readFile(list, 'utf8');
  return text(new Socket({ fd: openSync(list, constants.O_RDONLY | constants.O_NONBLOCK), readable: true, writable: false }));
}

/**
 * Files that match a pattern: `*` and `?` within a name, `[a-c]` one of some letters, `**` folders at any depth. On Windows it may begin
 * with a drive, and backslashes divide it too.
 */
function matching(pattern: string): string[] {
  const path = sep === '\\' ? pattern.replaceAll('\\', '/') : pattern;
  const { root } = parse(path);
  const parts = path
    .slice(root.length)
    .split('/')
    .filter((part) => part !== '');
  let places = [root];
  for (const [index, part] of parts.entries()) {
    const last = index === parts.length - 1;
    places = places.flatMap((place) => {
      if (part === '**') return [place, ...below(place, DEPTH)];
      if (!MAGIC.test(part)) return exists(join(place, part), last) ? [join(place, part)] : [];
      const wanted = expression(part);
      const hidden = part.startsWith('.');
      const names = entries(place || '.').filter((name) => wanted.test(name) && (hidden || !name.startsWith('.')));
      return names.map((name) => join(place, name)).filter((path) => exists(path, last));
    });
  }
  return [...new Set(places)];
}

function below(folder: string, depth: number): string[] {
  if (depth === 0) return [];
  const folders = entriesOf(folder || '.').filter((entry) => entry.isDirectory() && !entry.name.startsWith('.'));
  return folders.map(({ name }) => join(folder, name)).flatMap((path) => [path, ...below(path, depth - 1)]);
}

function exists(path: string, asFile: boolean): boolean {
  return kindOf(path) === (asFile ? 'file' : 'folder');
}

/**
 * The kind of a path, if anything is there. One that cannot be looked at (a link that leads to itself, something in a locked folder) counts
 * as a file: reading it gives the error, and the other pairs go on.
 */
function kindOf(path: string): 'file' | 'folder' | 'other' | undefined {
  try {
    const status = statSync(path, { throwIfNoEntry: false });
    return status && (status.isFile() ? 'file' : status.isDirectory() ? 'folder' : 'other');
  } catch {
    return 'file';
  }
}

function entries(folder: string): string[] {
  return entriesOf(folder).map(({ name }) => name);
}

function expression(part: string): RegExp {
  const source = part.replace(/\[!?[^\]]+\]|[\s\S]/g, (piece) => {
    if (piece === '*') return '.*';
    if (piece === '?') return '.';
    const letters = piece.slice(1, -1).replace(/^!/, '^');
    if (piece.length > 1) return `[${letters.replace(/[\\\]]/g, '\\$&')}]`;
    return piece.replace(/[.+^${}()|[\]\\/]/, '\\$&');
  });
  return new RegExp(`^${source}$`, 's');
}

/** Compares names with numbers by their value; independent of the language the system is set to. */
export function byNumbers(one: string, other: string): number {
  const [left, right] = [sortKey(one), sortKey(other)];
  if (left === right) return one < other ? -1 : Number(one > other);
  return left < right ? -1 : 1;
}

/** The name with each number preceded by how many digits it has. */
function sortKey(name: string): string {
  return name.replace(/0*(\d+)/g, (_, digits: string) => String(digits.length).padStart(3, '0') + digits);
}
