// Tasks for a number of workers. Each worker does one at a time. A task is cancelled at once by ending its worker, unless the worker
// keeps state for others: tasks that share state are pinned to one worker. A task that gives way is ended by the next one that its worker gets.

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

/** The worker to which a sequence of tasks keeps, because it has their state. Others may have it too. */
export interface Pin<Task, Result> {
  /** Rejects if the worker has ended since. */
  perform: (task: Task, options?: CallOptions) => Promise<Result>;
  release: () => void;
}

/** A {@link Pin} inside the pool. */
interface Pinning {
  /** Why its worker has ended. */
  lost?: VeroneseError;
  onLost?: ((reason: VeroneseError) => void) | undefined;
}

interface Job<Task, Result> {
  task: Task;
  /** If given, only the worker with this pin does the job. */
  pin: Pinning | undefined;
  /** If given, the worker with this pin does not do the job, unless there is no other. */
  apart: Pinning | undefined;
  signal: AbortSignal | undefined;
  onProgress: ((progress: Progress) => void) | undefined;
  resolve: (result: Result) => void;
  reject: (reason: unknown) => void;
  /** No longer listens to the signal. */
  release: () => void;
  /** Whether any other job ends it and takes its worker. */
  givesWay: boolean;
  /** Whether the caller has an answer. */
  settled: boolean;
}

/** Gives a compiled module, the same for every worker: always the same function where it is the same module. */
export type Module = () => Promise<WebAssembly.Module>;

