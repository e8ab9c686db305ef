// The module in a worker: answers what compute.mjs asks, in order.

import { load } from './module.mjs';

const module = load(new URL('../module/veronese_stages.js', import.meta.url));
let ended = false;

self.onmessage = async ({ data: { id, name, args } }) => {
  try {
    const calls = await module;
    if (!ended) self.postMessage({ id, result: calls[name](...args) });
  } catch (thrown) {
    if (ended) return;
    ended = !leavesTheInstance(thrown);
    self.postMessage({ id, error: { code: thrown?.code, message: String(thrown?.message ?? thrown) }, ended });
  }
};

/** An error that Rust returned leaves the instance as it was. Anything else, such as a trap or a panic, may not have: it must not be called again. */
function leavesTheInstance(thrown) {
  return thrown?.name === 'VeroneseError' && thrown.code !== 'internal';
}
