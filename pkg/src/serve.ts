// The worker's side: one task at a time, answered by messages.

import { glue } from './glue.js';
import { glue as pointsGlue } from './glue-points.js';
import { Api } from './api.js';
import { Core } from './core.js';
import { errorMessage } from './errors.js';
import type { CallOptions, Segmentation } from '../types/index.js';
import type { Reply, Request, Result, Task } from './messages.js';
import { warmUp } from './warming.js';

/** Answers one request at a time: the page sends the next when it has the answer to the last. */
export function serve(post: (reply: Reply, transfer: ArrayBuffer[]) => void): (request: Request) => Promise<void> {
  const fromPage = () => Promise.reject(new Error('a worker gets its modules from the page'));
  const api = new Api(new Core(glue, fromPage), new Core(pointsGlue, fromPage));
  return async ({ task, module }) => {
    try {
      if (module) await (task.call === 'fitMotions' ? api.initPoints(module) : api.init(module));
      const onProgress = (progress: { stage: string; index: number; of: number }) => {
        post({ kind: 'progress', progress }, []);
      };
      const result = await perform(api, task, { onProgress });
      post({ kind: 'done', result }, buffersOf(result));
    } catch (thrown) {
      // An exception in an asynchronous handler would not reach the page by itself.
      post({ kind: 'failed', error: errorMessage(thrown) }, []);
    }
  };
}

function perform(api: Api, task: Task, call: CallOptions): Promise<Result> {
  switch (task.call) {
    case 'segmentPair':
      return api.segmentPair(task.first, task.second, { ...task.options, ...call });
    case 'relabel':
      return api.relabel(task.first, task.second, task.segmentation, task.evidence, { ...task.options, ...call });
    case 'fitMotions':
      return api.fitMotions(task.measurements, { ...task.options, ...call });
    case 'warmUp':
      return warmUp(api).then(() => undefined);
  }
}

/** What is handed over instead of copied. */
function buffersOf(result: Result): ArrayBuffer[] {
  const { labels, confidence }: Partial<Pick<Segmentation, 'labels' | 'confidence'>> = result ?? {};
  return [labels, confidence].filter((array) => array !== undefined).map(({ buffer }) => buffer as ArrayBuffer);
}
