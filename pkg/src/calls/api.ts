// The calls themselves, on the module that has them: stages reported, the signal heard, time measured.

import type * as calls from '../../types/index.js';
import type { CallOptions, Milliseconds, MotionFit, Pixels, Segmentation } from '../../types/index.js';
import { cancelled } from '../common/errors.js';
import type { Core, Glue } from '../module/core.js';
import type { PointsGlue } from '../module/glue-points.js';
import type { FramesGlue, OnStage } from '../module/glue.js';
import type { CallTask, ClipAnswer, ClipTask, Result, StreamTask } from './messages.js';
import { FrameCache } from './session/frame-cache.js';
import { fitCall, segmentCall, solveCall, start } from './tasks.js';

export class Api {
  readonly #frames: Core<FramesGlue>;
  readonly #points: Core<PointsGlue>;
  readonly #cache = new FrameCache();

  /** `points` is loaded when measurements come; it may be the same as `frames`. */
  constructor(frames: Core<FramesGlue>, points: Core<PointsGlue>) {
    this.#frames = frames;
    this.#points = points;
  }

  readonly init: typeof calls.init = (source) => this.#frames.init(source);

  readonly initPoints: typeof calls.initPoints = (source) => this.#points.init(source);

  readonly segmentPair = (...given: Parameters<typeof segmentCall>): Promise<Segmentation> =>
    start(() => segmentCall(...given), this.perform);

  readonly solvePair = (...given: Parameters<typeof solveCall>): Promise<Uint8Array> => start(() => solveCall(...given), this.perform);

  readonly fitMotions: typeof calls.fitMotions = (...given) => start(() => fitCall(...given), this.perform);

  /** Segments a pair for the compiler's sake: nobody asks why nothing was found. */
  readonly warm = (first: Pixels, second: Pixels): Promise<unknown> =>
    start(() => segmentCall(first, second, { quality: 'fast' }), this.#perform);

  /** Performs a task that was checked and taken, here or on the other side of a worker. */
  readonly perform = async (task: CallTask, call: CallOptions): Promise<Result> => {
    const result = await this.#perform(task, call);
    if (task.call !== 'segmentPair') return result;
    const found = result as Segmentation;
    if (found.count > 1 || found.settings.motions === 1) return found;
    const [first, second] = task.frames;
    const { whyNothing } = await import('./nothing.js');
    return { ...found, notes: [whyNothing(first, second, found.motions[0] ?? {})] };
  };

  readonly #perform = (task: CallTask, call: CallOptions): Promise<Result> => {
    if (task.call === 'fitMotions') {
      const { positions, derivatives } = task.measurements;
      return run<MotionFit, PointsGlue>(this.#points, call, (glue, onStage) =>
        glue.fitMotions(positions, derivatives, task.settings, onStage),
      );
    }
    if (task.call === 'solvePair') return this.#step(call, (glue) => glue.solvePair(...task.frames, task.settings));
    if (task.call !== 'segmentPair') return this.#step(call, (glue) => stepOf(glue, task, this.#cache));
    const [first, second] = task.frames;
    return run<Segmentation, FramesGlue>(this.#frames, call, (glue, onStage) => glue.segmentPair(first, second, task.settings, onStage));
  };

  /** One step of a clip or a stream. It yields to the event loop first; otherwise nothing could abort a stream whose source never waits. */
  async #step({ signal }: CallOptions, work: (glue: FramesGlue) => unknown): Promise<Result> {
    await nextTurn();
    if (signal?.aborted) throw cancelled(signal);
    return this.#frames.call(work) as Promise<Result>;
  }
}

