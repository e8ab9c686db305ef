//! Which of the given files are opened, and in which order.

const naturally = new Intl.Collator('en', { numeric: true });
const VIDEO_NAMES = /\.(mp4|m4v|mov|webm|mkv)$/i;

function isVideo(file: File): boolean {
  return file.type.startsWith('video/') || VIDEO_NAMES.test(file.name);
}

/** The path of a file, from the folder that was given. */
export function pathOf({ webkitRelativePath, name }: File): string[] {
  return webkitRelativePath === '' ? [name] : webkitRelativePath.split('/');
}

/** Gives a file its path, as a folder picker does. */
export function withPath(file: File, path: string): File {
  return Object.defineProperty(file, 'webkitRelativePath', { value: path });
}

/** Whether a file was given itself, and not its folder. */
function isAlone(file: File): boolean {
  return pathOf(file).length === 1;
}

/** The folder that all files are in, as its path from the folder that was given; empty if files themselves were. */
export function folderOfAll(files: readonly File[]): string {
  const paths = files.map((file) => pathOf(file).slice(0, -1));
  const [first = []] = paths;
  const end = first.findIndex((part, k) => paths.some((path) => path[k] !== part));
  return first.slice(0, end < 0 ? first.length : end).join('/');
}

/** The name of a file, with the path below a folder that it is in: names alone may repeat. */
export function nameIn(folder: string, file: File): string {
  return pathOf(file).join('/').slice(folder === '' ? 0 : folder.length + 1);
}

/** The images of one folder. */
export interface ImageFolder {
  readonly path: string;
  readonly images: readonly File[];
}

/** Images by folder, in their order. */
export function foldersOf(images: readonly File[]): ImageFolder[] {
  const folders = new Map<string, File[]>();
  for (const image of images) {
    const path = folderOfAll([image]);
    folders.set(path, [...(folders.get(path) ?? []), image]);
  }
  return [...folders].map(([path, files]) => ({ path, images: files }));
}

/** Names of folders with masks, and with other pictures that are made of frames. */
const MADE = /^(annotations?|depth|flow|gt|ground[-_ ]?truth|labels?|masks?|overlays?|segmentations?)$/i;

/** Those folders that may have frames: not those of masks, unless there are no others. */
export function likelyFrames(folders: readonly ImageFolder[]): readonly ImageFolder[] {
  const others = folders.filter(({ path }) => !path.split('/').some((part) => MADE.test(part)));
  return others.length > 0 ? others : folders;
}

/** Frame order: `frame2.png` before `frame10.png`, folder by folder. */
function byPath(one: File, other: File): number {
  const [a, b] = [pathOf(one), pathOf(other)];
  for (let k = 0; k < Math.min(a.length, b.length); k++) {
    const order = naturally.compare(a[k]!, b[k]!);
    if (order !== 0) return order;
  }
  return a.length - b.length;
}

/** A project, the work on frames that are not part of it. */
const PROJECT_NAMES = /\.veronese$/i;

/** A project and a video, if there are any, and the images in frame order. */
export interface Openable {
  readonly project: File | null;
  readonly video: File | null;
  readonly images: readonly File[];
}

/**
 * Selects what can be opened. Files of a folder must look like images or videos by type or name, and hidden ones are skipped. One or two
 * files that were given themselves are always tried.
 */
export function selectOpenable(files: Iterable<File>): Openable {
  const given = [...files];
  const project = given.find(({ name }) => PROJECT_NAMES.test(name)) ?? null;
  const seen = given.filter((file) => !PROJECT_NAMES.test(file.name) && (isAlone(file) || !pathOf(file).some((part) => part.startsWith('.')))).sort(byPath);
  const video = seen.find(isVideo) ?? null;
  const images = seen.filter((file) => file.type.startsWith('image/') || (isAlone(file) && seen.length <= 2));
  return { project, video, images };
}
