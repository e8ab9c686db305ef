// The results of a clip in a folder: the images of each frame, and last tracks.json, which has what they were made from.

import { join } from 'node:path';
import type { AnnotationNote } from '../../types/formats.js';
import type { ClipChange, ClipTracks } from '../../types/index.js';
import { HIDDEN, LABELS, TRACKS } from './clip-folder.js';
import { lookAt, parsedJson, sha256, writing } from './files.js';
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

/** Methods that write throw `write-failed`. */
export class ClipStore {
  readonly #output: Output;
  readonly #frames: readonly FrameFile[];
  readonly #settings: ClipManifest['settings'];

  constructor(output: Output, frames: readonly FrameFile[], settings: ClipManifest['settings']) {
    this.#output = output;
    this.#frames = frames;
    this.#settings = settings;
  }

  /** The manifest of a finished run on the same frames with the same settings. */
  finished(): ClipManifest | undefined {
    const manifest = this.#manifest();
    return manifest?.job === this.#job(this.#settings) ? manifest : undefined;
  }

  /** Whether there is a finished run on the same frames, with any settings, with all its files. */
  get isSeen(): boolean {
    const manifest = this.#manifest();
    return manifest?.job === this.#job(manifest?.settings) && this.#areThere(imagesOf(this.#frames, manifest.settings));
  }

  /** Indices of the frames of which an image is missing, or something that is shown of the clip. */
  missing(): number[] {
    return this.#frames.flatMap((frame, index) => (this.#areThere(imagesOf([frame], this.#settings)) ? [] : [index]));
  }

  #manifest(): ClipManifest | undefined {
    return parsedJson<ClipManifest>(join(this.#output.folder, TRACKS));
  }

  /** Hash of settings, and of the frames' names and contents. */
  #job(settings: unknown): string {
    return sha256(JSON.stringify({ settings, frames: this.#frames.map(({ stem, file, sha256 }) => [stem, file, sha256]) }));
  }

  #areThere(paths: readonly string[]): boolean {
    return paths.every((path) => lookAt(join(this.#output.folder, path))?.isFile());
  }

  /** Checks the places of all files. Throws `file-exists`. */
  check(inputs: readonly string[]): void {
    this.#output.check([TRACKS, ...imagesOf(this.#frames, this.#settings), HIDDEN], inputs);
  }

  /** Marks the folder as unfinished. */
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
  async show({ films, sheet }: { films: readonly string[]; sheet: Uint8Array | undefined }): Promise<void> {
    await writing(this.#output.folder, () => {
      if (sheet) this.#output.write('sheet.png', sheet);
      if (films.length > 0) this.#output.place(this.#output.begin(), films, () => false);
    });
  }

  /** Removes images of frames that do not belong to the clip, and writes the manifest. */
  async end(
    about: Pick<ClipManifest, 'width' | 'height' | 'frameRate' | 'timestamps'>,
    tracks: ClipTracks,
    changes: readonly ClipChange[],
    notes: readonly AnnotationNote[],
  ): Promise<void> {
    const manifest: ClipManifest = {
      version: 1,
      ...about,
      frames: this.#frames.map(({ stem }) => stem),
      files: this.#frames.map(({ file }) => file),
      ...tracks,
      ...(changes.length > 0 && { changes }),
      ...(notes.length > 0 && { notes }),
      settings: this.#settings,
      job: this.#job(this.#settings),
    };
    await writing(this.#output.folder, () => {
      this.#output.removeOld((path) => /^(labels|overlay)\//.test(path) || isShown(path), imagesOf(this.#frames, this.#settings));
      this.#output.write(TRACKS, jsonLine(manifest));
      removeIfEmpty(join(this.#output.folder, HIDDEN));
      this.#output.settle();
    });
  }
}

/** The paths of the images of all frames, and of what is shown of them. */
function imagesOf(frames: readonly FrameFile[], { overlay, show = [] }: ClipManifest['settings']): string[] {
  const stems = frames.map(({ stem }) => stem);
  const folders = overlay ? [LABELS, OVERLAY] : [LABELS];
  return [...folders.flatMap((folder) => stems.map((stem) => `${folder}/${stem}.png`)), ...pathsOf(show, stems)];
}
