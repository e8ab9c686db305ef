// The pairs of an unfinished clip, and the state of a finished one: so that pairs are solved once, and that
// accepted frames stay what they were. A file begins with a hash of its content and of what that was made from, so a damaged one is as good as none.

import { readdirSync, rmSync } from 'node:fs';
import { join } from 'node:path';
import { deflateRawSync, inflateRawSync } from 'node:zlib';
import { HIDDEN } from './clip-folder.js';
import type { FrameFile } from './clip-store.js';
import { readWritten, sha256, writing } from './files.js';
import type { Output } from './output.js';

const STATE = 'state';
const PAIRS = '.pairs';
const ACCEPTED = '.accepted';
const OURS = /^state$|\.(pairs|accepted)$/;
/** Length of the hash in front, bytes. */
const HASH = 32;

export class KeptClip {
  readonly #output: Output;
  readonly #folder: string;
  readonly #frames: readonly FrameFile[];
  /** For each frame a hash of the settings, of its content and of that of the frames before it. */
  readonly #keys: string[] = [];

  /** `settings`: what decides how pairs are solved. */
  constructor(output: Output, settings: object, frames: readonly FrameFile[]) {
    this.#output = output;
    this.#folder = join(output.folder, HIDDEN);
    this.#frames = frames;
    let key = sha256(JSON.stringify(settings));
    for (const frame of frames) this.#keys.push((key = sha256(key + frame.sha256)));
  }

  pairs(index: number): Uint8Array | undefined {
    return this.#read(nameOf(index, PAIRS), this.#keys[index]);
  }

  keepPairs(index: number, pairs: Uint8Array): Promise<void> {
    return this.#write(nameOf(index, PAIRS), this.#keys[index], pairs);
  }

  state(): Uint8Array | undefined {
    return this.#read(STATE, this.#keys.at(-1));
  }

  /** The pairs are no longer needed. */
  async keepState(state: Uint8Array): Promise<void> {
    await this.#write(STATE, this.#keys.at(-1), state);
    await this.#remove(/\.pairs$/);
  }

  /** The labels with which a frame was accepted, whatever the settings were. */
  accepted(index: number): Uint8Array | undefined {
    const packed = this.#read(nameOf(index, ACCEPTED), this.#frames[index]?.sha256);
    return packed && new Uint8Array(inflateRawSync(packed));
  }

  /** Keeps labels of accepted frames, by index, and of no others. */
  async keepAccepted(labels: ReadonlyMap<number, Uint8Array>): Promise<void> {
    for (const [index, own] of labels) await this.#write(nameOf(index, ACCEPTED), this.#frames[index]?.sha256, deflateRawSync(own));
    const names = new Set([...labels.keys()].map((index) => nameOf(index, ACCEPTED)));
    await this.#remove(/\.accepted$/, names);
  }

  clear(): Promise<void> {
    return this.#remove(OURS);
  }

  #read(name: string, key: string | undefined): Uint8Array | undefined {
    try {
      const file = readWritten(join(this.#folder, name)) ?? Buffer.alloc(0);
      const content = new Uint8Array(file.subarray(HASH));
      return file.subarray(0, HASH).equals(hashOf(key, content)) ? content : undefined;
    } catch {
      return undefined;
    }
  }

  #write(name: string, key: string | undefined, content: Uint8Array): Promise<void> {
    return writing(this.#output.folder, () => this.#output.write(`${HIDDEN}/${name}`, Buffer.concat([hashOf(key, content), content]), HIDDEN));
  }

  #remove(isOld: RegExp, kept: ReadonlySet<string> = new Set()): Promise<void> {
    let names: string[] = [];
    try {
      names = readdirSync(this.#folder);
    } catch {
      // There is no folder.
    }
    return writing(this.#output.folder, () => names.filter((name) => isOld.test(name) && !kept.has(name)).forEach((name) => rmSync(join(this.#folder, name), { force: true })));
  }
}

function nameOf(index: number, ending: string): string {
  return String(index).padStart(5, '0') + ending;
}

function hashOf(key: string | undefined, content: Uint8Array): Buffer {
  return Buffer.from(sha256(Buffer.concat([Buffer.from(String(key)), content])), 'hex');
}
