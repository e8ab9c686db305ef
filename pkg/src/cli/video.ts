// Frames of a video, one after another, as the program ffmpeg decodes them.

import { execFile, spawn } from 'node:child_process';
import { basename } from 'node:path';
import { createInterface } from 'node:readline';
import { promisify } from 'node:util';
import type { Note } from '../../types/index.js';
import { isFrameRate, isRising } from '../common/checks.js';
import { VeroneseError } from '../common/errors.js';
import { checkedFile, readInput } from './files.js';
import { checkName, type Frame } from './frames.js';
import type { Io } from './io.js';
import { warn } from './terminal.js';

/** Longest side of a frame that is read at all; larger ones than the core takes are its own error. */
const LONGEST_SIDE = 32_768;
/** How much of the messages of ffmpeg is kept, characters. */
const KEPT = 4_000;
/** How much of what was decoded last is kept to be read again, bytes. */
const WINDOW = 256 * 1024 * 1024;

export interface Video {
  file: string;
  /** Only every K-th frame is taken. */
  every: number;
  /** Whether frames count that come with complaints of the decoder. */
  allowDamaged: boolean;
  /** Whether these complaints have been passed on before. */
  quiet?: boolean;
}

/** What ffmpeg reports about a video while it is read. */
export interface VideoInfo {
  /** Of each frame that is taken, seconds; NaN where there is none. */
  times: number[];
  /** Frames per second. */
  frameRate?: number;
  /** How brightness is coded, where it is not the usual way. */
  light?: string;
  /** Width to height of a pixel, where it is no square. */
  aspect?: string;
  /** Whether frames are of two moments each, line by line. */
  isInterlaced?: boolean;
  /** Width and height of the first frame, and of the first one with others, which is scaled to them. */
  size?: string;
  change?: { index: number; size: string };
}

/** Codes of brightness that go beyond that of a usual screen, as ffmpeg calls them. */
const LIGHT: Record<string, string> = { smpte2084: 'PQ', 'arib-std-b67': 'HLG' };

/** Times that differ by less than this are those of a constant rate: containers round them, some to milliseconds. */
const ROUNDED = 0.0021;

/** Rate and times of the frames, from the first one on, as far as they are known and none is before the one before it. */
export function timesOf({ times, frameRate }: VideoInfo, count: number, every: number): { frameRate?: number; timestamps?: number[] } {
  const rate = frameRate === undefined ? {} : { frameRate: frameRate / every };
  const timestamps = times.slice(0, count).map((time) => Number((time - (times[0] as number)).toFixed(6)));
  if (timestamps.length < count || !isRising(timestamps)) return rate;
  const steady = frameRate !== undefined && timestamps.every((time, k) => Math.abs(time - (k * every) / frameRate) < ROUNDED);
  const last = timestamps.at(-1) as number;
  if (steady || last === 0) return { ...rate, timestamps };
  return { frameRate: Number(((count - 1) / last).toFixed(6)), timestamps };
}

/** What is assumed of the video. */
export function notesOnVideo(file: string, { light, aspect, isInterlaced, size, change }: VideoInfo): Note[] {
  const combed = "what moves is combed in them; 'ffmpeg -i IN -vf bwdif=0 OUT' takes that away";
  const messages = {
    'video-hdr': light && `'${file}' is HDR (${light}): its brightness is taken as that of a usual video, without tone mapping`,
    'video-aspect': aspect && `the pixels of '${file}' are no squares but ${aspect}: frames have the pixels that are in the file`,
    'video-interlaced': isInterlaced && `'${file}' is interlaced, its frames are of two moments each: ${combed}`,
    'video-size':
      change &&
      `the frames of '${file}' change from ${size} to ${change.size} pixels, the first time at number ${change.index} of those taken: all are scaled to ${size}`,
  };
  return Object.entries(messages).flatMap(([code, message]) => (message ? [{ code, message }] : []));
}

