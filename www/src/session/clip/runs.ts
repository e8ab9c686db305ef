//! The workers of the clip, and the run under way in them: one at a time, another one takes its place.

import { SegmenterPool } from 'veronese';
import { PageError, codeOf } from '../../common/errors.js';
import { strings } from '../../common/strings.js';
import type { Store } from '../../state/state.js';
import type { Tracked } from '../../state/tracked.js';
import { report } from '../failures.js';

/** More workers than this are not worth their memory. */
const MOST_WORKERS = 8;

/** Of more than two processors one is left for the page, which needs a part of one. */
function workersFor(processors: number): number {
  return Math.min(processors > 2 ? processors - 1 : processors, MOST_WORKERS);
}

/** Changes what is known of the clip. */
export type Change = (change: Partial<Tracked>) => void;

/** How a run ends before it is done. */
interface Ends {
  /** A person cancels it. */
  readonly cancel: () => void;
  /** It was stopped at once. */
  readonly stopped: () => void;
}

export class ClipRuns {
  readonly segmenter: SegmenterPool;
  readonly #store: Store;
  #current: { readonly controller: AbortController; readonly ends: Ends } | null = null;

  constructor(store: Store, segmenter = new SegmenterPool({ jobs: workersFor(navigator.hardwareConcurrency || 1) })) {
    this.#store = store;
    this.segmenter = segmenter;
  }

  /** Runs `work` instead of what is under way. `set` changes what is known of the clip, unless the run has ended. */
  async run(ends: Ends, work: (signal: AbortSignal, set: Change) => Promise<void>): Promise<void> {
    this.interrupt();
    const controller = new AbortController();
    const own = (this.#current = { controller, ends });
    const { signal } = controller;
    const set: Change = (change) => {
      if (!signal.aborted) this.#store.clip(change);
    };
    try {
      await work(signal, set);
    } catch (error) {
      if (signal.aborted) return;
      set({ run: { phase: 'failed' } });
      report(this.#store, reported(error));
    } finally {
      if (this.#current === own) this.#current = null;
    }
  }

  /** Ends the run in the way that it provides. */
  cancel(): void {
    this.#current?.ends.cancel();
  }

  /** Stops the run at once; what is done stays. */
  stop(): void {
    if (this.#current === null || this.#store.get().tracked?.run.phase !== 'working') return;
    const { ends } = this.#current;
    this.interrupt();
    this.#current = null;
    ends.stopped();
  }

  /** Aborts the run for another one. */
  interrupt(): void {
    this.#current?.controller.abort();
  }
}

function reported(error: unknown): unknown {
  const code = codeOf(error);
  if (code === 'object-locked') return new PageError(code, strings.notices.locked);
  return code === 'invalid-option' ? new PageError('other-state', strings.notices.otherState) : error;
}
