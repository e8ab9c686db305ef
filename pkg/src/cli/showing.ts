// What `clip --show` makes of a result besides masks: films, a sheet of some frames, and objects cut out of the frames.

import { type ChildProcess, spawn } from 'node:child_process';
import { once } from 'node:events';
import { join } from 'node:path';
import type { ClipFrame, Pixels } from '../../types/index.js';
import { UNLABELLED } from '../common/checks.js';
import { VeroneseError } from '../common/errors.js';
import { scaled } from '../common/scaling.js';
import { encodePng } from '../entries/codecs.js';
import { overlay } from './overlay.js';

/** N is the number of an object. */
export const SHOWN = [
  ...['overlay', 'beside'].flatMap((kind) => ['mp4', 'webm', 'gif'].map((format) => `${kind}.${format}`)),
  'sheet.png',
  'cutout-N',
  'cutout-N.webm',
  'cutout-N.mov',
];

/** A file, or a folder of a picture for each frame. */
export interface Shown {
  name: string;
  kind: 'overlay' | 'beside' | 'sheet' | 'cutout';
  /** That is cut out. */
  object: number;
  /** Of a film. */
  format: keyof typeof ENCODERS | undefined;
}

/** Sides of films with half the resolution in colours must be even: one more row or column is black. */
const EVEN = 'pad=ceil(iw/2)*2:ceil(ih/2)*2';
const VP9 = ['-c:v', 'libvpx-vp9', '-crf', '24', '-b:v', '0', '-row-mt', '1', '-cpu-used', '4'];

/** How ffmpeg encodes a film by the end of its name, without and with transparency. */
const ENCODERS = {
  mp4: { opaque: ['-vf', EVEN, '-c:v', 'libx264', '-crf', '18', '-pix_fmt', 'yuv420p', '-movflags', '+faststart'] },
  webm: {
    opaque: ['-vf', EVEN, ...VP9, '-pix_fmt', 'yuv420p'],
    // Frames that are not shown cannot be transparent.
    transparent: ['-vf', EVEN, ...VP9, '-pix_fmt', 'yuva420p', '-auto-alt-ref', '0'],
  },
  gif: { opaque: ['-vf', 'split[a][b];[a]palettegen[p];[b][p]paletteuse', '-loop', '0'] },
  mov: { transparent: ['-c:v', 'prores_ks', '-profile:v', '4444', '-pix_fmt', 'yuva444p10le', '-vendor', 'apl0'] },
} satisfies Record<string, { opaque?: readonly string[]; transparent?: readonly string[] }>;

/** Of a sheet: frames in all and in a row, the longest side of one and the space between them, pixels. */
const SHEET = { most: 12, columns: 4, longest: 480, space: 4 };

/** What a name stands for; undefined where it stands for nothing. */
export function shownOf(name: string): Shown | undefined {
  const [, kind, number = '0', end] = /^(overlay|beside|sheet|cutout(?=-\d))(?:-(0|[1-9]\d*))?(?:\.(\w+))?$/.exec(name) ?? [];
  const pattern = name.replace(/-\d+/, '-N');
  if (kind === undefined || !SHOWN.includes(pattern) || Number(number) >= UNLABELLED) return undefined;
  const format = end === 'png' ? undefined : (end as Shown['format']);
  return { name, kind: kind as Shown['kind'], object: Number(number), format };
}

/** The paths of what is shown of frames with these names. */
export function pathsOf(shown: readonly string[], stems: readonly string[]): string[] {
  return shown.flatMap((name) => (/^cutout-\d+$/.test(name) ? stems.map((stem) => `${name}/${stem}.png`) : [name]));
}

/** Whether a path may be one of something shown. */
export function isShown(path: string): boolean {
  return shownOf(path.replace(/\/[^/]*$/, '')) !== undefined;
}

/** Throws `ffmpeg-missing` where films are wanted that nothing can write. */
export async function checkFilms(shown: readonly Shown[]): Promise<void> {
  const film = shown.find(({ format }) => format !== undefined);
  if (!film) return;
  const ffmpeg = spawn('ffmpeg', ['-version'], { stdio: 'ignore' });
  await once(ffmpeg, 'close').catch((error: Error) => {
    const sentence = `'${film.name}' is written by the program ffmpeg, which cannot be started: install it (https://ffmpeg.org), or ask for pictures: '--overlay', '--show sheet.png,cutout-1'`;
    throw new VeroneseError('ffmpeg-missing', sentence, { cause: error });
  });
}

export type Showing = ReturnType<typeof shownOn>;