/** Enters what a line of ffmpeg reports about the video. */
export function enter(about: VideoInfo, line: string): void {
  const [, time, size, fields] = /\bn: *\d+ pts: *\S+ pts_time: *(\S+)(?:.*?\bs:(\d+x\d+) i:(\w))?/.exec(line) ?? [];
  if (time !== undefined) {
    const index = about.times.push(Number(time)) - 1;
    if (fields === 'T' || fields === 'B') about.isInterlaced = true;
    if (size !== undefined && size !== (about.size ??= size)) about.change ??= { index, size };
  }
  // The first is that of the file; what is written has another.
  if (about.frameRate !== undefined || !/Stream #0:\d+.*: Video:/.test(line)) return;
  const rate = Number(/([\d.]+)(k?) fps\b/.exec(line)?.[1]);
  if (isFrameRate(rate)) about.frameRate = rate;
  const light = Object.keys(LIGHT).find((name) => line.includes(name));
  if (light !== undefined) about.light = LIGHT[light] as string;
  // The last is that of the container, which goes before that of the pictures.
  const [, aspect] = /.*\bSAR ([1-9]\d*:[1-9]\d*)/.exec(line) ?? [];
  if (aspect !== undefined && aspect !== '1:1') about.aspect = aspect;
}

/**
 * Every K-th frame as a portable pixmap, named `clip.mp4#12` by its number from 0. ffmpeg decodes no faster than frames are taken.
 * Throws `ffmpeg-missing`, `file-not-found` or `unreadable-video`, the last one after all frames if ffmpeg gave them but complained.
 */
export async function* videoFrames(
  { file, every, allowDamaged, quiet }: Video,
  io: Io,
  about?: VideoInfo,
): AsyncGenerator<Frame, void, undefined> {
  checkName(file);
  const { size } = checkedFile(file);
  const input = '-nostdin -hide_banner -nostats -v level+info -protocol_whitelist file,pipe -i'.split(' ');
  const filters = [...(every === 1 ? [] : [`select=not(mod(n\\,${every}))`]), ...(about ? ['showinfo'] : [])];
  // Each frame that is in the file, and none twice, whatever its time is.
  const exact = [...(await framesAsTheyAre()), ...'-an -sn -f image2pipe -c:v ppm -pix_fmt rgb24 pipe:1'.split(' ')];
  const ffmpeg = spawn(
    'ffmpeg',
    [...input, `file:${file}`, '-map', '0:v:0', ...(filters.length > 0 ? ['-vf', filters.join()] : []), ...exact],
    { stdio: ['ignore', 'pipe', 'pipe'] },
  );
  const end = () => void ffmpeg.kill('SIGKILL');
  io.signal.addEventListener('abort', end);
  let messages = '';
  createInterface(ffmpeg.stderr).on('line', (line) => {
    const [, problem] = /\[(?:panic|fatal|error)\] (.*)$/.exec(line) ?? [];
    if (problem !== undefined) messages = `${messages}${problem}\n`.slice(-KEPT);
    else if (about) enter(about, line);
  });
  const ended = new Promise<string | undefined>((resolve) => {
    ffmpeg.once('error', (error) => resolve(error.message));
    ffmpeg.once('close', (code, signal) => resolve(code === 0 ? undefined : `ffmpeg ended with ${signal ?? `code ${code}`}`));
  });
  try {
    let number = 0;
    for await (const bytes of pixmaps(ffmpeg.stdout, file)) {
      yield { name: `${basename(file)}#${number}`, stem: `frame-${String(number).padStart(6, '0')}`, bytes };
      number += every;
    }
    const problem = await ended;
    if (problem) throw new VeroneseError('unreadable-video', `'${file}' ${reasonIn(messages, file) ?? problem}`);
    const damage = lastLine(messages) ?? (await missingEnd(file, size));
    if (damage === undefined || (allowDamaged && quiet)) return;
    const sentence = `'${file}' is damaged, of ${number / every} frames that could be read some may be wrong: ${damage}`;
    if (!allowDamaged) throw new VeroneseError('unreadable-video', `${sentence}; '--allow-damaged' takes them as they are`);
    warn(io, sentence);
  } finally {
    io.signal.removeEventListener('abort', end);
    end();
  }
}

/**
 * Frames of a video in any order. Those that follow each other come from one run of ffmpeg; those before it from the frames that are
 * kept, else from another run.
 */
export function videoReader(video: Video, io: Io) {
  const kept = new Map<number, Uint8Array>();
  let run: ReturnType<typeof videoFrames> | undefined;
  /** Index of the frame that the run gives next, and bytes of those that are kept. */
  let [next, size] = [0, 0];
  /** Reads run one at a time: a frame may be read ahead while an earlier one is wanted again. */
  let queue: Promise<unknown> = Promise.resolve();
  const inTurn = <T>(work: () => Promise<T>): Promise<T> => {
    const turn = queue.then(work);
    queue = turn.catch(() => undefined);
    return turn;
  };
  const close = async () => {
    await run?.return();
    run = undefined;
    [next, size] = [0, 0];
    kept.clear();
  };
  const read = async (index: number) => {
    if (index < next && !kept.has(index)) await close();
    run ??= videoFrames(video, io);
    while (!kept.has(index)) {
      const { value } = await run.next();
      if (!value) return close();
      const { bytes } = value as { bytes: Uint8Array };
      kept.set(next++, bytes);
      size += bytes.length;
      for (const [old, { length }] of kept) {
        if (size <= WINDOW || kept.size === 1) break;
        kept.delete(old);
        size -= length;
      }
    }
    return kept.get(index);
  };
  return {
    /** The content of a frame, by its index among those that are taken; undefined after the last one. */
    read: (index: number): Promise<Uint8Array | undefined> => inTurn(async () => (await read(index)) ?? undefined),
    /** Ends the run. */
    close: () => inTurn(close),
  };
}

/** The option has had this name since 5.1; the older one went later. */
async function framesAsTheyAre(): Promise<string[]> {
  const { stdout } = await promisify(execFile)('ffmpeg', ['-version']).catch((error: Error) => {
    const sentence =
      'videos are read by the program ffmpeg, which cannot be started: install it (https://ffmpeg.org), or take the frames out by other means';
    throw new VeroneseError('ffmpeg-missing', sentence, { cause: error });
  });
  const [, major, minor] = (/^ffmpeg version n?(\d+)\.(\d+)/.exec(stdout) ?? []).map(Number);
  const old = major !== undefined && minor !== undefined && (major < 5 || (major === 5 && minor < 1));
  return old ? ['-vsync', 'passthrough'] : ['-fps_mode', 'passthrough'];
}

/** The message of ffmpeg when it ends with an error, as the end of a sentence that begins with the file. */
function reasonIn(messages: string, file: string): string | undefined {
  if (/matches no streams/.test(messages)) return 'has no pictures: there is no video stream in it';
  // Versions that read WebP read no animated ones at first.
  if (/\.webp$/i.test(file))
    return `cannot be read by this version of ffmpeg: take a newer one, or make it a PNG or GIF file (${lastLine(messages)})`;
  const line = lastLine(messages);
  return line && `cannot be read: ${line}`;
}

/** The missing bytes of a file that states its length (RIFF, as AVI). A cut between two frames is no error to ffmpeg. */
async function missingEnd(file: string, size: number): Promise<string | undefined> {
  const head = Buffer.from(await readInput(file, 8));
  const length = head.toString('latin1', 0, 4) === 'RIFF' && head.length === 8 ? head.readUInt32LE(4) + 8 : 0;
  // A file that was written to a pipe states no length, or the largest.
  return length > size && length < 2 ** 32 ? `it should have ${length} bytes and has ${size}` : undefined;
}

function lastLine(text: string): string | undefined {
  return text.trim().split('\n').at(-1) || undefined;
}

/** Cuts a stream of binary pixmaps into its pictures. */
export async function* pixmaps(stream: AsyncIterable<Uint8Array>, file: string): AsyncGenerator<Uint8Array, void, undefined> {
  let held: Uint8Array[] = [];
  /** Bytes that the next picture needs at least. */
  let missing = 0;
  for await (const chunk of stream) {
    held.push(chunk);
    missing -= chunk.length;
    if (missing > 0) continue;
    let rest = Buffer.concat(held);
    let length = lengthOf(rest, file);
    for (; length <= rest.length; length = lengthOf(rest, file)) {
      yield new Uint8Array(rest.subarray(0, length));
      rest = rest.subarray(length);
    }
    [held, missing] = [[rest], length - rest.length];
  }
  if (held.some(({ length }) => length > 0)) throw new VeroneseError('unreadable-video', `'${file}': the last frame is cut off`);
}

/** The length in bytes of the pixmap that begins here, or more than there is while its header is not whole. */
function lengthOf(bytes: Buffer, file: string): number {
  const header = bytes.subarray(0, 40).toString('latin1');
  const [text, width, height] = /^P6\s(\d+)\s(\d+)\s255\s/.exec(header) ?? [];
  if (text === undefined) {
    if (bytes.length < 40) return bytes.length + 1;
    const found = JSON.stringify(header.slice(0, 20));
    throw new VeroneseError('unreadable-video', `'${file}': ffmpeg gave something else than frames of 8 bits: ${found}`);
  }
  const sides = [Number(width), Number(height)] as const;
  if (Math.max(...sides) > LONGEST_SIDE)
    throw new VeroneseError('frame-size-unsupported', `the frames of '${file}' have ${sides.join(' × ')} pixels`);
  return text.length + 3 * sides[0] * sides[1];
}
