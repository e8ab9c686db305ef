// The frames of a clip as the command line takes them: files or a video, looked through once, then read as often as they are wanted.

import { basename, extname } from 'node:path';
import type { Picture } from '../../types/codecs.js';
import type { Note } from '../../types/index.js';
import { invalidInput, keyOf } from '../common/checks.js';
import { VeroneseError } from '../common/errors.js';
import type { ClipCommand } from './arguments.js';
import type { FrameFile } from './clip-store.js';
import { readInput, sha256 } from './files.js';
import { findFrames, leftOutNotes, readList, videoIn } from './frames.js';
import type { Io } from './io.js';
import { decodeImage } from '../entries/codecs.js';
import { decoded, type Decoding, narrowRange, type Range, rangeNote } from './pair.js';
import { notesOnVideo, timesOf, type Video, videoFrames, type VideoInfo, videoReader } from './video.js';

/** A frame, and why it cannot be read if that is so. */
interface Seen extends FrameFile {
  /** As errors name it. */
  name: string;
  failure?: { thrown: unknown };
}

/** Where frames come from, and what is known of all of them. */
interface Source {
  content: (index: number) => Promise<Uint8Array | undefined>;
  close?: () => Promise<void>;
  decoding: Decoding;
  times?: { frameRate?: number; timestamps?: number[] };
  notes: Note[];
}

export class ClipFrames {
  readonly files: readonly Seen[];
  /** The files that are read. */
  readonly paths: readonly string[];
  /** Width and height of all frames, once one was read. */
  size: { width: number; height: number } | undefined;
  /** The first frame that could not be read. */
  failure: { thrown: unknown } | undefined;
  /** When frames were taken, where that is known. */
  readonly times: NonNullable<Source['times']>;
  /** Samples of 16 bits that are black and white, where that was chosen. */
  readonly range: Range | undefined;
  /** What was assumed, as far as frames were read. */
  readonly notes: Note[];
  readonly #source: Source;
  #first = '';

  constructor(files: readonly Seen[], paths: readonly string[], source: Source) {
    this.files = files;
    this.paths = paths;
    this.#source = source;
    this.times = source.times ?? {};
    this.range = source.decoding.range;
    this.notes = [...source.notes, ...(this.range ? [rangeNote(this.range)] : [])];
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
      this.failure ??= { thrown };
      throw thrown;
    }
  };

  async close(): Promise<void> {
    await this.#source.close?.();
  }

  /** Each note once, however often a frame is read. */
  #add(note: Note): void {
    if (!this.notes.some(({ message }) => message === note.message)) this.notes.push(note);
  }

  async #read(index: number): Promise<Picture> {
    const { name, failure, sha256: known } = this.files[index] as Seen;
    if (failure) throw failure.thrown;
    const bytes = await this.#source.content(index);
    if (!bytes)
      throw new VeroneseError('unreadable-video', `${name} is missing: the video had ${this.length} frames when it was read before`);
    if (sha256(bytes) !== known) throw new VeroneseError('invalid-input', `${name} has changed since it was read before`);
    const picture = await decoded({ name, bytes }, { ...this.#source.decoding, onNote: (note) => this.#add(note) });
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
export async function clipFrames({ frames: names, list, every, allowDamaged, maxSize }: ClipCommand, io: Io): Promise<ClipFrames> {
  const video = await videoIn({ frames: names, list });
  if (video !== undefined) return framesOfVideo({ file: video, every, allowDamaged }, maxSize, io);
  const paths = findFrames(names, await readList(list, io.stdin)).filter((_, index) => index % every === 0);
  const files: Seen[] = [];
  const ranges: (Range | undefined)[] = [];
  const known = new Map<string, string>();
  for (const path of paths) {
    const stem = basename(path, extname(path));
    const other = known.get(keyOf(stem));
    if (other !== undefined) throw invalidInput(`'${other}' and '${path}' would both be written to '${stem}.png'`);
    known.set(keyOf(stem), path);
    const frame = { name: path, stem, file: basename(path) };
    try {
      const bytes = await readInput(path);
      files.push({ ...frame, sha256: sha256(bytes) });
      ranges.push(await rangeOf(bytes, maxSize));
    } catch (thrown) {
      files.push({ ...frame, sha256: undefined, failure: { thrown } });
    }
  }
  const decoding = { allowDamaged, maxSize, range: narrowRange(ranges) };
  return new ClipFrames(files, paths, { content: (index) => readInput(paths[index] as string), decoding, notes: leftOutNotes(names) });
}

/** The range of the samples in a file that has 16 bits of each. What cannot be read is an error when it is. */
async function rangeOf(bytes: Uint8Array, maxSize: number | undefined): Promise<Range | undefined> {
  const isDeepPng = bytes[0] === 0x89 && bytes[24] === 16;
  const isPnm = bytes[0] === 0x50 && bytes[1] !== undefined && bytes[1] >= 0x32 && bytes[1] <= 0x37;
  if (!isDeepPng && !isPnm) return undefined;
  return (await decodeImage(bytes, { maxSize }).catch(() => undefined))?.range;
}

/** A video that breaks off has a last frame that cannot be read. */
async function framesOfVideo(video: Video, maxSize: number | undefined, io: Io): Promise<ClipFrames> {
  const { file, every } = video;
  const files: Seen[] = [];
  const about: VideoInfo = { times: [] };
  const add = (more: Pick<Seen, 'sha256' | 'failure'>) => {
    const number = files.length * every;
    const name = `${basename(file)}#${number}`;
    files.push({ name, stem: String(number).padStart(5, '0'), file: name, ...more });
  };
  try {
    for await (const { bytes } of videoFrames(video, io, about)) add({ sha256: sha256(bytes as Uint8Array) });
  } catch (thrown) {
    if (files.length === 0) throw thrown;
    add({ sha256: undefined, failure: { thrown } });
  }
  const { read, close } = videoReader({ ...video, quiet: true }, io);
  return new ClipFrames(files, [file], {
    content: read,
    close,
    decoding: { maxSize },
    times: timesOf(about, files.length, every),
    notes: notesOnVideo(file, about),
  });
}
