//! Films: a video file or a folder of frames, from which two frames are chosen by number.

import type { DecodedFrame } from '../frames/frame.js';

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
  frame(index: number, longestSide: number): Promise<DecodedFrame>;
  /** Small pictures of the frames named, in this order, for a timeline; `draw` puts one into a canvas of any size. */
  thumbnails(indices: readonly number[], draw: (index: number, picture: Picture) => void): Promise<void>;
  /** Gives back decoders and memory. */
  close(): void;
}

/** Draws itself into the rectangle. */
export type Picture = (context: CanvasRenderingContext2D, x: number, y: number, width: number, height: number) => void;

/** The name of a frame in lists and files, "clip.mp4 #12", and what it is known by. */
export function knownInFilm(name: string, fingerprint: string, index: number): Pick<DecodedFrame, 'name' | 'fingerprint'> {
  return { name: `${name} #${index}`, fingerprint: `${fingerprint} ${index}` };
}
