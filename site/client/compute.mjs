// Calls of the module in a worker, so that the page answers while a figure computes.

/** Where the worker and the module are, beside this script. */
const at = (name) => new URL(name, import.meta.url);

/**
 * Asks a worker of its own: what computes for long must not keep others waiting. The function returns the result of the module's call
 * `name`, or rejects with the module's error, whose `code` is stable. A worker that ends is replaced.
 */
export function computer(script = at('worker.js')) {
  let worker;
  let count = 0;
  const waiting = new Map();

  function started() {
    const one = new Worker(script, { type: 'module' });
    one.onmessage = ({ data: { id, result, error, ended } }) => {
      const { resolve, reject } = waiting.get(id);
      waiting.delete(id);
      if (ended) replace();
      if (error) reject(Object.assign(new Error(error.message), { code: error.code }));
      else resolve(result);
    };
    one.onerror = (event) => {
      event.preventDefault();
      worker = undefined;
      for (const { reject } of waiting.values()) reject(new Error('The module could not be started.'));
      waiting.clear();
    };
    return one;
  }

  /** Those that wait have not been begun: a fresh worker answers them. */
  function replace() {
    worker.terminate();
    worker = undefined;
    for (const { message } of waiting.values()) send(message);
  }

  function send(message) {
    worker ??= started();
    worker.postMessage(message);
  }

  return function ask(name, ...args) {
    return new Promise((resolve, reject) => {
      const message = { id: ++count, name, args };
      send(message);
      waiting.set(message.id, { message, resolve, reject });
    });
  };
}

/** Asks the worker that the figures share. */
export const ask = computer();

/**
 * A function that computes and shows, for input that changes faster than that: while one input is worked on, only the newest of the others
 * is kept.
 */
export function latest(work) {
  let next;
  let busy = false;
  return async function run(...input) {
    next = input;
    if (busy) return;
    busy = true;
    try {
      while (next) {
        const now = next;
        next = undefined;
        await work(...now);
      }
    } finally {
      busy = false;
    }
  };
}
