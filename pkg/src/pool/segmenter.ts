// The same calls in workers: one, or a pool of them.

import type * as calls from '../../types/index.js';
import type {
  CallOptions,
  Clip,
  ClipFrames,
  ClipStream,
  MotionFit,
  OpenOptions,
  PairInput,
  PairOptions,
  PairOutcome,
  PairsOptions,
  Pixels,
  PoolOptions,
  Progress,
  Segmentation,
  SegmenterOptions,
  SegmentOptions,
  StreamOptions,
  StreamSource,
  WasmSource,
  WorkerLike,
} from '../../types/index.js';
import { buffersOfTask, type CallTask, type Result, type Task } from '../calls/messages.js';
import { inOrder } from '../calls/ordered.js';
import type { PairCall } from '../calls/places.js';
import type { House } from '../calls/session/clip.js';
import { type ClipHost, openedClip } from '../calls/session/open.js';
import { streamOf } from '../calls/stream.js';
import { fitCall, parted, segmentCall, solveCall, start } from '../calls/tasks.js';
import { entriesOf, invalidInput, invalidOption, isWhole, optionsObject, reading } from '../common/checks.js';
import { cancelled, VeroneseError } from '../common/errors.js';
import type { Core, Glue } from '../module/core.js';
import { WorkerPool } from './pool.js';
import { spawnWith } from './threads.js';

/** Most workers of one pool: more is a mistake, not a wish. */
export const MOST_JOBS = 256;

/** Needs of the classes that differ by the place where they run. */
export interface Host extends ClipHost {
  newCore: () => Core<Glue>;
  /** For measurements. */
  newPoints: () => Core<Glue>;
  /** Makes a worker where the caller does not. */
  worker: () => WorkerLike;
  /** Default number of workers. */
  jobs: () => number;
}

