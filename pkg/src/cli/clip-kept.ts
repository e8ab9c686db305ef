// What an unfinished clip has found out about its frames, and what a finished one knows of them: so that pairs are solved once. A file
// begins with a hash of its content and of what that was made from, so a damaged one is as good as none.

import { mkdirSync, readdirSync, readFileSync, rmSync } from 'node:fs';
import { join } from 'node:path';
import { HIDDEN } from './clip-folder.js';
import type { FrameFile } from './clip-store.js';
import { sha256, writeFile, writing } from './store.js';

const STATE = 'state';
const PAIRS = '.pairs';
/** Length of the hash in front, bytes. */
const HASH = 32;

export class KeptClip {
  readonly #out: string;
  readonly #folder: string;
  /** For each frame a hash of the settings, of its content and of that of the frames before it. */
  readonly #keys: string[] = [];

  /** `settings`: what decides how pairs are solved. */
  constructor(out: string, settings: object, frames: readonly FrameFile[]) {
    this.#out = out;
    this.#folder = join(out, HIDDEN);
    let key = sha256(JSON.stringify(settings));
    for (const frame of frames) this.#keys.push((key = sha256(key + frame.sha256)));
  }

  pairs(index: number): Uint8Array | undefined {
    return this.#read(nameOf(index), this.#keys[index]);
  }

  keepPairs(index: number, pairs: Uint8Array): void {
    this.#write(nameOf(index), this.#keys[index], pairs);
  }

  state(): Uint8Array | undefined {
    return this.#read(STATE, this.#keys.at(-1));
  }

  /** The pairs are no longer needed. */
  keepState(state: Uint8Array): void {
    this.#write(STATE, this.#keys.at(-1), state);
    this.#remove((name) => name.endsWith(PAIRS));
  }

  clear(): void {
    this.#remove((name) => name.endsWith(PAIRS) || name === STATE);
  }

  #read(name: string, key: string | undefined): Uint8Array | undefined {
    try {
      const file = readFileSync(join(this.#folder, name));
      const content = new Uint8Array(file.subarray(HASH));
      return file.subarray(0, HASH).equals(hashOf(key, content)) ? content : undefined;
    } catch {
      return undefined;
    }
  }

  #write(name: string, key: string | undefined, content: Uint8Array): void {
    writing(this.#out, () => {
      mkdirSync(this.#folder, { recursive: true });
      writeFile(this.#folder, name, Buffer.concat([hashOf(key, content), content]));
    });
  }

  #remove(isOld: (name: string) => boolean): void {
    let names: string[] = [];
    try {
      names = readdirSync(this.#folder);
    } catch {
      // There is no folder.
    }
    writing(this.#out, () => names.filter(isOld).forEach((name) => rmSync(join(this.#folder, name), { force: true })));
  }
}

function nameOf(index: number): string {
  return String(index).padStart(5, '0') + PAIRS;
}

function hashOf(key: string | undefined, content: Uint8Array): Buffer {
  return Buffer.from(sha256(Buffer.concat([Buffer.from(String(key)), content])), 'hex');
}
