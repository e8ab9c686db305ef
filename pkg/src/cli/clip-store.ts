// The results of a clip in a folder: the images of each frame, and last tracks.json, which has what they were made from.

import { join } from 'node:path';
import type { AnnotationNote } from '../../types/formats.js';
import type { ClipChange, ClipTracks } from '../../types/index.js';
import { type ClipManifest, HIDDEN, LABELS, TRACKS } from './clip-folder.js';
import { lookAt, parsedJson, sha256, writing } from './files.js';
import { type Output, removeIfEmpty } from './output.js';
import { jsonLine } from './pair.js';
import { isShown, pathsOf } from './showing.js';

/** A frame's name, file and content, none if it cannot be read. */
export interface FrameFile {
  stem: string;
  file: string;
  sha256: string | undefined;
}

const OVERLAY = 'overlay';

/** The results of a clip of these frames, made with these settings. Methods that write throw `write-failed`. */
export function clipStore(output: Output, frames: readonly FrameFile[], settings: ClipManifest['settings']) {
  const { folder } = output;
  const manifest = parsedJson(join(folder, TRACKS)) as ClipManifest | undefined;
  /** Hash of settings, and of the frames' names and contents. */
  const jobOf = (settings: unknown) =>
    sha256(JSON.stringify({ settings, frames: frames.map(({ stem, file, sha256 }) => [stem, file, sha256]) }));
  const job = jobOf(settings);
  const areThere = (paths: readonly string[]) => paths.every((path) => lookAt(join(folder, path))?.isFile());
  return {
    /** The manifest of a finished run on the same frames with the same settings. */
    finished: manifest?.job === job ? manifest : undefined,
    /** Whether there is a finished run on the same frames, with any settings, with all its files. */
    isSeen: manifest?.job === jobOf(manifest?.settings) && areThere(imagesOf(frames, manifest.settings)),
    /** Indices of the frames of which an image is missing, or something that is shown of the clip. */
    missing: frames.flatMap((frame, index) => (areThere(imagesOf([frame], settings)) ? [] : [index])),
    /** Checks the places of all files. Throws `file-exists`. */
    check: (inputs: readonly string[]) => output.check([TRACKS, ...imagesOf(frames, settings), HIDDEN], inputs),
    /** Marks the folder as unfinished. */
    begin: () =>
      writing(folder, () => {
        output.removeLeftovers();
        output.removeOld((path) => path === TRACKS);
      }),
    /** Writes the images of a frame; the keys are their folders. */
    write: (stem: string, images: { [folder: string]: Uint8Array }) =>
      writing(folder, () => {
        for (const [folder, bytes] of Object.entries(images)) output.write(`${folder}/${stem}.png`, bytes);
      }),
    /** Puts films, which are complete in the folder of what is not, and others of that kind in their places. */
    show: ({ films, sheet }: { films: readonly string[]; sheet: Uint8Array | undefined }) =>
      writing(folder, () => {
        if (sheet) output.write('sheet.png', sheet);
        if (films.length > 0) output.place(output.begin(), films, () => false);
      }),
    /** Removes images of frames that do not belong to the clip, and writes the manifest. */
    end: (
      about: Pick<ClipManifest, 'width' | 'height' | 'frameRate' | 'timestamps'>,
      tracks: ClipTracks,
      changes: readonly ClipChange[],
      notes: readonly AnnotationNote[],
    ) =>
      writing(folder, () => {
        const names = { frames: frames.map(({ stem }) => stem), files: frames.map(({ file }) => file) };
        const found = { ...tracks, ...(changes.length > 0 && { changes }), ...(notes.length > 0 && { notes }) };
        const manifest: ClipManifest = { version: 1, ...about, ...names, ...found, settings, job };
        output.removeOld((path) => /^(labels|overlay)\//.test(path) || isShown(path), imagesOf(frames, settings));
        output.write(TRACKS, jsonLine(manifest));
        removeIfEmpty(join(folder, HIDDEN));
        output.settle();
      }),
  };
}

/** The paths of the images of all frames, and of what is shown of them. */
function imagesOf(frames: readonly FrameFile[], { overlay, show = [] }: ClipManifest['settings']): string[] {
  const stems = frames.map(({ stem }) => stem);
  const folders = overlay ? [LABELS, OVERLAY] : [LABELS];
  return [...folders.flatMap((folder) => stems.map((stem) => `${folder}/${stem}.png`)), ...pathsOf(show, stems)];
}
