//! Which of the files that somebody gives are meant, and in which order.

const naturally = new Intl.Collator('en', { numeric: true });
const VIDEO_NAMES = /\.(mp4|m4v|mov|webm|mkv)$/i;

function isVideo(file: File): boolean {
  return file.type.startsWith('video/') || VIDEO_NAMES.test(file.name);
}

/** Where a file lay: the folders that were given, and its name. */
function pathOf({ webkitRelativePath, name }: File): string[] {
  return webkitRelativePath === '' ? [name] : webkitRelativePath.split('/');
}

/** The folder that was given; `null` where the file itself was. */
export function folderOf(file: File): string | null {
  const [folder, ...rest] = pathOf(file);
  return rest.length === 0 ? null : folder!;
}

/** Its name, with the folders between it and the one that was given: names alone may come twice. */
export function nameOfFile(file: File): string {
  return pathOf(file).slice(folderOf(file) === null ? 0 : 1).join('/');
}

/** In the order of a film: `frame2.png` before `frame10.png`, folder by folder. */
function byPath(one: File, other: File): number {
  const [a, b] = [pathOf(one), pathOf(other)];
  for (let k = 0; k < Math.min(a.length, b.length); k++) {
    const order = naturally.compare(a[k]!, b[k]!);
    if (order !== 0) return order;
  }
  return a.length - b.length;
}

/** A video, or images in the order of their names. */
export interface Sorted {
  readonly film: File | null;
  readonly images: readonly File[];
}

/**
 * Sorts out what can be opened. Of a folder only what its name says to be an image or a video, and nothing hidden; one or two files that
 * were named one by one are tried in any case.
 */
export function sortedOut(files: Iterable<File>): Sorted {
  const seen = [...files].filter((file) => folderOf(file) === null || !pathOf(file).some((part) => part.startsWith('.'))).sort(byPath);
  const film = seen.find(isVideo) ?? null;
  const images = seen.filter((file) => file.type.startsWith('image/') || (folderOf(file) === null && seen.length <= 2));
  return { film, images };
}
