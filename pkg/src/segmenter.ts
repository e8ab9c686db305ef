// The same calls in workers: one, or a pool of them.

import type {
  FitOptions,
  MotionFit,
  PairInput,
  PairOutcome,
  PairsOptions,
  Pixels,
  PointMeasurements,
  PoolOptions,
  Progress,
  RelabelOptions,
  Segmentation,
  SegmenterOptions,
  SegmentOptions,
  WasmSource,
  WorkerLike,
} from '../types/index.js';
import { checkedCorrection, checkedMeasurements, checkedPixels, splitOptions } from './api.js';
import type { Core, Glue } from './core.js';
import { cancelled, VeroneseError, veroneseError } from './errors.js';
import type { Result, Task } from './messages.js';
import { inOrder } from './ordered.js';
import { WorkerPool } from './pool.js';
import { spawnWith } from './threads.js';

/** Most workers of one pool: more is a mistake, not a wish. */
const MOST_JOBS = 256;

/** What differs between the package's entries. */
export interface Host {
  newCore: () => Core<Glue>;
  /** For measurements. */
  newPoints: () => Core<Glue>;
  /** Makes a worker where the caller does not. */
  worker: () => WorkerLike;
  /** Number of workers where the caller does not say. */
  jobs: () => number;
}

/** The classes for one host. */
export function segmenters(host: Host) {
  class Segmenter {
    readonly #pool: WorkerPool<Task, Result>;

    constructor(source?: WasmSource | Promise<WasmSource>, options: SegmenterOptions = {}, jobs = 1) {
      const [core, points] = [host.newCore(), host.newPoints()];
      const frames = () => core.module(source);
      const measurements = () => points.module(options.points);
      const supply = ({ call }: Task) => (call === 'fitMotions' ? measurements : frames);
      this.#pool = new WorkerPool(spawnWith(options.worker ?? host.worker), supply, jobs);
    }

    async segmentPair(first: Pixels, second: Pixels, options?: SegmentOptions): Promise<Segmentation> {
      const { call, rest } = splitOptions(options);
      const settings = rest.before === undefined ? rest : { ...rest, before: checkedPixels('the frame before', rest.before) };
      const frames = { first: checkedPixels('the first frame', first), second: checkedPixels('the second frame', second) };
      return (await this.#pool.run({ call: 'segmentPair', ...frames, options: settings }, call)) as Segmentation;
    }

    async relabel(
      first: Pixels,
      second: Pixels,
      segmentation: Segmentation,
      evidence: Uint16Array,
      options?: RelabelOptions,
    ): Promise<Segmentation> {
      const { call, rest } = splitOptions(options);
      const settings = rest.before === undefined ? rest : { before: checkedPixels('the frame before', rest.before) };
      const frames = { first: checkedPixels('the first frame', first), second: checkedPixels('the second frame', second) };
      checkedCorrection(segmentation, evidence);
      return (await this.#pool.run({ call: 'relabel', ...frames, segmentation, evidence, options: settings }, call)) as Segmentation;
    }

    async fitMotions(measurements: PointMeasurements, options?: FitOptions): Promise<MotionFit> {
      const { call, rest } = splitOptions(options);
      const checked = checkedMeasurements(measurements);
      return (await this.#pool.run({ call: 'fitMotions', measurements: checked, options: rest }, call)) as MotionFit;
    }

    async warmUp(): Promise<void> {
      await this.#pool.run({ call: 'warmUp' });
    }

    close(): void {
      this.#pool.close();
    }
  }

  class SegmenterPool extends Segmenter {
    readonly jobs: number;

    constructor({ jobs = host.jobs(), source, points, worker }: PoolOptions = {}) {
      super(source, { points, worker }, checkedJobs(jobs));
      this.jobs = jobs;
    }

    async *segmentPairs<Input extends PairInput>(
      pairs: Iterable<Input | Promise<Input>> | AsyncIterable<Input>,
      options?: PairsOptions,
    ): AsyncGenerator<PairOutcome<Input>, void, undefined> {
      const { signal, onProgress, ...rest } = checkedPairsOptions(pairs, options);
      if (signal?.aborted) throw cancelled(signal);
      // Ends what is under way when the reader stops early or the caller's signal says so.
      const ending = new AbortController();
      const end = () => ending.abort(signal?.reason);
      signal?.addEventListener('abort', end);
      const work = async (input: Input, index: number): Promise<PairOutcome<Input>> => {
        try {
          const { first, second, before } = Object(input) as Input;
          const listener = onProgress && ((progress: Progress) => onProgress({ ...progress, pair: index }));
          const call = { signal: ending.signal, onProgress: listener };
          const segmentation = await this.segmentPair(first, second, { ...rest, before, ...call });
          return { index, input, segmentation };
        } catch (thrown) {
          return { index, input, error: veroneseError(thrown) };
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
    { jobs, source, points, worker, ...options }: PairsOptions & PoolOptions = {},
  ): AsyncGenerator<PairOutcome<Input>, void, undefined> {
    const pool = new SegmenterPool({ ...(jobs !== undefined && { jobs }), source, points, worker });
    try {
      yield* pool.segmentPairs(pairs, options);
    } finally {
      pool.close();
    }
  }

  return { Segmenter, SegmenterPool, segmentPairs };
}

function checkedJobs(jobs: number): number {
  if (Number.isInteger(jobs) && jobs >= 1 && jobs <= MOST_JOBS) return jobs;
  throw new VeroneseError('invalid-option', `option 'jobs': must be a whole number from 1 to ${MOST_JOBS}, not ${String(jobs)}`);
}

function checkedPairsOptions(pairs: unknown, options: PairsOptions | undefined): PairsOptions {
  const iterable = Object(pairs) as Partial<Iterable<unknown> & AsyncIterable<unknown>>;
  if (typeof iterable[Symbol.asyncIterator] !== 'function' && typeof iterable[Symbol.iterator] !== 'function') {
    throw new VeroneseError('invalid-input', 'the pairs must be an iterable or async iterable of { first, second }');
  }
  splitOptions(options as SegmentOptions | undefined);
  return options ?? {};
}