/** One call of a module. Stages are timed, and between them the signal is looked at. */
async function run<T extends { milliseconds: Milliseconds }, G extends Glue>(
  core: Core<G>,
  { signal, onProgress }: CallOptions,
  work: (glue: G, onStage: OnStage) => unknown,
): Promise<T> {
  if (signal?.aborted) throw cancelled(signal);
  await core.init();
  if (signal?.aborted) throw cancelled(signal);
  const watch = new Stopwatch();
  let thrownByListener: { thrown: unknown } | undefined;
  const onStage: OnStage = (stage, index, of) => {
    watch.begin(stage);
    try {
      onProgress?.({ stage, index, of });
      if (signal?.aborted) throw cancelled(signal);
    } catch (thrown) {
      thrownByListener = { thrown };
      throw thrown;
    }
  };
  try {
    const report = await core.call((glue) => {
      watch.start();
      return { ...(work(glue, onStage) as Omit<T, 'milliseconds'>), milliseconds: watch.end() };
    });
    return report as T;
  } catch (thrown) {
    throw thrownByListener ? thrownByListener.thrown : thrown;
  }
}

/** Waits for the next turn of the event loop. Browsers delay timers that begin each other by four milliseconds, but no messages. */
function nextTurn(): Promise<void> {
  const { port1, port2 } = new MessageChannel();
  return new Promise((resolve) => {
    port1.onmessage = () => {
      port1.close();
      resolve();
    };
    port2.postMessage(undefined);
  });
}

function stepOf(glue: FramesGlue, task: ClipTask | StreamTask, cache: FrameCache): unknown {
  if ('stream' in task) return streamStep(glue, task);
  return clipStep(glue, task, cache);
}

function streamStep(glue: FramesGlue, task: StreamTask): unknown {
  if (task.call === 'beginStream') return glue.beginStream(task.stream, task.settings);
  if (task.call === 'pushStream') return glue.pushStream(task.stream, task.frame);
  return glue.finishStream(task.stream);
}

/** Frames that a clip takes stay in the cache. The result is undefined where one was expected there and is gone. */
function clipStep(glue: FramesGlue, task: ClipTask, cache: FrameCache): unknown {
  const { clip } = task;
  if (task.call === 'saveClip') return glue.saveClip(clip);
  if (task.call === 'annotationsOfClip') return glue.annotationsOfClip(clip, task.index);
  if (task.call === 'closeClip') {
    cache.forget(clip);
    return glue.closeClip(clip);
  }
  const frame = task.call === 'takeClip' ? (task.frame ?? cache.get(clip, task.index)) : undefined;
  if (task.call === 'takeClip' && !frame) return undefined;
  const answer = answerOf(glue, task, frame);
  if (task.call === 'takeClip' && task.frame) cache.add(clip, task.index, task.frame);
  if (answer?.wanted) answer.wanted.isCached = cache.has(clip, answer.wanted.frame);
  return answer;
}

function answerOf(glue: FramesGlue, task: ClipTask, frame: Pixels | undefined): ClipAnswer | null {
  const { clip } = task;
  if (task.call === 'openClip') return glue.openClip(clip, task.frames, task.markUnknown, task.saved) as ClipAnswer;
  if (task.call === 'applyClip') return glue.applyClip(clip, task.command) as ClipAnswer | null;
  if (task.call === 'moveClip') return glue.moveClip(clip, task.what, task.step) as ClipAnswer | null;
  if (task.call === 'takeClip') return glue.takeClip(clip, task.index, frame, task.solved, task.draft) as ClipAnswer | null;
  return glue.lookAtClip(clip, task.call === 'lookAtClip' ? task.index : undefined) as ClipAnswer | null;
}

/** Milliseconds per stage; a stage that is entered again goes on where it stopped. */
class Stopwatch {
  readonly #laps = new Map<string, number>();
  #started = 0;
  #stage: { name: string; since: number } | undefined;

  start(): void {
    this.#started = performance.now();
  }

  begin(name: string): void {
    const now = performance.now();
    this.#close(now);
    this.#stage = { name, since: now };
  }

  end(): Milliseconds {
    const now = performance.now();
    this.#close(now);
    return { total: now - this.#started, ...Object.fromEntries(this.#laps) };
  }

  #close(now: number): void {
    if (this.#stage) this.#laps.set(this.#stage.name, (this.#laps.get(this.#stage.name) ?? 0) + now - this.#stage.since);
  }
}
