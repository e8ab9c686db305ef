// Frames that are named instead of given, where something can read them: in Node.

import type { FrameFile, Pixels, SegmentOptions } from '../../types/index.js';

/** A call that takes two frames. */
export type PairCall<Frame, Options, Result> = (first: Frame, second: Frame, options?: Options) => Promise<Result>;

export interface Places {
  /** A frame, read if it is named; one that is larger than `maxSize` is scaled down. */
  frame(given: unknown, maxSize?: number): Promise<unknown>;
  /** A call whose frames may also be named. */
  pair<Options extends SegmentOptions, Result>(call: PairCall<Pixels, Options, Result>): PairCall<Pixels | FrameFile, Options, Result>;
}
