// The frames of a clip as the command line takes them: files or a video, looked through once, then read as often as they are wanted.

import { basename, extname } from 'node:path';
import type { Picture } from '../../types/codecs.js';
import { keyOf } from '../common/checks.js';
import { VeroneseError } from '../common/errors.js';
import type { ClipCommand } from './arguments.js';
import type { FrameFile } from './clip-store.js';
import { readInput, sha256 } from './files.js';
import { findFrames, isVideo, readList } from './frames.js';
import type { Io } from './io.js';
import { decoded } from './pair.js';
import { type Video, videoFrames, VideoReader } from './video.js';

/** A frame, and why it cannot be read if that is so. */
interface Seen extends FrameFile {
  /** As errors name it. */
  name: string;
  failure?: { thrown: unknown };
}

export class ClipFrames {
  readonly files: readonly Seen[];
  /** The files that are read. */
  readonly paths: readonly string[];
  /** Width and height of all frames, once one was read. */
  size: { width: number; height: number } | undefined;
  /** The first frame that could not be read. */
  failure: { index: number; thrown: unknown } | undefined;
  readonly #content: (index: number) => Promise<Uint8Array | undefined>;
  readonly #close: () => Promise<void>;
  #first = '';

  constructor(files: readonly Seen[], paths: readonly string[], content: (index: number) => Promise<Uint8Array | undefined>, close = async () => {}) {
    this.files = files;
    this.paths = paths;
    this.#content = content;
    this.#close = close;
    if (files.length < 2) {
      throw new VeroneseError('too-few-frames', `a clip needs two frames, found ${files.length === 0 ? 'none' : 'one'}`);
    }
  }

  get length(): number {
    return this.files.length;
  }

  /** Throws where the frame cannot be read, has another size than the others, or is no longer what it was; the frame is named. */
  readonly read = async (index: number): Promise<Picture> => {
    try {
      return await this.#read(index);
    } catch (thrown) {
      this.failure ??= { index, thrown };
      throw thrown;
    }
  };

  async close(): Promise<void> {
    await this.#close();
  }

  async #read(index: number): Promise<Picture> {
    const { name, failure, sha256: known } = this.files[index] as Seen;
    if (failure) throw failure.thrown;
    const bytes = await this.#content(index);
    if (!bytes) throw new VeroneseError('unreadable-video', `${name} is missing: the video had ${this.length} frames when it was read before`);
    if (sha256(bytes) !== known) throw new VeroneseError('invalid-input', `${name} has changed since it was read before`);
    const picture = await decoded({ name, bytes });
    const { width, height } = picture;
    if (!this.size) [this.size, this.#first] = [{ width, height }, name];
    if (width !== this.size.width || height !== this.size.height) {
      const sizes = `${width}×${height} pixels, ${this.#first} has ${this.size.width}×${this.size.height}`;
      throw new VeroneseError('frame-size-mismatch', `${name} has ${sizes}`);
    }
    return picture;
  }
}

/** Throws where there are too few frames, or two of one name. */
export async function clipFrames({ frames: names, list, every, allowDamaged }: ClipCommand, io: Io): Promise<ClipFrames> {
  const [name = ''] = names;
  if (names.length === 1 && list === undefined && isVideo(name)) return framesOfVideo({ file: name, every, allowDamaged }, io);
  const paths = findFrames(names, await readList(list, io.stdin)).filter((_, index) => index % every === 0);
  checkStems(paths);
  const files: Seen[] = [];
  for (const path of paths) {
    const frame = { name: path, stem: stemOf(path), file: basename(path) };
    try {
      files.push({ ...frame, sha256: sha256(await readInput(path)) });
    } catch (thrown) {
      files.push({ ...frame, sha256: undefined, failure: { thrown } });
    }
  }
  return new ClipFrames(files, paths, (index) => readInput(paths[index] as string));
}

function checkStems(paths: readonly string[]): void {
  const stems = new Map<string, string>();
  for (const path of paths) {
    const stem = stemOf(path);
    const other = stems.get(keyOf(stem));
    if (other !== undefined) throw new VeroneseError('invalid-input', `'${other}' and '${path}' would both be written to '${stem}.png'`);
    stems.set(keyOf(stem), path);
  }
}

function stemOf(path: string): string {
  return basename(path, extname(path));
}

/** A video that breaks off has a last frame that cannot be read. */
async function framesOfVideo(video: Video, io: Io): Promise<ClipFrames> {
  const { file, every } = video;
  const files: Seen[] = [];
  const seen = (number: number) => ({ name: `${basename(file)}#${number}`, stem: String(number).padStart(5, '0'), file: `${basename(file)}#${number}` });
  try {
    for await (const { bytes } of videoFrames(video, io)) files.push({ ...seen(files.length * every), sha256: sha256(bytes as Uint8Array) });
  } catch (thrown) {
    if (files.length === 0) throw thrown;
    files.push({ ...seen(files.length * every), sha256: undefined, failure: { thrown } });
  }
  const reader = new VideoReader({ ...video, quiet: true }, io);
  return new ClipFrames(files, [file], (index) => reader.read(index), () => reader.close());
}