/** What is shown of a clip. `folder` is that of what is not complete; `count` is the number of frames, `rate` that of the films. */
export function shownOn(all: readonly Shown[], { folder, count, rate }: { folder: () => string; count: number; rate: number }) {
  const films = new Map<string, Film>();
  const tiles: Pixels[] = [];
  const filmOf = (shown: Shown, width: number, height: number): Film => {
    const film = films.get(shown.name) ?? new Film(shown, join(folder(), shown.name), { width, height, rate });
    films.set(shown.name, film);
    return film;
  };
  const isOnSheet = (index: number) => {
    const most = Math.min(SHEET.most, count) - 1;
    return index === Math.round((Math.round((index * most) / (count - 1)) * (count - 1)) / most);
  };
  return {
    /** Takes the next frame; returns its pictures by the folders that they belong to. */
    async add({ index, labels }: ClipFrame, { data, width, height }: Pixels): Promise<{ [folder: string]: Uint8Array }> {
      const pictures: { [folder: string]: Uint8Array } = {};
      let painted: Uint8Array | undefined;
      for (const shown of all) {
        const { name, kind, object, format } = shown;
        if (kind === 'cutout') {
          const cut = cutOut(data, labels, object);
          if (format) await filmOf(shown, width, height).take(cut);
          else pictures[name] = await encodePng(width, height, cut);
          continue;
        }
        painted ??= overlay(data as Uint8Array, labels);
        if (kind === 'beside') await filmOf(shown, 2 * width, height).take(beside(data, painted, width));
        else if (kind === 'overlay') await filmOf(shown, width, height).take(painted);
        else if (isOnSheet(index)) tiles.push(scaled({ data: painted, width, height }, SHEET.longest));
      }
      return pictures;
    },
    /** Ends the films, which are in the folder then; returns the sheet, if one is wanted. */
    async end(): Promise<{ films: string[]; sheet: Uint8Array | undefined }> {
      for (const film of films.values()) await film.end();
      return { films: [...films.keys()], sheet: tiles.length > 0 ? await sheetOf(tiles) : undefined };
    },
    close(): void {
      for (const film of films.values()) film.close();
    },
  };
}

/** A film that ffmpeg encodes from RGB, or from RGBA where it has transparency. */
class Film {
  readonly #name: string;
  readonly #ffmpeg: ChildProcess;
  readonly #ended: Promise<unknown>;
  #messages = '';

  constructor({ name, kind, format }: Shown, path: string, { width, height, rate }: { width: number; height: number; rate: number }) {
    this.#name = name;
    const encoder: { opaque?: readonly string[]; transparent?: readonly string[] } = ENCODERS[format as keyof typeof ENCODERS];
    const [pixels, output = []] = kind === 'cutout' ? ['rgba', encoder.transparent] : ['rgb24', encoder.opaque];
    const input = `-v error -y -f rawvideo -pix_fmt ${pixels} -s ${width}x${height} -framerate ${rate} -i pipe:0`;
    const args = [...input.split(' '), ...output, `file:${path}`];
    this.#ffmpeg = spawn('ffmpeg', args, { stdio: ['pipe', 'ignore', 'pipe'] });
    this.#ffmpeg.stderr?.on('data', (piece) => (this.#messages += String(piece)));
    // Why it takes no more shows when it ends.
    this.#ffmpeg.stdin?.on('error', () => undefined);
    this.#ended = once(this.#ffmpeg, 'close').catch(() => undefined);
  }

  /** Resolves when it takes more. */
  async take(bytes: Uint8Array): Promise<void> {
    const { stdin } = this.#ffmpeg;
    if (stdin && !stdin.write(bytes)) await Promise.race([once(stdin, 'drain').catch(() => undefined), this.#ended]);
    if (this.#ffmpeg.exitCode !== null) await this.end();
  }

  async end(): Promise<void> {
    this.#ffmpeg.stdin?.end();
    await this.#ended;
    if (this.#ffmpeg.exitCode === 0) return;
    const reason = this.#messages.trim().split('\n')[0] || `it ended with ${this.#ffmpeg.signalCode ?? `code ${this.#ffmpeg.exitCode}`}`;
    throw new VeroneseError('write-failed', `'${this.#name}' cannot be written by this ffmpeg: ${reason}`);
  }

  close(): void {
    this.#ffmpeg.kill('SIGKILL');
  }
}

/** RGBA of one object on a ground that is transparent. */
function cutOut(rgba: Pixels['data'], labels: Uint8Array, object: number): Uint8Array {
  const cut = new Uint8Array(rgba.length);
  labels.forEach((label, pixel) => {
    if (label === object) cut.set(rgba.subarray(4 * pixel, 4 * pixel + 4), 4 * pixel);
  });
  return cut;
}

/** RGB of a frame, and right of it what is painted over it. */
function beside(rgba: Pixels['data'], painted: Uint8Array, width: number): Uint8Array {
  const both = new Uint8Array(2 * painted.length);
  for (let pixel = 0; pixel < painted.length / 3; pixel++) {
    const at = 3 * (pixel + Math.floor(pixel / width) * width);
    for (let channel = 0; channel < 3; channel++) {
      both[at + channel] = rgba[4 * pixel + channel] as number;
      both[at + 3 * width + channel] = painted[3 * pixel + channel] as number;
    }
  }
  return both;
}

async function sheetOf(tiles: readonly Pixels[]): Promise<Uint8Array> {
  const { width, height } = tiles[0] as Pixels;
  const columns = Math.min(SHEET.columns, tiles.length);
  const rows = Math.ceil(tiles.length / columns);
  const [w, h] = [columns * (width + SHEET.space) - SHEET.space, rows * (height + SHEET.space) - SHEET.space];
  const sheet = new Uint8Array(3 * w * h).fill(255);
  for (const [k, { data }] of tiles.entries()) {
    const [left, top] = [(k % columns) * (width + SHEET.space), Math.floor(k / columns) * (height + SHEET.space)];
    for (let y = 0; y < height; y++) sheet.set(data.subarray(3 * y * width, 3 * (y + 1) * width), 3 * ((top + y) * w + left));
  }
  return encodePng(w, h, sheet);
}
