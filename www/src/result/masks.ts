//! The masks of one frame: a number for each pixel, that of an object of the clip, or the label of a motion.

import type { Segmentation } from 'veronese';

/** The number of pixels without a mask. 0 is the background. */
export const UNLABELLED = 255;

/** Labels by rows. */
export interface Labels {
  readonly labels: Uint8Array;
  readonly width: number;
  readonly height: number;
}

export interface FrameMasks extends Labels {
  /** Pixels of the background. */
  readonly rest: number;
  /** What has a mask here, the background aside. */
  readonly objects: readonly { readonly id: number; readonly pixels: number; readonly bbox: Segmentation['motions'][number]['bbox'] }[];
}
