// The results of a clip in a folder: the images of each frame, and last tracks.json, which records what they were made from.

import { appendFileSync, existsSync, mkdirSync, readFileSync, rmdirSync, rmSync } from 'node:fs';
import { basename, join } from 'node:path';
import type { ClipTracks } from '../../types/index.js';
import { HIDDEN, LABELS, TRACKS } from './clip-folder.js';
import { jsonLine } from './pair.js';
import { removeLeftovers, sha256, writeFile, writing } from './store.js';

/** The content of tracks.json. */
export interface Record extends ClipTracks {
  version: 1;
  width: number;
  height: number;
  /** Names of the frames' images. */
  frames: string[];
  /** Names of the frames' own files. */
  files: string[];
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

/** While there is no tracks.json: names of all frames that may have images in the folder. */
const JOURNAL = join(HIDDEN, 'names');
const FOLDERS = [LABELS, 'overlay'];

export class ClipStore {
  readonly #out: string;
  readonly #settings: object;
  readonly #images = new Map<string, string>();

  constructor(out: string, settings: object) {
    this.#out = out;
    this.#settings = settings;
  }

  /** The record of a finished run on the same frames with the same settings, if nothing of it has changed. */
  finished(frames: readonly FrameFile[]): Record | undefined {
    try {
      const text = readFileSync(join(this.#out, TRACKS), 'utf8');
      const { job: _, ...content } = JSON.parse(text) as Record;
      const record = sealed(content, this.#jobOf(frames));
      if (jsonLine(record) !== text) return undefined;
      const whole = Object.entries(record.images).every(([path, hash]) => sha256(readFileSync(join(this.#out, path))) === hash);
      return whole ? record : undefined;
    } catch {
      return undefined; // Missing, foreign or damaged.
    }
  }

  /** Marks the folder, if it exists, as unfinished. Throws `write-failed`, as all methods that write do. */
  begin(): void {
    if (!existsSync(this.#out)) return;
    writing(this.#out, () => {
      for (const folder of [...FOLDERS, HIDDEN]) removeLeftovers(join(this.#out, folder), () => true);
      removeLeftovers(this.#out, (name) => name === TRACKS);
      for (const name of this.#namesOf(TRACKS, (text) => (JSON.parse(text) as Partial<Record>).frames ?? [])) this.#note(name);
      rmSync(join(this.#out, TRACKS), { force: true });
    });
  }

  /** Writes the images of a frame; the keys are their folders. */
  write(stem: string, images: { [folder: string]: Uint8Array }): void {
    writing(this.#out, () => {
      mkdirSync(this.#out, { recursive: true });
      this.#note(stem);
      for (const [folder, bytes] of Object.entries(images)) {
        mkdirSync(join(this.#out, folder), { recursive: true });
        writeFile(join(this.#out, folder), `${stem}.png`, bytes);
        this.#images.set(`${folder}/${stem}.png`, sha256(bytes));
      }
    });
  }

  /** Removes images of frames that do not belong to the clip, and writes the record. */
  end(frames: readonly FrameFile[], { width, height }: { width: number; height: number }, tracks: ClipTracks): void {
    const names = { frames: frames.map(({ stem }) => stem), files: frames.map(({ file }) => file) };
    const images = Object.fromEntries(this.#images);
    const content = { version: 1 as const, width, height, ...names, ...tracks, settings: this.#settings, images };
    writing(this.#out, () => {
      const old = this.#namesOf(JOURNAL, (text) => text.split('\n'));
      const paths = old.flatMap((name) => FOLDERS.map((folder) => `${folder}/${name}.png`));
      for (const path of paths) if (!this.#images.has(path)) rmSync(join(this.#out, path), { force: true });
      this.#removeIfEmpty('overlay');
      writeFile(this.#out, TRACKS, jsonLine(sealed(content, this.#jobOf(frames))));
      rmSync(join(this.#out, JOURNAL), { force: true });
      this.#removeIfEmpty(HIDDEN);
    });
  }

  /** Hash of the settings, names and contents. */
  #jobOf(frames: readonly FrameFile[]): string {
    return sha256(JSON.stringify({ settings: this.#settings, frames: frames.map(({ stem, file, sha256 }) => [stem, file, sha256]) }));
  }

  #note(name: string): void {
    mkdirSync(join(this.#out, HIDDEN), { recursive: true });
    appendFileSync(join(this.#out, JOURNAL), `${name}\n`);
  }

  /** Names of frames in a file; none if it is missing or foreign. */
  #namesOf(file: string, parse: (text: string) => unknown[]): string[] {
    try {
      const names = parse(readFileSync(join(this.#out, file), 'utf8'));
      return names.filter((name) => typeof name === 'string').filter((name) => name !== '' && name === basename(name));
    } catch {
      return [];
    }
  }

  #removeIfEmpty(folder: string): void {
    try {
      rmdirSync(join(this.#out, folder));
    } catch {
      // It is not empty, or does not exist.
    }
  }
}

/** Adds the hash that detects changes. */
function sealed(content: Omit<Record, 'job'>, job: string): Record {
  return { ...content, job: sha256(job + jsonLine(content)) };
}
