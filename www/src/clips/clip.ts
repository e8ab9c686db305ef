//! Films: a video file or a folder of frames, from which two frames are chosen by number.

import { PageError } from '../errors.js';
import { fingerprintOfFilm } from '../fingerprints.js';
import type { LoadedFrame } from '../frames.js';
import { quoted } from '../shell.js';
import { strings } from '../strings.js';

export interface Clip {
  readonly name: string;
  /** Number of frames. */
  readonly count: number;
  /** When each frame is shown, seconds; none for a folder. */
  readonly times: Float64Array | null;
  /** Whether frame `i` certainly is the `i`-th of the file. */
  readonly exact: boolean;
  /** Size of a frame as it is shown. */
  readonly width: number;
  readonly height: number;
  frame(index: number, longestSide: number): Promise<LoadedFrame>;
  /** Small pictures of the frames named, in this order, for a timeline; `draw` puts one into a canvas of any size. */
  thumbnails(indices: readonly number[], draw: (index: number, picture: Picture) => void): Promise<void>;
  /** Gives back decoders and memory. */
  close(): void;
}

/** Draws itself into the rectangle. */
export type Picture = (context: CanvasRenderingContext2D, x: number, y: number, width: number, height: number) => void;

const FILM_NAMES = /\.(mp4|m4v|mov|webm|mkv)$/i;

export function looksLikeFilm(file: File): boolean {
  return file.type.startsWith('video/') || FILM_NAMES.test(file.name);
}

/**
 * Opens a video: with exact frames where the browser has WebCodecs and the codec, else by seeking, which the clip then says.
 * Throws a {@link PageError} when the browser can do neither: `unsupported-codec` where that is the codec's fault, else `unreadable-video`.
 */
export async function openClip(file: File): Promise<Clip> {
  const fingerprint = await fingerprintOfFilm(file).catch(() => {
    throw new PageError('unreadable-video', strings.errors.unreadableVideo(file.name));
  });
  if (typeof VideoDecoder === 'function') {
    const { openExact } = await import('./exact.js');
    const clip = await openExact(file, fingerprint);
    if (clip !== null) return clip;
  }
  const { openApproximate } = await import('./approximate.js');
  const clip = await openApproximate(file, fingerprint);
  if (clip !== null) return clip;
  const { undecodable } = await import('./exact.js');
  const codec = await undecodable(file);
  if (codec === null) throw new PageError('unreadable-video', strings.errors.unreadableVideo(file.name));
  throw new PageError('unsupported-codec', strings.errors.unsupportedCodec(file.name, codec, conversion(file.name)));
}

/** Converts a video into one that every browser plays; some play no more than eight bits a sample. */
function conversion(name: string): string {
  const output = `${name.replace(/\.[^.]*$/, '')}-h264.mp4`;
  return `ffmpeg -i ${quoted(name)} -c:v libx264 -pix_fmt yuv420p ${quoted(output)}`;
}

/** The name of a frame in lists and files, "clip.mp4 #12", and what it is known by. */
export function knownInFilm(name: string, fingerprint: string, index: number): Pick<LoadedFrame, 'name' | 'fingerprint'> {
  return { name: `${name} #${index}`, fingerprint: `${fingerprint} ${index}` };
}
