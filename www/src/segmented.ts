//! Types of the package's call on whole clips whose states the page keeps.

import type { ClipOptions, ClipSource, SegmentedClip } from '../../pkg/src/calls/segmented/types.js';

export type { ClipEdits, ClipOptions, ClipProgress, ClipPropagation } from '../../pkg/src/calls/segmented/types.js';

declare module 'veronese' {
  interface Segmenter {
    segmentClip(frames: ClipSource, options?: ClipOptions): SegmentedClip;
  }
}
