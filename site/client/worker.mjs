// The module in a worker: answers what compute.mjs asks, in order.

const address = new URL('../module/veronese_stages.js', import.meta.url);
// As an address, so that the bundler leaves it alone. Its calls are documented in site/stages/src/calls.rs.
const module = import(String(address)).then(async (calls) => {
  await calls.default({ module_or_path: new URL('veronese_stages_bg.wasm', address) });
  return calls;
});
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
