// Tasks for a number of workers: each does one at a time, each task is cancelled at once by ending its worker.

import type { CallOptions, Progress } from '../../types/index.js';
import type { Reply, Request } from '../calls/messages.js';
import { cancelled, VeroneseError } from '../common/errors.js';

/** A Web Worker or a worker thread, with what the two have in common. */
export interface Thread<Task> {
  post(request: Request<Task>): void;
  /** Lets a Node process end while the worker is idle. */
  hold(busy: boolean): void;
  terminate(): void;
}

export type Spawn<Task, Result> = (onReply: (reply: Reply<Result>) => void, onDeath: (reason: string) => void) => Thread<Task>;

interface Job<Task, Result> {
  task: Task;
  signal: AbortSignal | undefined;
  onProgress: ((progress: Progress) => void) | undefined;
  resolve: (result: Result) => void;
  reject: (reason: unknown) => void;
  /** No longer listens to the signal. */
  release: () => void;
}

/** Gives a compiled module, the same for every worker: always the same function where it is the same module. */
export type Module = () => Promise<WebAssembly.Module>;

/** A place for one worker, which is started when there is work for it and replaced when it was ended. */
interface Lane<Task, Result> {
  thread: Thread<Task> | undefined;
  /** What its worker has been given. */
  modules: Set<Module>;
  job: Job<Task, Result> | undefined;
  /** Whether its worker knows of the job. */
  told: boolean;
}

export class WorkerPool<Task, Result> {
  readonly #spawn: Spawn<Task, Result>;
  readonly #supply: (task: Task) => Module;
  readonly #waiting: Job<Task, Result>[] = [];
  readonly #lanes: Lane<Task, Result>[];

  /** `supply`: which module a task needs. */
  constructor(spawn: Spawn<Task, Result>, supply: (task: Task) => Module, size: number) {
    this.#spawn = spawn;
    this.#supply = supply;
    this.#lanes = Array.from({ length: size }, () => ({ thread: undefined, modules: new Set(), job: undefined, told: false }));
  }

  get size(): number {
    return this.#lanes.length;
  }

  /** Tasks begin in the order of the calls. */
  run(task: Task, { signal, onProgress }: CallOptions = {}): Promise<Result> {
    if (signal?.aborted) return Promise.reject(cancelled(signal));
    return new Promise((resolve, reject) => {
      const onAbort = () => this.#cancel(job);
      const release = () => signal?.removeEventListener('abort', onAbort);
      const job: Job<Task, Result> = { task, signal, onProgress, resolve, reject, release };
      signal?.addEventListener('abort', onAbort);
      this.#waiting.push(job);
      this.#next();
    });
  }

  /** Ends all workers; a later call starts fresh ones. */
  close(): void {
    const jobs = this.#waiting.splice(0);
    for (const lane of this.#lanes) {
      if (lane.job) jobs.push(lane.job);
      this.#end(lane);
    }
    for (const job of jobs) this.#settle(job, () => job.reject(cancelled(job.signal)));
  }

  #cancel(job: Job<Task, Result>, reason: unknown = cancelled(job.signal)): void {
    const lane = this.#lanes.find((lane) => lane.job === job);
    if (lane?.told) this.#end(lane);
    else if (lane) lane.job = undefined;
    else this.#waiting.splice(this.#waiting.indexOf(job), 1);
    this.#settle(job, () => job.reject(reason));
    this.#next();
  }

  #settle(job: Job<Task, Result>, how: () => void): void {
    job.release();
    how();
  }

  /** Ends a worker and whatever it does. */
  #end(lane: Lane<Task, Result>): void {
    lane.thread?.terminate();
    lane.thread = undefined;
    lane.modules.clear();
    lane.job = undefined;
    lane.told = false;
  }

  #next(): void {
    const idle = this.#lanes.filter(({ job }) => !job);
    // A worker that is there already costs nothing.
    idle.sort((one, other) => Number(!one.thread) - Number(!other.thread));
    for (const lane of idle) {
      const job = this.#waiting.shift();
      if (!job) return;
      lane.job = job;
      lane.told = false;
      void this.#start(lane, job);
    }
  }

  async #start(lane: Lane<Task, Result>, job: Job<Task, Result>): Promise<void> {
    const request: Request<Task> = { task: job.task };
    try {
      const module = this.#supply(job.task);
      if (!lane.modules.has(module)) request.module = await module();
      if (lane.job !== job) return; // cancelled while the module loaded
      lane.thread ??= this.#spawnThread(lane);
      lane.modules.add(module);
      lane.told = true;
      lane.thread.hold(true);
      lane.thread.post(request);
    } catch (thrown) {
      if (lane.job === job) this.#cancel(job, notStarted(thrown));
    }
  }

  #spawnThread(lane: Lane<Task, Result>): Thread<Task> {
    const thread = this.#spawn(
      (reply) => {
        if (lane.thread === thread) this.#receive(lane, reply);
      },
      (reason) => {
        if (lane.thread !== thread) return;
        const { job } = lane;
        this.#end(lane);
        if (job) this.#settle(job, () => job.reject(new VeroneseError('worker-failed', `the worker stopped: ${reason}`)));
        this.#next();
      },
    );
    return thread;
  }

  #receive(lane: Lane<Task, Result>, reply: Reply<Result>): void {
    const { job } = lane;
    if (!job) return;
    if (reply.kind === 'progress') {
      try {
        job.onProgress?.(reply.progress);
      } catch (thrown) {
        this.#cancel(job, thrown);
      }
      return;
    }
    lane.job = undefined;
    // It keeps no module that it could not start.
    if (reply.kind === 'failed' && reply.error.code === 'wasm-load-failed') lane.modules.clear();
    lane.thread?.hold(false);
    this.#settle(job, () => {
      if (reply.kind === 'done') job.resolve(reply.result);
      else job.reject(new VeroneseError(reply.error.code, reply.error.message));
    });
    this.#next();
  }
}

/** Where the caller makes the workers, anything may be thrown. */
function notStarted(thrown: unknown): VeroneseError {
  if (thrown instanceof VeroneseError) return thrown;
  const reason = thrown instanceof Error ? thrown.message : 'something was thrown';
  return new VeroneseError('worker-failed', `the worker cannot be started: ${reason}`, { cause: thrown });
}