/** A place for one worker, which is started when there is work for it and replaced when it was ended. */
interface Lane<Task, Result> {
  thread: Thread<Task> | undefined;
  /** The modules that its worker has been given. */
  modules: Set<Module>;
  job: Job<Task, Result> | undefined;
  /** Whether its worker knows of the job. */
  isKnown: boolean;
  /** Of those for which its worker keeps state. */
  pins: Set<Pinning>;
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
    const free = { thread: undefined, job: undefined, isKnown: false };
    this.#lanes = Array.from({ length: size }, () => ({ ...free, modules: new Set(), pins: new Set() }));
  }

  get size(): number {
    return this.#lanes.length;
  }

  /** Tasks begin in the order of the calls. */
  run(task: Task, options?: CallOptions): Promise<Result> {
    return this.#run(task, options);
  }

  /** Runs a task that gives way: it begins when nothing else waits, and is over when something else comes. */
  async rest(task: Task): Promise<void> {
    await this.#run(task, {}, { givesWay: true });
  }

  /** Chooses the worker that keeps the state of the fewest. Other tasks run in between. */
  pin(onLost?: (reason: VeroneseError) => void): Pin<Task, Result> & { beside: (task: Task, options?: CallOptions) => Promise<Result> } {
    const order = (lane: Lane<Task, Result>) => [lane.pins.size, Number(isBusy(lane)), Number(!lane.thread)];
    const [lane] = [...this.#lanes].sort((one, other) => compared(order(one), order(other))) as [Lane<Task, Result>];
    const pin: Pinning = { onLost };
    lane.pins.add(pin);
    return {
      perform: (task, options) => this.#run(task, options, { pin }),
      // A task without state, which others should do, since this one may be wanted at any time.
      beside: (task, options) => this.#run(task, options, { apart: pin }),
      release: () => lane.pins.delete(pin),
    };
  }

  #run(
    task: Task,
    { signal, onProgress }: CallOptions = {},
    { pin, apart, givesWay = false }: Partial<Pick<Job<Task, Result>, 'pin' | 'apart' | 'givesWay'>> = {},
  ): Promise<Result> {
    if (signal?.aborted) return Promise.reject(cancelled(signal));
    if (pin?.lost) return Promise.reject(pin.lost);
    return new Promise((resolve, reject) => {
      const onAbort = () => this.#cancel(job);
      const release = () => signal?.removeEventListener('abort', onAbort);
      const job: Job<Task, Result> = { task, pin, apart, signal, onProgress, resolve, reject, release, givesWay, settled: false };
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
      this.#end(lane, cancelled());
    }
    for (const job of jobs) this.#settle(job, () => job.reject(cancelled(job.signal)));
  }

  /** Ends the workers that have nothing to do and keep nothing, and so gives their memory back. A later call starts fresh ones. */
  endIdle(): void {
    for (const lane of this.#lanes) if (!lane.job && lane.pins.size === 0) this.#end(lane);
  }

  #cancel(job: Job<Task, Result>, reason: unknown = cancelled(job.signal)): void {
    const lane = this.#lanes.find((lane) => lane.job === job);
    // A worker that keeps state finishes the task.
    if (lane?.isKnown && lane.pins.size === 0) this.#end(lane);
    else if (lane && !lane.isKnown) lane.job = undefined;
    else if (!lane) this.#waiting.splice(this.#waiting.indexOf(job), 1);
    this.#settle(job, () => job.reject(reason));
    this.#next();
  }

  #settle(job: Job<Task, Result>, how: () => void): void {
    if (job.settled) return;
    job.settled = true;
    job.release();
    how();
  }

  /** Ends a worker and its task. `reason` is reported to all that are pinned to it. */
  #end(lane: Lane<Task, Result>, reason?: VeroneseError): void {
    const { pins } = lane;
    lane.thread?.terminate();
    lane.thread = undefined;
    lane.modules.clear();
    lane.job = undefined;
    lane.isKnown = false;
    lane.pins = new Set();
    if (!reason) return;
    for (const pin of pins) pin.lost = reason;
    // Once everything here is as it will be.
    queueMicrotask(() => pins.forEach(({ onLost }) => onLost?.(reason)));
    for (const job of this.#waiting.filter(({ pin }) => pin && pins.has(pin))) {
      this.#waiting.splice(this.#waiting.indexOf(job), 1);
      this.#settle(job, () => job.reject(reason));
    }
  }

  #next(): void {
    const idle = this.#lanes.filter((lane) => !isBusy(lane));
    // Those that keep state last, since they expect more tasks; then those that have not started.
    idle.sort((one, other) => one.pins.size - other.pins.size || Number(!one.thread) - Number(!other.thread));
    for (const lane of idle) {
      const fits = ({ pin, apart }: Job<Task, Result>) =>
        pin ? lane.pins.has(pin) : !apart || !lane.pins.has(apart) || this.#lanes.length === 1;
      const fitting = this.#waiting.filter(fits);
      const job = fitting.find(({ givesWay }) => !givesWay) ?? fitting[0];
      const { job: left } = lane;
      if (!job || (left && job.givesWay)) continue;
      this.#waiting.splice(this.#waiting.indexOf(job), 1);
      if (left) this.#settle(left, () => left.resolve(undefined as Result));
      lane.job = job;
      lane.isKnown = false;
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
      lane.isKnown = true;
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
        const failed = new VeroneseError('worker-failed', `the worker stopped: ${reason}`);
        this.#end(lane, failed);
        if (job) this.#settle(job, () => job.reject(failed));
        this.#next();
      },
    );
    return thread;
  }

  #receive(lane: Lane<Task, Result>, reply: Reply<Result>): void {
    const { job } = lane;
    // A task that gave way may have ended by itself just before.
    if (!job || (reply.kind === 'rested' && !job.givesWay)) return;
    if (reply.kind === 'progress') {
      if (job.settled) return;
      try {
        job.onProgress?.(reply.progress);
      } catch (thrown) {
        this.#cancel(job, thrown);
      }
      return;
    }
    lane.job = undefined;
    // It keeps no module that it could not start.
    const error = reply.kind === 'done' ? undefined : reply.error;
    if (error?.code === 'wasm-load-failed') lane.modules.clear();
    lane.thread?.hold(false);
    this.#settle(job, () => {
      if (error) job.reject(new VeroneseError(error.code, error.message));
      else job.resolve(reply.kind === 'done' ? reply.result : (undefined as Result));
    });
    this.#next();
  }
}

/** As a comparison of lists, number by number. */
function compared(one: readonly number[], other: readonly number[]): number {
  const at = one.findIndex((value, k) => value !== other[k]);
  return at < 0 ? 0 : (one[at] as number) - (other[at] as number);
}

function isBusy({ job }: { job: { givesWay: boolean } | undefined }): boolean {
  return job?.givesWay === false;
}

/** Where the caller makes the workers, anything may be thrown. */
function notStarted(thrown: unknown): VeroneseError {
  if (thrown instanceof VeroneseError) return thrown;
  const reason = thrown instanceof Error ? thrown.message : 'something was thrown';
  return new VeroneseError('worker-failed', `the worker cannot be started: ${reason}`, { cause: thrown });
}
