// Tasks for a number of workers. Each worker does one at a time. A task is cancelled at once by ending its worker, unless the worker
// is reserved for a sequence of tasks that share state. A task that gives way is ended by the next one that its worker gets.

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

/** A worker reserved for a sequence of tasks that share state. */
export interface Claim<Task, Result> {
  /** Rejects if the worker has ended since. */
  perform: (task: Task, options?: CallOptions) => Promise<Result>;
  release: () => void;
  /** Says whether it waits for the caller's code, which may itself wait for a worker. */
  pause: (paused: boolean) => void;
  /** Why the worker has ended, if it has. */
  lost: () => VeroneseError | undefined;
}

/** A {@link Claim} inside the pool. */
interface Claiming {
  /** Why its worker has ended. */
  lost?: VeroneseError;
  paused?: boolean;
}

/** Who waits for a worker is refused when all claims have been paused for this long, milliseconds. */
const PATIENCE = 2000;

interface Claimant {
  /** Whether it takes only a worker that has nothing to do. */
  idle: boolean;
  give: (claim: Claiming) => void;
  reject: (reason: VeroneseError) => void;
}

interface Job<Task, Result> {
  task: Task;
  /** If given, only the worker with this claim may do the job. */
  claim: Claiming | undefined;
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
  /** The claim on its worker. */
  claim: Claiming | undefined;
}

export class WorkerPool<Task, Result> {
  readonly #spawn: Spawn<Task, Result>;
  readonly #supply: (task: Task) => Module;
  readonly #waiting: Job<Task, Result>[] = [];
  readonly #claimants: Claimant[] = [];
  readonly #lanes: Lane<Task, Result>[];
  /** Runs while claims are wanted and all are paused. */
  #patience: ReturnType<typeof setTimeout> | undefined;

  /** `supply`: which module a task needs. */
  constructor(spawn: Spawn<Task, Result>, supply: (task: Task) => Module, size: number) {
    this.#spawn = spawn;
    this.#supply = supply;
    const free = { thread: undefined, job: undefined, isKnown: false, claim: undefined };
    this.#lanes = Array.from({ length: size }, () => ({ ...free, modules: new Set() }));
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
    await this.#run(task, {}, undefined, true);
  }

  /**
   * Reserves a worker, with `idle` one that has nothing to do. A worker has one claim at a time; claims are met in the order of the calls.
   * Other tasks run in between.
   */
  claim(signal?: AbortSignal, idle = false): Promise<Claim<Task, Result>> {
    if (signal?.aborted) return Promise.reject(cancelled(signal));
    return new Promise((resolve, reject) => {
      const onAbort = () => {
        this.#claimants.splice(this.#claimants.indexOf(claimant), 1);
        reject(cancelled(signal));
      };
      const claimant: Claimant = {
        idle,
        give: (claim) => {
          signal?.removeEventListener('abort', onAbort);
          const pause = (paused: boolean) => {
            claim.paused = paused;
            this.#watch();
          };
          const perform = (task: Task, options?: CallOptions) => this.#run(task, options, claim);
          resolve({ perform, release: () => this.#release(claim), pause, lost: () => claim.lost });
        },
        reject: (reason) => {
          signal?.removeEventListener('abort', onAbort);
          reject(reason);
        },
      };
      signal?.addEventListener('abort', onAbort);
      this.#claimants.push(claimant);
      this.#assign();
    });
  }

  #assign(): void {
    const free = this.#lanes.filter(({ claim }) => !claim);
    // Idle workers first, then those that have started.
    free.sort((one, other) => Number(isBusy(one)) - Number(isBusy(other)) || Number(!one.thread) - Number(!other.thread));
    for (const lane of free) {
      const claimant = this.#claimants.find(({ idle }) => !idle || !isBusy(lane));
      if (!claimant) continue;
      this.#claimants.splice(this.#claimants.indexOf(claimant), 1);
      lane.claim = {};
      claimant.give(lane.claim);
    }
    this.#watch();
  }

  /** Claimants may be what all paused claims wait for: a clip in the loop of another. */
  #watch(): void {
    clearTimeout(this.#patience);
    if (this.#claimants.length === 0 || !this.#lanes.every(({ claim }) => claim?.paused)) return;
    this.#patience = setTimeout(() => {
      for (const { reject } of this.#claimants.splice(0)) reject(new VeroneseError('worker-busy', BUSY));
    }, PATIENCE);
  }

  #release(claim: Claiming): void {
    for (const lane of this.#lanes) if (lane.claim === claim) lane.claim = undefined;
    this.#assign();
  }

  #run(task: Task, { signal, onProgress }: CallOptions = {}, claim?: Claiming, givesWay = false): Promise<Result> {
    if (signal?.aborted) return Promise.reject(cancelled(signal));
    if (claim?.lost) return Promise.reject(claim.lost);
    return new Promise((resolve, reject) => {
      const onAbort = () => this.#cancel(job);
      const release = () => signal?.removeEventListener('abort', onAbort);
      const job: Job<Task, Result> = { task, claim, signal, onProgress, resolve, reject, release, givesWay, settled: false };
      signal?.addEventListener('abort', onAbort);
      this.#waiting.push(job);
      this.#next();
    });
  }

