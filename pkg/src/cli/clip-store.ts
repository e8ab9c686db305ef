// The results of a clip in a folder: images of each frame as they come, and tracks.json last, which says what they were made of.

import { appendFileSync, existsSync, mkdirSync, readFileSync, renameSync, rmdirSync, rmSync, writeFileSync } from 'node:fs';
import { basename, join } from 'node:path';
import type { ClipTracks } from '../../types/index.js';
import { writeFailed } from './files.js';
import { jsonLine } from './pair.js';
import { removeLeftovers, sha256, temporary } from './store.js';

/** What tracks.json holds. */
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
  /** Hash of everything that decides what the files hold, and of the rest of this record. */
  job: string;
}

/** A frame's name, file and content. */
export interface FrameFile {
  stem: string;
  file: string;
  sha256: string;
}

const TRACKS = 'tracks.json';
/** Names of all frames that may have images here while there is no tracks.json. */
const JOURNAL = '.clip.names';
const FOLDERS = ['labels', 'overlay'];

export class ClipStore {
  readonly #out: string;
  readonly #settings: object;
  readonly #images = new Map<string, string>();

  constructor(out: string, settings: object) {
    this.#out = out;
    this.#settings = settings;
  }

  /** The record of a finished run on the same frames with the same settings, if nothing of it has changed. */
  async finished(frames: () => Promise<readonly FrameFile[]>): Promise<Record | undefined> {
    try {
      const text = readFileSync(join(this.#out, TRACKS), 'utf8');
      const { job: _, ...content } = JSON.parse(text) as Record;
      const record = sealed(content, this.#jobOf(await frames()));
      if (jsonLine(record) !== text) return undefined;
      const whole = Object.entries(record.images).every(([path, hash]) => sha256(readFileSync(join(this.#out, path))) === hash);
      return whole ? record : undefined;
    } catch {
      return undefined; // Not there, or not ours: to be done. What is wrong with a frame is said when it is.
    }
  }

  /** The folder, if there is one, is unfinished from now on. Throws `write-failed`, as do all that write. */
  begin(): void {
    if (!existsSync(this.#out)) return;
    this.#writing(() => {
      for (const folder of FOLDERS) removeLeftovers(join(this.#out, folder), () => true);
      removeLeftovers(this.#out, (name) => name === TRACKS);
      for (const name of this.#namesOf(TRACKS, (text) => (JSON.parse(text) as Partial<Record>).frames ?? [])) this.#note(name);
      rmSync(join(this.#out, TRACKS), { force: true });
    });
  }

  /** Writes a frame's images, by their folders. */
  write(stem: string, images: { [folder: string]: Uint8Array }): void {
    this.#writing(() => {
      mkdirSync(this.#out, { recursive: true });
      this.#note(stem);
      for (const [folder, bytes] of Object.entries(images)) {
        mkdirSync(join(this.#out, folder), { recursive: true });
        this.#write(join(this.#out, folder), `${stem}.png`, bytes);
        this.#images.set(`${folder}/${stem}.png`, sha256(bytes));
      }
    });
  }

  /** Removes images of frames that are no longer there, and writes the record. */
  end(frames: readonly (FrameFile & { width: number; height: number })[], tracks: ClipTracks): void {
    const { width = 0, height = 0 } = frames[0] ?? {};
    const names = { frames: frames.map(({ stem }) => stem), files: frames.map(({ file }) => file) };
    const images = Object.fromEntries(this.#images);
    const content = { version: 1 as const, width, height, ...names, ...tracks, settings: this.#settings, images };
    this.#writing(() => {
      const old = this.#namesOf(JOURNAL, (text) => text.split('\n'));
      const paths = old.flatMap((name) => FOLDERS.map((folder) => `${folder}/${name}.png`));
      for (const path of paths) if (!this.#images.has(path)) rmSync(join(this.#out, path), { force: true });
      this.#removeIfEmpty('overlay');
      this.#write(this.#out, TRACKS, jsonLine(sealed(content, this.#jobOf(frames))));
      rmSync(join(this.#out, JOURNAL), { force: true });
    });
  }

  /** The hash of contents and settings that a result is recognised by. */
  #jobOf(frames: readonly FrameFile[]): string {
    return sha256(JSON.stringify({ settings: this.#settings, frames: frames.map(({ stem, file, sha256 }) => [stem, file, sha256]) }));
  }

  #note(name: string): void {
    appendFileSync(join(this.#out, JOURNAL), `${name}\n`);
  }

  /** Names of frames in a file, none where there is no such file or it is not ours. */
  #namesOf(file: string, parse: (text: string) => unknown[]): string[] {
    try {
      const names = parse(readFileSync(join(this.#out, file), 'utf8'));
      return names.filter((name) => typeof name === 'string').filter((name) => name !== '' && name === basename(name));
    } catch {
      return [];
    }
  }

  /** Between two turns of the event loop, so that a signal comes before or after it. */
  #write(folder: string, name: string, content: Uint8Array | string): void {
    const part = join(folder, temporary(name));
    try {
      writeFileSync(part, content);
      renameSync(part, join(folder, name));
    } catch (thrown) {
      rmSync(part, { force: true });
      throw thrown;
    }
  }

  #removeIfEmpty(folder: string): void {
    try {
      rmdirSync(join(this.#out, folder));
    } catch {
      // It holds something, or is not there.
    }
  }

  #writing(write: () => void): void {
    try {
      write();
    } catch (thrown) {
      throw writeFailed(this.#out, thrown instanceof Error ? thrown.message : String(thrown));
    }
  }
}

/** The text of a record tells by itself whether it is still what was written. */
function sealed(content: Omit<Record, 'job'>, job: string): Record {
  return { ...content, job: sha256(job + jsonLine(content)) };
}