/** The classes for one host. */
export function segmenters(host: Host) {
  class Segmenter {
    readonly #pool: WorkerPool<Task, Result>;
    readonly #perform = (task: CallTask, options: CallOptions) => this.#pool.run(task, options);

    /** A worker for a clip or a stream. */
    readonly #house: House = (onLost) => {
      const { perform, beside, release } = this.#pool.pin(onLost);
      return { perform, beside, release, anywhere: this.#perform, size: this.#pool.size, endIdle: () => this.#pool.endIdle() };
    };

    constructor(source?: WasmSource | Promise<WasmSource>, options?: SegmenterOptions, jobs = 1) {
      const { worker = host.worker, points: place } = workerOptions(options);
      const [core, points] = [host.newCore(), host.newPoints()];
      const frames = () => core.module(source);
      const measurements = () => points.module(place);
      const supply = ({ call }: Task) => (call === 'fitMotions' ? measurements : frames);
      this.#pool = new WorkerPool(spawnWith(worker, buffersOfTask), supply, jobs);
    }

    segmentPair(...given: Parameters<typeof calls.segmentPair>): Promise<Segmentation> {
      const call: PairCall<Pixels, SegmentOptions, Segmentation> = (...pair) => start(() => segmentCall(...pair), this.#perform);
      return host.places.pair(call)(...given);
    }

    solvePair(...given: Parameters<typeof calls.solvePair>): Promise<Uint8Array> {
      const call: PairCall<Pixels, PairOptions, Uint8Array> = (...pair) => start(() => solveCall(...pair), this.#perform);
      return host.places.pair(call)(...given);
    }

    fitMotions(...given: Parameters<typeof calls.fitMotions>): Promise<MotionFit> {
      return start(() => fitCall(...given), this.#perform);
    }

    openClip(frames: ClipFrames, options?: OpenOptions): Promise<Clip> {
      return openedClip(frames, options, this.#house, host);
    }

    segmentStream(frames: StreamSource, options?: StreamOptions): ClipStream {
      return streamOf(frames, options, this.#house, host.places);
    }

    async warmUp(): Promise<void> {
      await this.#pool.rest({ call: 'warmUp' });
    }

    close(): void {
      this.#pool.close();
    }
  }

  class SegmenterPool extends Segmenter {
    readonly jobs: number;

    constructor(options?: PoolOptions) {
      const { jobs = host.jobs(), source, ...rest } = reading(() => entriesOf(options, ['jobs', 'source', ...WORKER]));
      super(source as PoolOptions['source'], rest, checkedJobs(jobs));
      this.jobs = jobs as number;
    }

    async *segmentPairs<Input extends PairInput>(
      pairs: Iterable<Input | Promise<Input>> | AsyncIterable<Input>,
      options?: PairsOptions,
    ): AsyncGenerator<PairOutcome<Input>, void, undefined> {
      const { signal, onProgress, ...rest } = reading(() => checkedPairsOptions(pairs, options));
      if (signal?.aborted) throw cancelled(signal);
      // Ends what is under way when the reader stops early or the caller's signal is aborted.
      const ending = new AbortController();
      const end = () => ending.abort(signal?.reason);
      signal?.addEventListener('abort', end);
      const work = async (input: Input, index: number): Promise<PairOutcome<Input>> => {
        try {
          const { first, second } = reading(() => framesOf(input));
          const listener = onProgress && ((progress: Progress) => onProgress({ ...progress, pair: index }));
          const call = { signal: ending.signal, onProgress: listener };
          const segmentation = await this.segmentPair(first, second, { ...rest, ...call });
          return { index, input, segmentation };
        } catch (thrown) {
          // An error that is not of the package was thrown by the listener.
          const error = thrown instanceof VeroneseError ? thrown : new VeroneseError('cancelled', 'the listener threw', { cause: thrown });
          return { index, input, error };
        }
      };
      try {
        // As many again as there are workers: a slow pair leaves the other workers something to do.
        yield* inOrder(pairs, work, { room: 2 * this.jobs, signal, stop: () => cancelled(signal) });
      } finally {
        signal?.removeEventListener('abort', end);
        ending.abort();
      }
    }
  }

  async function* segmentPairs<Input extends PairInput>(
    pairs: Iterable<Input | Promise<Input>> | AsyncIterable<Input>,
    options?: PairsOptions & PoolOptions,
  ): AsyncGenerator<PairOutcome<Input>, void, undefined> {
    const { jobs, source, points, worker, ...rest } = reading(() => ({ ...optionsObject(options) })) as PairsOptions & PoolOptions;
    const pool = new SegmenterPool({ jobs, source, points, worker });
    try {
      yield* pool.segmentPairs(pairs, rest);
    } finally {
      pool.close();
    }
  }

  return { Segmenter, SegmenterPool, segmentPairs };
}

/** Names of {@link SegmenterOptions}. */
const WORKER = ['worker', 'points'];

function workerOptions(options: unknown): SegmenterOptions {
  const { worker, ...rest } = reading(() => entriesOf(options, WORKER));
  if (worker === undefined || typeof worker === 'function') return { worker: worker as SegmenterOptions['worker'], ...rest };
  throw invalidOption('worker', 'a function that makes a worker', worker);
}

function checkedJobs(jobs: unknown): number {
  if (isWhole(jobs, 1, MOST_JOBS)) return jobs;
  throw invalidOption('jobs', `a whole number from 1 to ${MOST_JOBS}`, jobs);
}

function checkedPairsOptions(pairs: unknown, options: unknown): PairsOptions {
  const iterable = Object(pairs) as Partial<Iterable<unknown> & AsyncIterable<unknown>>;
  if (typeof iterable[Symbol.asyncIterator] !== 'function' && typeof iterable[Symbol.iterator] !== 'function') {
    throw invalidInput('the pairs must be an iterable or async iterable of { first, second }');
  }
  const rest = optionsObject(options);
  // The rest is that of each pair.
  parted({ signal: rest.signal, onProgress: rest.onProgress }, []);
  return rest;
}

function framesOf(input: unknown): PairInput {
  const { first, second } = Object(input) as PairInput;
  return { first, second };
}
