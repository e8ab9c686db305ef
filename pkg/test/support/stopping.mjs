// Processes and threads that are stopped at a known place, so that nothing has to be watched and no time is assumed.

import { Worker } from 'node:worker_threads';

/**
 * The environment of a process that sends itself a signal as it calls a function of the file system for the n-th time with a path that fits:
 * before the call, or after it. With `stays` the thread that calls does nothing more, so that work never ends there.
 */
export function signalledAt({ file }, signal, { call = 'renameSync', path = /^/, n = 1, when = 'after', stays = false } = {}) {
  const preload = file(`${[signal, call, n, when].join('-')}.cjs`, `
    const fs = require('fs'), place = '${call}' in fs.promises ? fs.promises : fs, { ${call}: original } = place;
    let count = 0;
    const signal = () => {
      process.kill(process.pid, '${signal}');
      if (${stays}) Atomics.wait(new Int32Array(new SharedArrayBuffer(4)), 0, 0);
    };
    place.${call} = (...args) => {
      const isIt = args.some((arg) => typeof arg === 'string' && ${path}.test(arg)) && ++count === ${n};
      if (isIt && '${when}' === 'before') signal();
      const answer = original(...args);
      if (!isIt || '${when}' === 'before') return answer;
      if (answer instanceof Promise) return answer.then((value) => (signal(), value));
      signal();
    };
    require('module').syncBuiltinESMExports();`);
  return { env: { NODE_OPTIONS: `--require "${preload}"` } };
}

/** A worker of the package that gets no further than the first progress it tells. */
export function stuckWorker() {
  const file = new URL('../../dist/worker-node.js', import.meta.url);
  const code = `
    const { parentPort } = require('worker_threads'), post = parentPort.postMessage.bind(parentPort);
    parentPort.postMessage = (message, ...rest) => {
      post(message, ...rest);
      if (message.kind === 'progress') Atomics.wait(new Int32Array(new SharedArrayBuffer(4)), 0, 0);
    };
    import(${JSON.stringify(file)});`;
  return new Worker(code, { eval: true });
}
