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
  | { call: 'fitMotions'; measurements: PointMeasurements; options: FitOptions };

/** The compiled module comes with the first call of a worker. */
export type Request = { task: Task; module?: WebAssembly.Module };

export type Reply =
  | { kind: 'progress'; progress: Progress }
  | { kind: 'done'; result: Segmentation | MotionFit }
  | { kind: 'failed'; error: ErrorMessage };
