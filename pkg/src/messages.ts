// What the page and its worker say to each other.

import type {
  FitOptions,
  MotionFit,
  Pixels,
  PointMeasurements,
  Progress,
  RelabelOptions,
  Segmentation,
  SegmentOptions,
} from '../types/index.js';
import type { ErrorMessage } from './errors.js';

/** A call with what can be copied of its options: a signal stays behind, and a listener becomes a flag. */
export type Task =
  | { call: 'segmentPair'; first: Pixels; second: Pixels; options: SegmentOptions }
  | {
      call: 'relabel';
      first: Pixels;
      second: Pixels;
      segmentation: Segmentation;
      evidence: Uint16Array;
      options: RelabelOptions;
    }
  | { call: 'fitMotions'; measurements: PointMeasurements; options: FitOptions }
  | { call: 'warmUp' };

/** What a task gives. */
export type Result = Segmentation | MotionFit | undefined;

/** The compiled module that a task needs comes with the first such task of a worker. */
export type Request<T = Task> = { task: T; module?: WebAssembly.Module };

export type Reply<R = Result> =
  | { kind: 'progress'; progress: Progress }
  | { kind: 'done'; result: R }
  | { kind: 'failed'; error: ErrorMessage };
