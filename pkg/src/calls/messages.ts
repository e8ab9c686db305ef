// The messages between the page and its worker.

import type { ClipChange, ClipFrame, ClipPropagation, MotionFit, Pixels, PointMeasurements, Progress, Segmentation } from '../../types/index.js';
import type { ErrorMessage } from '../common/errors.js';
import { buffersOf } from './taking.js';

/** Options as the core takes them, all plain values; it refuses those that it cannot use. */
export type Settings = Record<string, unknown>;

export type Frames = readonly [first: Pixels, second: Pixels];

/** A call with arrays of its own and with what can be copied of its options: a signal stays behind, as does a listener. */
export type CallTask =
  | { call: 'segmentPair'; frames: Frames; settings: Settings }
  | { call: 'fitMotions'; measurements: PointMeasurements; settings: Settings }
  | ClipTask;

/** The steps of a clip from its first frame on; wasm/src/clip.rs has the results of each step. */
export type ClipStep =
  | { call: 'pushClip'; frame: Pixels; known?: Uint8Array }
  | { call: 'restoreClip'; state: Uint8Array; markUnknown: boolean }
  | { call: 'annotateClip'; annotations: Annotations }
  | { call: 'takeAnnotations'; frame: Pixels }
  | { call: 'clipFrame'; index: number; frame: Pixels }
  | { call: 'previewClip' | 'finishClip' | 'concludeClip' | 'saveClip' | 'endClip' };

/** `clip` is its number. */
export type ClipTask = { clip: number } & (ClipStep | { call: 'beginClip'; whole: boolean; settings: Settings });

/** A warm-up gives way to any other task. */
export type Task = CallTask | { call: 'warmUp' };

/** A frame as the module gives it, which does not say the size again. */
export type LabelledFrame = Omit<ClipFrame, 'width' | 'height'>;

/** The frames that were still waiting at the end of a clip, and the number of objects beyond the last number. */
export interface ClipEnd {
  frames: LabelledFrame[];
  dropped: number;
}

/** A clip of which every frame is known. */
export interface ClipSummary {
  length: number;
  width: number;
  height: number;
  dropped: number;
}

/** Annotations of a clip that are given together; those that are undefined are as before. */
export interface Annotations {
  masks: readonly Painted[];
  corrections: readonly Painted[];
  prompts: readonly Pointed[];
  accepted: readonly { frame: number; labels?: Uint8Array | undefined }[] | undefined;
  locked: Uint8Array | undefined;
  named: Uint8Array | undefined;
  /** Objects and the numbers that they get, in turn. */
  numbers: Uint8Array;
}

/** Labels of a frame: of one object, or a map. */
export interface Painted {
  frame: number;
  object?: number | undefined;
  labels: Uint8Array;
  propagate?: ClipPropagation | undefined;
}

/** Clicks and a box that point to an object in a frame. */
export interface Pointed {
  frame: number;
  object: number;
  /** Column, row and 1 for each pixel that is the object's, 0 for one that is not. */
  clicks: readonly number[];
  /** Empty, or four sides. */
  box: readonly number[];
  propagate?: ClipPropagation | undefined;
}

/** The changes by annotations since the step before, the frame that they want next, and when they want none all that they have changed. */
export interface Annotating {
  wanted?: number;
  changed: number[];
  changes?: ClipChange[];
  /** All objects, by their numbers before any edit. */
  objects?: number[];
}

/** The result of a task; null if its clip no longer exists. */
export type Result = Segmentation | MotionFit | LabelledFrame | ClipEnd | ClipSummary | Annotating | Uint8Array | null | undefined;

/** The compiled module that a task needs comes with the first such task of a worker. */
export type Request<T = Task> = { task: T; module?: WebAssembly.Module };

export type Reply<R = Result> =
  | { kind: 'progress'; progress: Progress }
  | { kind: 'done'; result: R }
  /** Of a task that gives way, and did not have to. */
  | { kind: 'rested'; error?: ErrorMessage }
  | { kind: 'failed'; error: ErrorMessage };

/** The buffers that are handed over to a worker instead of copied. */
export function buffersOfTask(task: Task): ArrayBuffer[] {
  if (task.call === 'fitMotions') return buffersOf(Object.values(task.measurements));
  if ('clip' in task) {
    const { frame, known, state, annotations } = task as Partial<{ frame: Pixels; known: Uint8Array; state: Uint8Array; annotations: Annotations }>;
    const { masks = [], corrections = [], accepted = [] } = annotations ?? {};
    return buffersOf([frame?.data, known, state, ...[...masks, ...corrections, ...accepted].map(({ labels }) => labels)]);
  }
  return 'frames' in task ? buffersOf(task.frames.map(({ data }) => data)) : [];
}
