// npm run bench:ratio: compares WebAssembly with native code on the same problems. --write-docs writes the figures to docs/figures, and
// docs/performance.md from them.
// Native and WebAssembly runs alternate, so that other load on the machine slows both; medians are compared.

import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';

import { buildPackage } from './lib/builds.mjs';
import { present } from './lib/documented.mjs';
import { prepare } from './lib/prepare.mjs';
import { root } from './lib/project.mjs';
import { command, must } from './lib/run.mjs';
import { quantile } from './lib/statistics.mjs';

const ROUNDS = 7;
const PROBLEMS = 8;
const SIZE = { width: 320, height: 240 };
const CARGO = ['run', '--quiet', '--release', '--locked', '--package', 'benches', '--example', 'ratio', '--'];

await command(async (args) => {
  await prepare();
  await buildPackage();
  const folder = mkdtempSync(join(tmpdir(), 'veronese-'));
  try {
    console.error('Building the native program if it has changed …');
    await native('inputs', folder);
    const wasm = await wasmTimes(folder);
    const times = {};
    for (let round = 0; round < ROUNDS; round += 1) {
      console.error(`Round ${round + 1} of ${ROUNDS}`);
      gather(times, 'native', JSON.parse(await native('times', folder)));
      gather(times, 'wasm', await wasm());
    }
    const rows = Object.entries(times).map(([call, { native, wasm }]) => ({ call, native: quartiles(native), wasm: quartiles(wasm) }));
    present('ratio', { command: 'npm run bench:ratio', node: process.versions.node }, { rounds: ROUNDS, rows }, args.includes('--write-docs'));
  } finally {
    rmSync(folder, { recursive: true, force: true });
  }
});

async function native(what, folder) {
  const result = await must('The native program failed.', 'cargo', [...CARGO, what, folder], { output: 'collect' });
  return result.stdout;
}

/** A function that runs every case once, in this process, and returns milliseconds by case. */
async function wasmTimes(folder) {
  const { fitMotions, segmentPair } = await import(join(root, 'pkg/dist/node.js'));
  const file = (name) => readFileSync(join(folder, name));
  const points = (name) => {
    const bytes = file(name);
    const rows = new Float64Array(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength));
    const columns = (from, to) => rows.filter((_, k) => k % 5 >= from && k % 5 < to);
    return { positions: columns(0, 2), derivatives: columns(2, 5) };
  };
  const [first, second] = ['first', 'second'].map((name) => ({ data: new Uint8Array(file(name)), ...SIZE }));
  return async () => {
    const times = {};
    for (const n of [2, 3, 4]) {
      times[`points ${n}`] = [];
      for (let k = 0; k < PROBLEMS; k += 1) {
        const data = points(`points-${n}-${k}`);
        times[`points ${n}`].push(await milliseconds(() => fitMotions(data, { motions: n })));
      }
    }
    for (const quality of ['fast', 'best']) {
      times[`pair ${quality}`] = [await milliseconds(() => segmentPair(first, second, { quality }))];
    }
    return times;
  };
}

async function milliseconds(work) {
  const start = performance.now();
  await work();
  return performance.now() - start;
}

function gather(times, target, found) {
  for (const [name, values] of Object.entries(found)) {
    times[name] ??= { native: [], wasm: [] };
    times[name][target].push(...values);
  }
}

function quartiles(values) {
  return [0.25, 0.5, 0.75].map((share) => quantile(values, share));
}
