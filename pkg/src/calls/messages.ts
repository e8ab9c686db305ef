// The messages between the page and its worker.

import type {
  ClipAnnotation,
  ClipChange,
  ClipEntry,
  ClipFrame,
  ErrorCode,
  MotionFit,
  Pixels,
  PointMeasurements,
  Progress,
  Segmentation,
} from '../../types/index.js';
import type { ErrorMessage } from '../common/errors.js';
import { buffersOf } from './taking.js';

/** Options as the core takes them, all plain values; it refuses those that it cannot use. */
export type Settings = Record<string, unknown>;

export type Frames = readonly [first: Pixels, second: Pixels];

/** A call with arrays of its own and with what can be copied of its options: a signal stays behind, as does a listener. */
export type CallTask =
  | { call: 'segmentPair'; frames: Frames; settings: Settings }
  | { call: 'solvePair'; frames: Frames; settings: Settings }
  | { call: 'fitMotions'; measurements: PointMeasurements; settings: Settings }
  | ClipTask
  | StreamTask;

/** The calls on a clip, which `clip` numbers; wasm/src/clip.rs has what each returns. */
export type ClipTask = { clip: number } & (
  | { call: 'openClip'; frames: number; markUnknown: boolean; saved: Uint8Array | undefined }
  | { call: 'applyClip'; command: ClipCommand }
  | { call: 'moveClip'; what: 'undo' | 'redo' | 'cancel' | 'finish'; step: number }
  /** Without the frame if it is kept where the clip is. */
  | { call: 'takeClip'; index: number; frame: Pixels | undefined; solved: Uint8Array | undefined; draft: boolean }
  | { call: 'lookAtClip'; index: number | undefined }
  | { call: 'annotationsOfClip'; index: number }
  | { call: 'saveClip' | 'closeClip' }
);

/** What a clip is asked to do, as the core's `Command`. */
export type ClipCommand =
  | { type: 'segment'; first: number; last: number; options: Settings }
  | { type: 'annotate'; annotations: readonly AnnotationMessage[] }
  | { type: 'clear'; frame: number; object: number | undefined }
  | { type: 'accept'; frames: readonly number[]; on: boolean }
  | { type: 'lock'; objects: Uint8Array; on: boolean }
  | ({ type: 'describe'; on: boolean } & DescriptionMessage)
  | { type: 'merge' | 'delete'; objects: Uint8Array }
  | { type: 'split'; object: number; frame: number; new: number }
  | ({ type: 'replace' } & DeclarationMessage)
  | { type: 'restore'; saved: Uint8Array };

/** An annotation, as the core's `Annotation`. */
export interface AnnotationMessage {
  frame: number;
  propagate: string | undefined;
  content: 'strokes' | 'mask' | 'labels' | 'given' | 'prompt';
  object?: number;
  labels?: Uint8Array;
  /** Column, row and 1 for each pixel that is the object's, 0 for one that is not. */
  clicks?: readonly number[];
  /** Empty, or four sides. */
  box?: readonly number[];
}

export interface DescriptionMessage {
  object: number;
  name: string;
  class: string;
  colour: readonly number[] | undefined;
}

/** As the core's `Declaration`. */
export interface DeclarationMessage {
  annotations: readonly AnnotationMessage[];
  locked: Uint8Array;
  described: readonly DescriptionMessage[];
  merged: readonly Uint8Array[];
  deleted: Uint8Array;
  accepted: readonly number[];
}

/** What has happened in a clip since the call before, and what it wants next. */
export interface ClipAnswer {
  /** For the journal. */
  records?: Uint8Array;
  /** Whether they take the place of the journal so far. */
  replaces?: boolean;
  /** Indices of the frames whose labels have changed. */
  frames: number[];
  settled: SettledStep[];
  cancelled: number[];
  /** Steps that can be undone, that can be redone, and that have not taken effect. */
  steps: [undo: number, redo: number, waiting: number];
  wanted?: WantedFrame;
  status?: ClipStatus;
  /** Of `applyClip`: the number of the step. */
  step?: number;
  /** Of `moveClip`: whether there was something to do. */
  done?: boolean;
  /** Of `openClip`: the number of frames; of one that was saved, how many bytes were read, and whether the others are damaged. */
  length?: number;
  used?: number;
  isDamaged?: boolean;
  labels?: LabelledFrame;
  draft?: LabelledFrame;
}

export interface SettledStep {
  step: number;
  changes?: ClipChange[];
  /** The error, if it has failed. */
  code?: ErrorCode;
  message?: string;
}

export interface WantedFrame {
  frame: number;
  stage: 'pairs' | 'annotations' | 'labels';
  /** 0 for labels. */
  step: number;
  /** Whether its pixels are kept where the clip is. */
  isCached: boolean;
}

/** What is known of all frames and objects. */
export interface ClipStatus {
  /** Of each frame: 1 has masks, 2 accepted, 4 annotated. */
  flags: Uint8Array;
  revisions: Float64Array;
  objects: ClipEntry[];
  /** 0 if none is left. */
  nextObject: number;
  width: number;
  height: number;
  dropped: number;
  /** Indices of frames whose pairs are solved. */
  solved: number[];
}

/** The calls on a stream, which `stream` numbers. */
export type StreamTask = { stream: number } & (
  | { call: 'beginStream'; settings: Settings }
  | { call: 'pushStream'; frame: Pixels }
  | { call: 'finishStream' }
);

/** A warm-up gives way to any other task. */
export type Task = CallTask | { call: 'warmUp' };

/** A frame as the module gives it, which does not say the size again. */
export type LabelledFrame = Omit<ClipFrame, 'width' | 'height'>;

/** The frames that were still waiting at the end of a stream, and the number of objects beyond the last number. */
export interface StreamEnd {
  frames: LabelledFrame[];
  dropped: number;
}

/** The result of a task; null if its clip no longer exists. */
export type Result = Segmentation | MotionFit | LabelledFrame | ClipAnswer | StreamEnd | ClipAnnotation[] | Uint8Array | null | undefined;

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
  if ('frames' in task && typeof task.frames === 'object') return buffersOf(task.frames.map(({ data }) => data));
  const { frame, solved, saved, command } = task as Partial<{
    frame: Pixels;
    solved: Uint8Array;
    saved: Uint8Array;
    command: Partial<{ annotations: readonly AnnotationMessage[]; saved: Uint8Array }>;
  }>;
  return buffersOf([frame?.data, solved, saved, command?.saved, ...(command?.annotations ?? []).map(({ labels }) => labels)]);
}
