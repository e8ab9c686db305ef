// A Web Worker or a thread of Node, as the pool sees either.

import type { WorkerLike } from '../types/index.js';
import type { Reply } from './messages.js';
import type { Spawn } from './pool.js';

/** What a thread of Node has that a Web Worker has not. */
interface NodeThread extends WorkerLike {
  on(event: string, listener: (value: never) => void): unknown;
  ref(): void;
  unref(): void;
}

/** What a Web Worker has that a thread of Node has not. */
interface WebThread extends WorkerLike {
  addEventListener(type: string, listener: (event: never) => void): void;
}

/** Starts workers with `make`. */
export function spawnWith<Task, Result>(make: () => WorkerLike): Spawn<Task, Result> {
  return (onReply, onDeath) => {
    const worker = make() as NodeThread | WebThread;
    const ofNode = 'ref' in worker;
    if (ofNode) {
      worker.on('message', (reply: Reply<Result>) => onReply(reply));
      worker.on('error', (error: unknown) => onDeath(error instanceof Error ? error.message : String(error)));
      worker.on('exit', (code: number) => onDeath(`exit code ${code}`));
    } else {
      worker.addEventListener('message', (event: MessageEvent<Reply<Result>>) => onReply(event.data));
      worker.addEventListener('error', (event: ErrorEvent) => {
        event.preventDefault();
        onDeath(event.message || 'its file could not be loaded');
      });
      worker.addEventListener('messageerror', () => onDeath('a message could not be read'));
    }
    return {
      post: (request) => worker.postMessage(request),
      hold: (busy) => {
        if (ofNode) busy ? worker.ref() : worker.unref();
      },
      terminate: () => void worker.terminate(),
    };
  };
}
