// The same calls in a worker: one after another, each cancelled at once by ending the worker.

import type { CallOptions, FitOptions, MotionFit, Pixels, PointMeasurements, RelabelOptions, Segmentation, SegmentOptions } from '../types/index.js';
import { checkedCorrection, checkedMeasurements, checkedPixels, splitOptions } from './api.js';
import { cancelled, VeroneseError } from './errors.js';
import type { Reply, Request, Task } from './messages.js';

/** A Web Worker or a worker thread, with what the two have in common. */
export interface Thread {
  post(request: Request): void;
  /** Lets a Node process end while the worker is idle. */
  hold(busy: boolean): void;
  terminate(): void;
}

export type Spawn = (onReply: (reply: Reply) => void, onDeath: (reason: string) => void) => Thread;

interface Job {
  task: Task;
  call: CallOptions;
  resolve: (result: Segmentation | MotionFit) => void;
  reject: (reason: unknown) => void;
  /** No longer listens to the signal. */
  release: () => void;
}

export class WorkerSegmenter {
  readonly #spawn: Spawn;
  readonly #module: () => Promise<WebAssembly.Module>;
  readonly #waiting: Job[] = [];
  #running: Job | undefined;
  #thread: Thread | undefined;

  constructor(spawn: Spawn, module: () => Promise<WebAssembly.Module>) {
    this.#spawn = spawn;
    this.#module = module;
  }

  async segmentPair(first: Pixels, second: Pixels, options?: SegmentOptions): Promise<Segmentation> {
    const { call, rest } = splitOptions(options);
    const settings = rest.before === undefined ? rest : { ...rest, before: checkedPixels('the frame before', rest.before) };
    const frames = { first: checkedPixels('the first frame', first), second: checkedPixels('the second frame', second) };
    return (await this.#enqueue({ call: 'segmentPair', ...frames, options: settings }, call)) as Segmentation;
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
    return (await this.#enqueue({ call: 'relabel', ...frames, segmentation, evidence, options: settings }, call)) as Segmentation;
  }

  async fitMotions(measurements: PointMeasurements, options?: FitOptions): Promise<MotionFit> {
    const { call, rest } = splitOptions(options);
    const checked = checkedMeasurements(measurements);
    return (await this.#enqueue({ call: 'fitMotions', measurements: checked, options: rest }, call)) as MotionFit;
  }

  close(): void {
    const jobs = [...(this.#running ? [this.#running] : []), ...this.#waiting.splice(0)];
    this.#end();
    for (const job of jobs) this.#settle(job, () => job.reject(cancelled(job.call.signal)));
  }

  #enqueue(task: Task, call: CallOptions): Promise<Segmentation | MotionFit> {
    const { signal } = call;
    if (signal?.aborted) return Promise.reject(cancelled(signal));
    return new Promise((resolve, reject) => {
      const onAbort = () => this.#cancel(job);
      const release = () => signal?.removeEventListener('abort', onAbort);
      const job: Job = { task, call, resolve, reject, release };
      signal?.addEventListener('abort', onAbort);
      this.#waiting.push(job);
      this.#next();
    });
  }

  #cancel(job: Job, reason: unknown = cancelled(job.call.signal)): void {
    if (this.#running === job) this.#end();
    else this.#waiting.splice(this.#waiting.indexOf(job), 1);
    this.#settle(job, () => job.reject(reason));
    this.#next();
  }

  #settle(job: Job, how: () => void): void {
    job.release();
    how();
  }

  /** Ends the worker and whatever it does. */
  #end(): void {
    this.#thread?.terminate();
    this.#thread = undefined;
    this.#running = undefined;
  }

  #next(): void {
    if (this.#running) return;
    const job = this.#waiting.shift();
    if (!job) return;
    this.#running = job;
    void this.#start(job);
  }

  async #start(job: Job): Promise<void> {
    const request: Request = { task: job.task };
    try {
      if (!this.#thread) request.module = await this.#module();
      if (this.#running !== job) return; // cancelled while the module loaded
      this.#thread ??= this.#spawnThread();
      this.#thread.hold(true);
      this.#thread.post(request);
    } catch (thrown) {
      if (this.#running === job) this.#cancel(job, thrown);
    }
  }

  #spawnThread(): Thread {
    const thread = this.#spawn(
      (reply) => {
        if (this.#thread === thread) this.#receive(reply);
      },
      (reason) => {
        if (this.#thread !== thread) return;
        const job = this.#running;
        this.#end();
        if (job) this.#settle(job, () => job.reject(new VeroneseError('worker-failed', `the worker stopped: ${reason}`)));
        this.#next();
      },
    );
    return thread;
  }

  #receive(reply: Reply): void {
    const job = this.#running;
    if (!job) return;
    if (reply.kind === 'progress') {
      try {
        job.call.onProgress?.(reply.progress);
      } catch (thrown) {
        this.#cancel(job, thrown);
      }
      return;
    }
    this.#running = undefined;
    this.#thread?.hold(false);
    this.#settle(job, () => {
      if (reply.kind === 'done') job.resolve(reply.result);
      else job.reject(new VeroneseError(reply.error.code, reply.error.message));
    });
    this.#next();
  }
}
