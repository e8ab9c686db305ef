//! Which of the given files are opened, and in which order.

const naturally = new Intl.Collator('en', { numeric: true });
const VIDEO_NAMES = /\.(mp4|m4v|mov|webm|mkv)$/i;

function isVideo(file: File): boolean {
  return file.type.startsWith('video/') || VIDEO_NAMES.test(file.name);
}

/** The path of a file below the folder that was given, that folder included. */
function pathOf({ webkitRelativePath, name }: File): string[] {
  return webkitRelativePath === '' ? [name] : webkitRelativePath.split('/');
}

/** Gives a file its path, as a folder picker does. */
export function withPath(file: File, path: string): File {
  return Object.defineProperty(file, 'webkitRelativePath', { value: path });
}

/** The folder that was given; `null` if the file itself was. */
export function folderOf(file: File): string | null {
  const [folder, ...rest] = pathOf(file);
  return rest.length === 0 ? null : folder!;
}

/** The name of a file, with the path below the folder that was given: names alone may repeat. */
export function nameOfFile(file: File): string {
  return pathOf(file).slice(folderOf(file) === null ? 0 : 1).join('/');
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
  const seen = given.filter((file) => !PROJECT_NAMES.test(file.name) && (folderOf(file) === null || !pathOf(file).some((part) => part.startsWith('.')))).sort(byPath);
  const video = seen.find(isVideo) ?? null;
  const images = seen.filter((file) => file.type.startsWith('image/') || (folderOf(file) === null && seen.length <= 2));
  return { project, video, images };
}