  /** Ends all workers; a later call starts fresh ones. */
  close(): void {
    const jobs = this.#waiting.splice(0);
    const claimants = this.#claimants.splice(0);
    for (const lane of this.#lanes) {
      if (lane.job) jobs.push(lane.job);
      this.#end(lane, cancelled());
    }
    for (const job of jobs) this.#settle(job, () => job.reject(cancelled(job.signal)));
    for (const claimant of claimants) claimant.reject(cancelled());
    this.#watch();
  }

  /** Ends the workers that have nothing to do and are not reserved, and so gives their memory back. A later call starts fresh ones. */
  endIdle(): void {
    for (const lane of this.#lanes) if (!lane.job && !lane.claim) this.#end(lane);
  }

  #cancel(job: Job<Task, Result>, reason: unknown = cancelled(job.signal)): void {
    const lane = this.#lanes.find((lane) => lane.job === job);
    // A reserved worker finishes the task, because its state would be lost.
    if (lane?.isKnown && !lane.claim) this.#end(lane);
    else if (lane && !lane.isKnown) lane.job = undefined;
    else if (!lane) this.#waiting.splice(this.#waiting.indexOf(job), 1);
    this.#settle(job, () => job.reject(reason));
    this.#next();
    this.#assign();
  }

  #settle(job: Job<Task, Result>, how: () => void): void {
    if (job.settled) return;
    job.settled = true;
    job.release();
    how();
  }

  /** Ends a worker and its task. `reason` is reported to the claim on it. */
  #end(lane: Lane<Task, Result>, reason?: VeroneseError): void {
    const { claim } = lane;
    lane.thread?.terminate();
    lane.thread = undefined;
    lane.modules.clear();
    lane.job = undefined;
    lane.isKnown = false;
    lane.claim = undefined;
    if (!claim || !reason) return;
    claim.lost = reason;
    const orphans = this.#waiting.filter((job) => job.claim === claim);
    for (const job of orphans) {
      this.#waiting.splice(this.#waiting.indexOf(job), 1);
      this.#settle(job, () => job.reject(reason));
    }
  }

  #next(): void {
    const idle = this.#lanes.filter((lane) => !isBusy(lane));
    // Reserved workers last, since they expect more tasks; then those that have not started.
    idle.sort((one, other) => Number(!!one.claim) - Number(!!other.claim) || Number(!one.thread) - Number(!other.thread));
    for (const lane of idle) {
      const fitting = this.#waiting.filter(({ claim }) => !claim || claim === lane.claim);
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
        this.#assign();
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
    this.#assign();
  }
}

const BUSY = 'every worker keeps a clip that nobody reads on; a SegmenterPool may have more workers';

function isBusy({ job }: { job: { givesWay: boolean } | undefined }): boolean {
  return job?.givesWay === false;
}

/** Where the caller makes the workers, anything may be thrown. */
function notStarted(thrown: unknown): VeroneseError {
  if (thrown instanceof VeroneseError) return thrown;
  const reason = thrown instanceof Error ? thrown.message : 'something was thrown';
  return new VeroneseError('worker-failed', `the worker cannot be started: ${reason}`, { cause: thrown });
}
