// The worker's side: one task at a time, answered by messages.

import type { Segmentation } from '../../types/index.js';
import { Api } from '../calls/api.js';
import type { ClipAnswer, LabelledFrame, Reply, Request, Result, StreamEnd } from '../calls/messages.js';
import { buffersOf } from '../calls/taking.js';
import { errorMessage } from '../common/errors.js';
import { Core } from '../module/core.js';
import { glue as pointsGlue } from '../module/glue-points.js';
import { glue } from '../module/glue.js';
import { Warming } from './warming.js';

/**
 * Answers one request at a time: the page sends the next when it has the answer to the last. A warm-up is the exception: the next request
 * may come at any time, ends it and takes its place, so that it is not answered.
 */
export function serve(post: (reply: Reply, transfer: ArrayBuffer[]) => void): (request: Request) => Promise<void> {
  const fromPage = () => Promise.reject(new Error('a worker gets its modules from the page'));
  const api = new Api(new Core(glue, fromPage), new Core(pointsGlue, fromPage));
  let warming: Warming | undefined;
  const warmUp = async (module: WebAssembly.Module | undefined) => {
    const own = (warming = new Warming(api));
    let reply: Reply = { kind: 'rested' };
    try {
      if (module) await api.init(module);
      await own.run();
    } catch (thrown) {
      reply = { kind: 'rested', error: errorMessage(thrown) };
    }
    if (!own.ended) post(reply, []);
  };
  return async ({ task, module }) => {
    warming?.end();
    if (task.call === 'warmUp') return warmUp(module);
    try {
      if (module) await (task.call === 'fitMotions' ? api.initPoints(module) : api.init(module));
      const onProgress = (progress: { stage: string; index: number; of: number }) => {
        post({ kind: 'progress', progress }, []);
      };
      const result = await api.perform(task, { onProgress });
      post({ kind: 'done', result }, buffersOfResult(result));
    } catch (thrown) {
      // An exception in an asynchronous handler would not reach the page by itself.
      post({ kind: 'failed', error: errorMessage(thrown) }, []);
    }
  };
}

/** Buffers that are handed over instead of copied. */
function buffersOfResult(result: Result): ArrayBuffer[] {
  if (result instanceof Uint8Array) return buffersOf([result]);
  type Large = Pick<Segmentation, 'confidence'> &
    Pick<ClipAnswer, 'records' | 'draft'> &
    StreamEnd & { labels: Uint8Array | LabelledFrame };
  const { labels, confidence, records, draft, frames = [] }: Partial<Large> = Object(result);
  const ofFrames = frames.map((frame: LabelledFrame | number) => (typeof frame === 'number' ? undefined : frame.labels));
  return buffersOf([labels instanceof Uint8Array ? labels : labels?.labels, confidence, records, draft?.labels, ...ofFrames]);
}
