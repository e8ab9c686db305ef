// The JavaScript of wasm-bindgen for wasm/src/frames.rs, as far as it is used here; scripts/glue.mjs puts the JavaScript beside the other
// compiled sources.

import type { Glue } from './core.js';

export type OnStage = (stage: string, index: number, of: number) => void;

export interface FramesGlue extends Glue {
  segmentPair(first: unknown, second: unknown, options: unknown, onStage: OnStage): unknown;

  beginClip(clip: number, whole: boolean, options: unknown): void;
  pushClip(clip: number, frame: unknown, known?: Uint8Array): unknown;
  previewClip(clip: number): unknown;
  finishClip(clip: number): unknown;
  concludeClip(clip: number): unknown;
  restoreClip(clip: number, state: Uint8Array, markUnknown: boolean): unknown;
  saveClip(clip: number): unknown;
  clipFrame(clip: number, index: number, frame: unknown): unknown;
  annotateClip(clip: number, annotations: unknown): unknown;
  takeAnnotations(clip: number, frame: unknown): unknown;
  endClip(clip: number): void;
}

export const glue: FramesGlue;
