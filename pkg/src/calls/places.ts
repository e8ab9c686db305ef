// Frames that are named instead of given, where something can read them: in Node.

import type { FrameFile, Pixels } from '../../types/index.js';

/** A call that takes two frames. */
export type PairCall<Frame, Options, Result> = (first: Frame, second: Frame, options?: Options) => Promise<Result>;

export interface Places {
  /** A frame, read if it is named. */
  frame(given: unknown): Promise<unknown>;
  /** A call whose frames may also be named. */
  pair<Options, Result>(call: PairCall<Pixels, Options, Result>): PairCall<Pixels | FrameFile, Options, Result>;
}
