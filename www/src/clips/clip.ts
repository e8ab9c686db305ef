//! A clip: a video or a folder of frames, which are read by index.

import type { DecodedFrame } from '../frames/frame.js';
import type { Sample } from '../frames/samples.js';

export interface Clip {
  readonly name: string;
  /** The sample that it is, if it is one. */
  readonly sample?: Sample | undefined;
  /** Identifies the clip by its content. */
  readonly fingerprint: string;
  /** Number of frames. */
  readonly count: number;
  /** Presentation time of each frame, seconds; `null` for a folder. */
  readonly times: Float64Array | null;
  /** Display size of a frame, pixels. */
  readonly width: number;
  readonly height: number;
  frame(index: number, longestSide: number): Promise<DecodedFrame>;
  /** Calls `draw` with a thumbnail of each of these frames, in this order. */
  thumbnails(indices: readonly number[], draw: (index: number, picture: Picture) => void): Promise<void>;
  /** The name of a frame's file; of a frame of a video, what its file would be called. */
  nameOf(index: number): string;
  /** The first frame of another size; absent if there can be none. */
  otherSize?(): Promise<OtherSize | null>;
  /** Releases decoders and memory. */
  close(): void;
}

/** Of folders, whose frames have no times. */
export const FRAMES_PER_SECOND = 25;

/** A frame whose size is not that of the clip, pixels. */
export interface OtherSize {
  readonly index: number;
  readonly width: number;
  readonly height: number;
}

/** Draws the thumbnail into the rectangle. */
export type Picture = (context: CanvasRenderingContext2D, x: number, y: number, width: number, height: number) => void;

/** The name that a file of a video's frame would have: `00012.png`. */
export function fileNameOf(index: number): string {
  return `${String(index).padStart(5, '0')}.png`;
}

/** The name of a frame of a video, "clip.mp4 #12", and its fingerprint. */
export function identityOf(name: string, fingerprint: string, index: number): Pick<DecodedFrame, 'name' | 'fingerprint'> {
  return { name: `${name} #${index}`, fingerprint: `${fingerprint} ${index}` };
}
