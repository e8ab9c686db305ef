// The results of a clip in a folder: the images of each frame, and last tracks.json, which has what they were made from.

import { join } from 'node:path';
import type { AnnotationNote } from '../../types/formats.js';
import type { ClipChange, ClipTracks } from '../../types/index.js';
import { HIDDEN, LABELS, TRACKS } from './clip-folder.js';
import { lookAt, readWritten, sha256, writing } from './files.js';
import { type Output, removeIfEmpty } from './output.js';
import { jsonLine } from './pair.js';
import { isShown, pathsOf } from './showing.js';

/** The content of tracks.json. */
export interface ClipManifest extends Omit<ClipTracks, 'notes'> {
  version: 1;
  width: number;
  height: number;
  /** Of a video: frames per second on average, and the time of each frame in seconds from the first. */
  frameRate?: number;
  timestamps?: number[];
  /** Names of the frames' images. */
  frames: string[];
  /** Names of the frames' own files. */
  files: string[];
  /** The changes by corrections, where there are any. */
  changes?: readonly ClipChange[];
  /** What was assumed, where something was. */
  notes?: readonly AnnotationNote[];
  settings: { overlay: boolean; show?: readonly string[]; [name: string]: unknown };
  /** Hash of the settings and the frames. */
  job: string;
}

/** A frame's name, file and content, none if it cannot be read. */
export interface FrameFile {
  stem: string;
  file: string;
  sha256: string | undefined;
}

const OVERLAY = 'overlay';

export class ClipStore {
  readonly #output: Output;
  readonly #settings: ClipManifest['settings'];

  constructor(output: Output, settings: ClipManifest['settings']) {
    this.#output = output;
    this.#settings = settings;
  }

  /** The manifest of a finished run on the same frames with the same settings. */
  finished(frames: readonly FrameFile[]): ClipManifest | undefined {
    return this.#manifest(frames, this.#settings);
  }

  /** The manifest of a finished run on the same frames, with any settings, if all files are there. */
  before(frames: readonly FrameFile[]): ClipManifest | undefined {
    const manifest = this.#manifest(frames);
    return manifest && this.#areThere(imagesOf(frames, manifest.settings)) ? manifest : undefined;
  }

  /** Whether all images of a frame are there, and what is shown of the clip. */
  isThere(frame: FrameFile): boolean {
    return this.#areThere(imagesOf([frame], this.#settings));
  }

  #manifest(frames: readonly FrameFile[], settings?: ClipManifest['settings']): ClipManifest | undefined {
    try {
      const manifest = JSON.parse(readWritten(join(this.#output.folder, TRACKS))?.toString() ?? '') as ClipManifest;
      return manifest.job === jobOf(settings ?? manifest.settings, frames) ? manifest : undefined;
    } catch {
      return undefined; // Missing or foreign.
    }
  }

  #areThere(paths: readonly string[]): boolean {
    return paths.every((path) => lookAt(join(this.#output.folder, path))?.isFile());
  }

  /** Checks the places of all files. Throws `file-exists`. */
  check(frames: readonly FrameFile[], inputs: readonly string[]): void {
    this.#output.check([TRACKS, ...imagesOf(frames, this.#settings), HIDDEN], inputs);
  }

  /** Marks the folder as unfinished. Throws `write-failed`, as all methods that write do. */
  async begin(): Promise<void> {
    await writing(this.#output.folder, () => {
      this.#output.removeLeftovers();
      this.#output.removeOld((path) => path === TRACKS);
    });
  }

  /** Writes the images of a frame; the keys are their folders. */
  async write(stem: string, images: { [folder: string]: Uint8Array }): Promise<void> {
    await writing(this.#output.folder, () => {
      for (const [folder, bytes] of Object.entries(images)) this.#output.write(`${folder}/${stem}.png`, bytes);
    });
  }

  /** Puts films, which are complete in the folder of what is not, and others of that kind in their places. */
  async show(films: readonly string[], sheet: Uint8Array | undefined): Promise<void> {
    await writing(this.#output.folder, () => {
      if (sheet) this.#output.write('sheet.png', sheet);
      this.#output.place(this.#output.begin(), films, () => false);
    });
  }

  /** Removes images of frames that do not belong to the clip, and writes the manifest. */
  async end(
    frames: readonly FrameFile[],
    about: Pick<ClipManifest, 'width' | 'height' | 'frameRate' | 'timestamps'>,
    tracks: ClipTracks,
    changes: readonly ClipChange[],
    notes: readonly AnnotationNote[],
  ): Promise<void> {
    const names = { frames: frames.map(({ stem }) => stem), files: frames.map(({ file }) => file) };
    const [settings, job] = [this.#settings, jobOf(this.#settings, frames)];
    const manifest: ClipManifest = {
      version: 1,
      ...about,
      ...names,
      ...tracks,
      ...(changes.length > 0 && { changes }),
      ...(notes.length > 0 && { notes }),
      settings,
      job,
    };
    await writing(this.#output.folder, () => {
      this.#output.removeOld((path) => /^(labels|overlay)\//.test(path) || isShown(path), imagesOf(frames, settings));
      this.#output.write(TRACKS, jsonLine(manifest));
      removeIfEmpty(join(this.#output.folder, HIDDEN));
      this.#output.settle();
    });
  }
}

/** The paths of the images of all frames, and of what is shown of them. */
function imagesOf(frames: readonly FrameFile[], { overlay, show = [] }: ClipManifest['settings']): string[] {
  const images = (overlay ? [LABELS, OVERLAY] : [LABELS]).flatMap((folder) => frames.map(({ stem }) => `${folder}/${stem}.png`));
  return [
    ...images,
    ...pathsOf(
      show,
      frames.map(({ stem }) => stem),
    ),
  ];
}

/** Hash of the settings, names and contents. */
function jobOf(settings: object, frames: readonly FrameFile[]): string {
  return sha256(JSON.stringify({ settings, frames: frames.map(({ stem, file, sha256 }) => [stem, file, sha256]) }));
}
