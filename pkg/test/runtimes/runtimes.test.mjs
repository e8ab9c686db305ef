// The packed package in every runtime that people run it on besides browsers: the labels have the same hash as in the Node that runs this.

import assert from 'node:assert/strict';
import { existsSync, readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { join } from 'node:path';
import { after, before, describe, test } from 'node:test';
import { fileURLToPath, pathToFileURL } from 'node:url';
import { segmentPair } from 'veronese';
import { pair } from '../support/moving.mjs';
import { labelHash } from '../packed/app/label-hash.js';
import { install, run } from '../packed/packed.mjs';

const folder = fileURLToPath(new URL('.', import.meta.url));
const at = (...path) => join(folder, 'node_modules', ...path);
// All are optional, so that one that cannot be installed is named here and keeps no other from running.
const { optionalDependencies } = JSON.parse(readFileSync(join(folder, 'package.json')));
const platform = `${process.platform}-${process.arch}`;

let [app, remove, expected] = [];
before(async () => {
  ({ app, remove } = install());
  expected = await labelHash(await segmentPair(...pair()));
});
after(() => remove?.());

/** A reason to skip where the runtime has nothing for this system; what it should have and has not is a failure. */
function missing(name, path, exists = true) {
  if (existsSync(path)) return false;
  if (!exists) return `${name} is not published for ${platform}`;
  throw new Error(`${name} is not installed: run \`npm ci\` in pkg/test/runtimes`);
}

/** It is the runtime that it should be, and finds the same directly and in a worker. */
function check(output, runtime) {
  const [name, ...hashes] = output.trim().split('\n');
  assert.ok(name.startsWith(runtime), name);
  assert.deepEqual(hashes, [expected, expected]);
}

describe('Node', () => {
  const versions = [...new Set(Object.keys(optionalDependencies).map((name) => /^node-(\d+)-/.exec(name)?.[1]).filter(Boolean))];
  assert.ok(versions.length > 0);
  for (const version of versions) {
    const name = `node-${version}-${platform}`;
    test(version, (t) => {
      const program = at(name, 'bin', 'node');
      const reason = missing(`Node ${version}`, program, name in optionalDependencies);
      if (reason) return t.skip(reason);
      check(run(program, ['runtime.mjs'], { cwd: app }), `Node ${version}.`);
    });
  }
});

test('Deno', (t) => {
  const program = at('.bin', 'deno');
  const reason = missing('Deno', program);
  if (reason) return t.skip(reason);
  check(run(program, ['run', '--no-remote', '--allow-read', '--allow-env', 'runtime.mjs'], { cwd: app }), 'Deno 2.');
});

test('Bun', (t) => {
  const program = at('.bin', 'bun');
  const reason = missing('Bun', program);
  if (reason) return t.skip(reason);
  check(run(program, ['runtime.mjs'], { cwd: app }), 'Bun 1.');
});

test('workerd, in which Cloudflare Workers run', async (t) => {
  const reason = missing('miniflare', at('miniflare'));
  if (reason) return t.skip(reason);
  const { Miniflare } = await import(String(pathToFileURL(createRequire(join(folder, 'package.json')).resolve('miniflare'))));
  const modules = [
    { type: 'ESModule', include: ['**/*.js', '**/*.mjs'] },
    { type: 'CompiledWasm', include: ['**/*.wasm'] },
  ];
  const worker = new Miniflare({ modules: true, modulesRoot: app, scriptPath: join(app, 'edge.mjs'), modulesRules: modules, compatibilityDate: '2026-01-01' });
  t.after(() => worker.dispose());
  const response = await worker.dispatchFetch('http://localhost/');
  assert.equal(await response.text(), expected);
});
