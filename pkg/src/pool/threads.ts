// A Web Worker or a thread of Node, as the pool sees either.

import type { WorkerLike } from '../../types/index.js';
import type { Reply } from '../calls/messages.js';
import { invalidOption } from '../common/checks.js';
import type { Spawn } from './pool.js';

interface Thread extends WorkerLike {
  postMessage(message: unknown, transfer?: ArrayBuffer[]): void;
}

/** The members of a thread of Node that a Web Worker lacks. */
interface NodeThread extends Thread {
  on(event: string, listener: (value: never) => void): unknown;
  ref(): void;
  unref(): void;
}

/** The members of a Web Worker that a thread of Node lacks. */
interface WebThread extends Thread {
  addEventListener(type: string, listener: (event: never) => void): void;
}

/** Starts workers with `make`; `transferred` lists the buffers of a task that are handed over to them instead of copied. */
export function spawnWith<Task, Result>(
  make: () => WorkerLike,
  transferred: (task: Task) => ArrayBuffer[] = () => [],
): Spawn<Task, Result> {
  return (onReply, onDeath) => {
    const worker = make() as NodeThread | WebThread;
    const ofNode = isOfNode(worker);
    if (!has(worker, 'postMessage', 'terminate', ...(ofNode ? ['on', 'unref'] : ['addEventListener']))) {
      throw invalidOption('worker', 'a function that makes a Web Worker or a worker thread', worker);
    }
    if (ofNode) {
      worker.on('message', (reply: Reply<Result>) => onReply(reply));
      worker.on('error', (error: unknown) => onDeath(error instanceof Error ? error.message : String(error)));
      worker.on('exit', (code: number) => onDeath(`exit code ${code}`));
    } else {
      worker.addEventListener('message', (event: MessageEvent<Reply<Result>>) => onReply(event.data));
      worker.addEventListener('error', (event: ErrorEvent) => {
        event.preventDefault();
        onDeath(
          event.message ||
            "its file could not be loaded; give option 'worker', or import veronese/inline (of the element: worker, veronese/element/inline); from another origin it needs CORS, and its origin and blob: in worker-src",
        );
      });
      worker.addEventListener('messageerror', () => onDeath('a message could not be read'));
    }
    return {
      post: (request) => worker.postMessage(request, transferred(request.task)),
      hold: (busy) => {
        if (ofNode) busy ? worker.ref() : worker.unref();
      },
      terminate: () => void worker.terminate(),
    };
  };
}

function isOfNode(worker: NodeThread | WebThread): worker is NodeThread {
  return has(worker, 'ref');
}

function has(worker: NodeThread | WebThread, ...methods: string[]): boolean {
  return methods.every((name) => typeof (Object(worker) as Record<string, unknown>)[name] === 'function');
}
