// A step of a clip: a command that was given, until it has taken effect.

import type { ClipChange, ClipFrame, ClipStep } from '../../../types/index.js';
import type { VeroneseError } from '../../common/errors.js';
import type { Settings } from '../messages.js';

/** What a step asks of its clip. */
export interface StepClip {
  labels(index: number): Promise<ClipFrame>;
  cancelStep(step: Step): void;
  /** The labels of the frame that the step is about, when it has changed. */
  shownOf(step: Step): Promise<ClipFrame>;
}

export interface StepRange {
  first: number;
  last: number;
  /** Of its pairs. */
  options: Settings;
  drafts: boolean;
  /** Gives pairs that were solved elsewhere. */
  pairs: ((index: number) => unknown) | undefined;
}

/** What a step is about: a range of frames, or a frame, or objects. */
export interface StepSubject {
  range?: StepRange | undefined;
  frame?: number | undefined;
}

export class Step implements ClipStep {
  /** Its number, once the core has it. */
  number = 0;
  /** The frames whose labels it has changed; of a range all that have masks. */
  frames: readonly number[] = [];
  /** A frame that could not be read, or another reason to take it back. */
  failure: { thrown: unknown } | undefined;
  /** Why it is cancelled, if the caller has said so. */
  reason: VeroneseError | undefined;
  /** Whether its range is ended after the frames that are in. */
  isFinished = false;
  /** How many frames could not be read. */
  failures = 0;
  /** How many frames it has taken, if it annotates. */
  visits = 0;
  isCancelled = false;
  /** The objects that it may make. */
  objects: readonly number[] = [];
  readonly range: StepSubject['range'];
  readonly frame: StepSubject['frame'];
  readonly #clip: StepClip;
  /** Settled when the labels of its frame have changed. */
  readonly changed: Promise<void>;
  mark!: () => void;
  readonly #settled: Promise<readonly ClipChange[]>;
  #shown: Promise<ClipFrame> | undefined;
  resolve!: (changes: readonly ClipChange[]) => void;
  reject!: (reason: unknown) => void;

  constructor(clip: StepClip, { range, frame }: StepSubject) {
    this.#clip = clip;
    this.range = range;
    this.frame = frame;
    this.#settled = new Promise((resolve, reject) => {
      this.resolve = resolve;
      this.reject = reject;
    });
    this.changed = new Promise((resolve) => (this.mark = resolve));
    // Whoever does not wait for it learns of a failure by the event.
    this.#settled.catch(() => undefined);
  }

  get shown(): Promise<ClipFrame> {
    return (this.#shown ??= this.#clip.shownOf(this));
  }

  // oxlint-disable-next-line unicorn/no-thenable -- a step is awaited
  then<Value = readonly ClipChange[], Reason = never>(
    onSettled?: ((changes: readonly ClipChange[]) => Value | PromiseLike<Value>) | null,
    onFailed?: ((reason: unknown) => Reason | PromiseLike<Reason>) | null,
  ): Promise<Value | Reason> {
    return this.#settled.then(onSettled, onFailed);
  }

  cancel(): void {
    this.#clip.cancelStep(this);
  }

  /** If it fails, the frames that it has changed come first. */
  async *[Symbol.asyncIterator](): AsyncGenerator<ClipFrame, void, undefined> {
    const failure = await this.#settled.then(
      () => undefined,
      (thrown: unknown) => ({ thrown }),
    );
    const labelled = (at: number) => {
      const frame = this.frames[at];
      const labels = frame === undefined ? undefined : this.#clip.labels(frame);
      labels?.catch(() => undefined);
      return labels;
    };
    // The next frame is labelled while the reader looks at one.
    for (let at = 0, next = labelled(0); next; at++) {
      const frame = await next;
      next = labelled(at + 1);
      yield frame;
    }
    if (failure) throw failure.thrown;
  }
}
