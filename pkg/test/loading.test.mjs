import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { createServer } from 'node:http';
import { describe, test } from 'node:test';
import { fileURLToPath, pathToFileURL } from 'node:url';
import { glue } from '../build/module/glue.js';
import { glue as pointsGlue } from '../build/module/glue-points.js';
import { Api } from '../build/calls/api.js';
import { Core } from '../build/module/core.js';
import { read } from '../build/entries/reading.js';
import { pair } from './support/frames.mjs';
import { checkPair, failure } from './support/shapes.mjs';

const path = fileURLToPath(new URL('../wasm/veronese_bg.wasm', import.meta.url));
const bytes = new Uint8Array(readFileSync(path));

/** An API that has loaded nothing yet. */
function fresh(place) {
  glue.forgetInstance();
  return new Api(new Core(glue, read, place), new Core(pointsGlue, read));
}

async function serving(t, status, type, body) {
  const server = createServer((_, response) => response.writeHead(status, { 'content-type': type }).end(body));
  await new Promise((resolve) => server.listen(0, '127.0.0.1', resolve));
  t.after(() => server.close());
  return `http://127.0.0.1:${server.address().port}/veronese_bg.wasm`;
}

describe('init takes', () => {
  const sources = {
    'a path': () => path,
    'a file: URL': () => pathToFileURL(path),
    'a file: URL as text': () => String(pathToFileURL(path)),
    'an ArrayBuffer': () => bytes.buffer,
    'a view of bytes': () => bytes,
    'a compiled module': () => new WebAssembly.Module(bytes),
    'a Response': () => new Response(bytes),
    'a promise of any': () => Promise.resolve(bytes),
    'a URL of a server, whatever type that says': (t) => serving(t, 200, 'text/plain', bytes),
    'a data: URL': () => `data:application/wasm;base64,${Buffer.from(bytes).toString('base64')}`,
  };
  for (const [title, source] of Object.entries(sources)) {
    test(title, async (t) => {
      const api = fresh();
      await api.init(await source(t));
      checkPair(await api.segmentPair(...pair()), 64, 48);
    });
  }
});

describe('init refuses', () => {
  const sources = {
    'a missing file': ['/nowhere/veronese_bg.wasm', /ENOENT/],
    'a page instead of the module': [Buffer.from('<!doctype html><html>'), /HTML page.*Vite 7/],
    'other bytes': [Buffer.from('hello, world'), /no WebAssembly module/],
    'no bytes': [new Uint8Array(0), /no WebAssembly module/],
    'a damaged module': [bytes.subarray(0, 2000), /./],
    'the module of measurements': [readFileSync(new URL('../wasm/points/veronese_points_bg.wasm', import.meta.url)), /no segmentPair/],
    'a module that is not ours': [Uint8Array.of(0, 0x61, 0x73, 0x6d, 1, 0, 0, 0), /./],
    'a number': [42, /source must be/],
    'an answer that is an error': [(t) => serving(t, 404, 'text/html', '<!doctype html>'), /404/],
    'a promise that is rejected': [() => Promise.reject(new Error('no network')), /no network/],
  };
  for (const [title, [source, reason]] of Object.entries(sources)) {
    test(title, async (t) => {
      const api = fresh(pathToFileURL(path));
      const error = await failure(api.init(typeof source === 'function' ? source(t) : source));
      assert.equal(error.code, 'wasm-load-failed', error.stack);
      assert.match(error.message, reason);
      // and a later call tries again, from the ordinary place
      checkPair(await api.segmentPair(...pair()), 64, 48);
    });
  }
});

test('init may be called twice and at once; the first source stays', async () => {
  const api = fresh(pathToFileURL(path));
  await Promise.all([api.init(), api.init(), api.init(bytes)]);
  await api.init('/nowhere/at-all.wasm');
  checkPair(await api.segmentPair(...pair()), 64, 48);
});

describe('after a trap', () => {
  // (module (func (export "boom") unreachable)): what a panic without a hook, or an exhausted memory, comes to.
  const trap = Uint8Array.of(
    0, 0x61, 0x73, 0x6d, 1, 0, 0, 0, 1, 4, 1, 0x60, 0, 0, 3, 2, 1, 0, 7, 8, 1, 4, 0x62, 0x6f, 0x6f, 0x6d, 0, 0, 10, 5, 1, 3, 0, 0, 0x0b,
  );
  function trappingGlue() {
    let instance;
    const glue = {
      made: 0,
      async instantiate(module) {
        if (instance) return;
        instance = await WebAssembly.instantiate(module, {});
        glue.made++;
      },
      forgetInstance: () => (instance = undefined),
      boom: () => instance.exports.boom(),
    };
    return glue;
  }

  test('the error is "internal" with the message, and the next call has a fresh instance', async () => {
    const trapping = trappingGlue();
    const core = new Core(trapping, read);
    await core.init(trap);
    const error = await failure(core.call((glue) => glue.boom()));
    assert.equal(error.code, 'internal');
    assert.match(error.message, /unreachable/);
    assert.ok(error.cause instanceof WebAssembly.RuntimeError);
    assert.equal(await core.call(() => 'fine'), 'fine');
    assert.equal(trapping.made, 2);
  });

  test('an error that Rust returned keeps the instance', async () => {
    const trapping = trappingGlue();
    const core = new Core(trapping, read);
    await core.init(trap);
    const returned = Object.assign(new Error('no'), { name: 'VeroneseError', code: 'invalid-option' });
    assert.equal((await failure(core.call(() => { throw returned; }))).code, 'invalid-option');
    await core.init();
    assert.equal(trapping.made, 1);
  });
});
