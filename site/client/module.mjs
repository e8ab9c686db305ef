// Loads the module of the site. Its types are in ../module.d.ts.

const CALLS = ['veroneseMap', 'multibodyFlow', 'derivativesOf', 'paperStages', 'motionsAtPixel', 'embeddedSpectra', 'figure1Trial', 'motionMeasurements', 'segmentPairStages', 'segmentPair', 'fitMotions'];

/**
 * The calls of the module whose JavaScript is at `url`; the WebAssembly file lies beside it. Loads the same address once.
 *
 * @param {string | URL} [url]
 * @returns {Promise<import('../module.d.ts').Module>}
 */
export async function load(url = new URL('../module/veronese_stages.js', import.meta.url)) {
  const glue = await import(/* @vite-ignore */ String(url));
  await glue.default({ module_or_path: await source(new URL('veronese_stages_bg.wasm', url)) });
  return Object.freeze(Object.fromEntries(CALLS.map((name) => [name, glue[name]])));
}

/** Node fetches no files. */
async function source(url) {
  if (url.protocol !== 'file:') return url;
  const { readFile } = await import(/* @vite-ignore */ 'node:fs/promises');
  return readFile(url);
}
