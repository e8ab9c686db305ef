// The JavaScript of wasm-bindgen for the module of frames, as far as it is used here; scripts/glue.mjs puts the JavaScript beside the other
// compiled sources.

import type { Glue } from './core.js';

export type OnStage = (stage: string, index: number, of: number) => void;

export interface FramesGlue extends Glue {
  segmentPair(first: unknown, second: unknown, options: unknown, onStage: OnStage): unknown;
  solvePair(before: unknown, frame: unknown, options: unknown): unknown;

  openClip(clip: number, frames: number, markUnknown: boolean, saved?: Uint8Array): unknown;
  applyClip(clip: number, command: unknown): unknown;
  moveClip(clip: number, what: string, step: number): unknown;
  takeClip(clip: number, index: number, frame: unknown, solved: Uint8Array | undefined, draft: boolean): unknown;
  lookAtClip(clip: number, index?: number): unknown;
  annotationsOfClip(clip: number, index: number): unknown;
  saveClip(clip: number): unknown;
  closeClip(clip: number): void;

  beginStream(stream: number, options: unknown): void;
  pushStream(stream: number, frame: unknown): unknown;
  finishStream(stream: number): unknown;
}

export const glue: FramesGlue;
