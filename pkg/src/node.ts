// The entry for Node.

import { Worker } from 'node:worker_threads';
import * as glue from './glue.js';
import type { WasmSource } from '../types/index.js';
import { Api } from './api.js';
import { Core } from './core.js';
import type { Reply } from './messages.js';
import { read } from './reading.js';
import { type Spawn, WorkerSegmenter } from './segmenter.js';

export { VeroneseError } from './errors.js';
export { groupLabels } from './labels.js';
export { davisPalette } from './palette.js';
export { version } from './version.js';

const newCore = () => new Core(glue, read, new URL('../wasm/veronese_bg.wasm', import.meta.url));

export const { init, segmentPair, relabel, fitMotions, paintLabels } = new Api(newCore());

const spawn: Spawn = (onReply, onDeath) => {
  const worker = new Worker(new URL('./worker-node.js', import.meta.url), { name: 'veronese' });
  worker.on('message', (reply: Reply) => onReply(reply));
  worker.on('error', (error) => onDeath(error.message));
  worker.on('exit', (code) => onDeath(`exit code ${code}`));
  return {
    post: (request) => worker.postMessage(request),
    hold: (busy) => (busy ? worker.ref() : worker.unref()),
    terminate: () => void worker.terminate(),
  };
};

export class Segmenter extends WorkerSegmenter {
  constructor(source?: WasmSource | Promise<WasmSource>) {
    const core = newCore();
    super(spawn, () => core.module(source));
  }
}
