// The entry for browsers, workers and bundlers.

import * as glue from './glue.js';
import type { WasmSource } from '../types/index.js';
import { Api } from './api.js';
import { Core } from './core.js';
import type { Reply } from './messages.js';
import { type Spawn, WorkerSegmenter } from './segmenter.js';

export { VeroneseError } from './errors.js';
export { groupLabels } from './labels.js';
export { davisPalette } from './palette.js';
export { version } from './version.js';

const newCore = () =>
  new Core(glue, (place) => fetch(place), new URL('../wasm/veronese_bg.wasm', import.meta.url));

export const { init, segmentPair, relabel, fitMotions, paintLabels } = new Api(newCore());

const spawn: Spawn = (onReply, onDeath) => {
  const worker = new Worker(new URL('./worker.js', import.meta.url), { type: 'module', name: 'veronese' });
  worker.addEventListener('message', (event: MessageEvent<Reply>) => onReply(event.data));
  worker.addEventListener('error', (event) => {
    event.preventDefault();
    onDeath(event.message || 'its file could not be loaded');
  });
  worker.addEventListener('messageerror', () => onDeath('a message could not be read'));
  return {
    post: (request) => worker.postMessage(request),
    hold: () => undefined,
    terminate: () => worker.terminate(),
  };
};

export class Segmenter extends WorkerSegmenter {
  constructor(source?: WasmSource | Promise<WasmSource>) {
    const core = newCore();
    super(spawn, () => core.module(source));
  }
}
