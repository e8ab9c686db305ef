// The threads that do the work of pairs and points, so that the program itself hears a signal at once.

import { Worker } from 'node:worker_threads';
import { core } from '../entries/codecs.js';
import { WorkerPool } from '../pool/pool.js';
import { spawnWith } from '../pool/threads.js';
import type { Task, TaskResult } from './work.js';

/** The result of `make` for a number of threads, once: the next command of the process goes on with threads that have started. */
export function oneForEach<T>(make: (jobs: number) => T): (jobs: number) => T {
  const made = new Map<number, T>();
  return (jobs) => {
    const one = made.get(jobs) ?? make(jobs);
    made.set(jobs, one);
    return one;
  };
}

const worker = () => new Worker(new URL('./cli-work.js', import.meta.url), { name: 'veronese' });
const module = () => core.module();

export const threads = oneForEach((jobs) => new WorkerPool<Task, TaskResult>(spawnWith(worker), () => module, jobs));
