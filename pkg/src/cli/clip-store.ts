// The results of a clip in a folder: the images of each frame, and last tracks.json, which records what they were made from.

import { rmdirSync } from 'node:fs';
import { join } from 'node:path';
import type { ClipChange, ClipTracks } from '../../types/index.js';
import { HIDDEN, LABELS, TRACKS } from './clip-folder.js';
import { readWritten, sha256, writing } from './files.js';
import { idsOf, isUnchanged, type Ledger } from './ledger.js';
import { jsonLine } from './pair.js';
import { removeLeftovers } from './store.js';

/** The content of tracks.json. */
export interface Record extends ClipTracks {
  version: 1;
  width: number;
  height: number;
  /** Names of the frames' images. */
  frames: string[];
  /** Names of the frames' own files. */
  files: string[];
  /** What corrections have changed, where they have. */
  changes?: ClipChange[];
  settings: object;
  /** Hashes of the images. */
  images: { [path: string]: string };
  /** Hash of the settings, the frames and the rest of this record. */
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
  readonly #ledger: Ledger;
  readonly #out: string;
  readonly #settings: object;
  readonly #images = new Map<string, string>();

  constructor(ledger: Ledger, out: string, settings: object) {
    this.#ledger = ledger;
    this.#out = out;
    this.#settings = settings;
  }

  /** The record of a finished run on the same frames with the same settings, if nothing of it has changed. */
  async finished(frames: readonly FrameFile[]): Promise<Record | undefined> {
    return this.before(frames, (settings) => JSON.stringify(settings) === JSON.stringify(this.#settings));
  }

  /** The record of a finished run on the same frames, with any settings or some, if nothing of it has changed. */
  async before(frames: readonly FrameFile[], hasSettings: (settings: object) => boolean = () => true): Promise<Record | undefined> {
    try {
      const text = readWritten(join(this.#out, TRACKS))?.toString() ?? '';
      const { job: _, ...content } = JSON.parse(text) as Record;
      const record = sealed(content, jobOf(content.settings, frames));
      if (jsonLine(record) !== text || !hasSettings(content.settings)) return undefined;
      for (const [path, hash] of Object.entries(record.images)) if (!(await isUnchanged(join(this.#out, path), hash))) return undefined;
      return record;
    } catch {
      return undefined; // Missing, foreign or damaged.
    }
  }

  /**
   * Checks the places of all files and marks the folder as unfinished. Throws `file-exists`, or `write-failed`, as all methods that
   * write do.
   */
  async begin(frames: readonly FrameFile[], withOverlay: boolean, inputs: readonly string[]): Promise<void> {
    await writing(this.#out, async () => {
      const folders = withOverlay ? [LABELS, OVERLAY] : [LABELS];
      const images = folders.flatMap((folder) => frames.map(({ stem }) => `${folder}/${stem}.png`));
      await this.#ledger.check([TRACKS, ...images], idsOf(inputs));
      for (const folder of [LABELS, OVERLAY, HIDDEN]) removeLeftovers(join(this.#out, folder), () => true);
      removeLeftovers(this.#out, (name) => name === TRACKS || name === 'ledger');
      this.#ledger.remove([TRACKS]);
    });
  }

  /** Writes the images of a frame; the keys are their folders. */
  async write(stem: string, images: { [folder: string]: Uint8Array }): Promise<void> {
    for (const [folder, bytes] of Object.entries(images)) {
      const path = `${folder}/${stem}.png`;
      await writing(this.#out, () => this.#ledger.write(path, bytes));
      this.#images.set(path, sha256(bytes));
    }
  }

  /** Removes images of frames that do not belong to the clip, and writes the record. */
  async end(frames: readonly FrameFile[], { width, height }: { width: number; height: number }, tracks: ClipTracks, changes: ClipChange[]): Promise<void> {
    const names = { frames: frames.map(({ stem }) => stem), files: frames.map(({ file }) => file) };
    const images = Object.fromEntries(this.#images);
    const content = { version: 1 as const, width, height, ...names, ...tracks, ...(changes.length > 0 && { changes }), settings: this.#settings, images };
    await writing(this.#out, async () => {
      this.#ledger.remove(await this.#ledger.old((path) => /^(labels|overlay)\//.test(path)));
      await this.#ledger.write(TRACKS, jsonLine(sealed(content, jobOf(this.#settings, frames))));
      this.#removeIfEmpty(HIDDEN);
      this.#ledger.settle();
    });
  }

  #removeIfEmpty(folder: string): void {
    try {
      rmdirSync(join(this.#out, folder));
    } catch {
      // It is not empty, or does not exist.
    }
  }
}

/** Hash of the settings, names and contents. */
function jobOf(settings: object, frames: readonly FrameFile[]): string {
  return sha256(JSON.stringify({ settings, frames: frames.map(({ stem, file, sha256 }) => [stem, file, sha256]) }));
}

/** Adds the hash that detects changes. */
function sealed(content: Omit<Record, 'job'>, job: string): Record {
  return { ...content, job: sha256(job + jsonLine(content)) };
}
