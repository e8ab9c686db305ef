// The module in a worker: answers what compute.mjs asks, in order.

import { load } from './module.mjs';

const module = load(new URL('../module/veronese_stages.js', import.meta.url));

self.onmessage = async ({ data: { id, name, args } }) => {
  try {
    self.postMessage({ id, result: (await module)[name](...args) });
  } catch (thrown) {
    self.postMessage({ id, error: { code: thrown?.code, message: String(thrown?.message ?? thrown) } });
  }
};
