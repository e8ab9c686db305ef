// The server that npm start and the tests in browsers use: files of one folder, with our headers, nothing else.

import assert from 'node:assert/strict';
import { mkdirSync, mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { request } from 'node:http';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { serve } from '../../../scripts/lib/static-server.mjs';

let [above, server, origin] = [];
before(async () => {
  above = mkdtempSync(join(tmpdir(), 'veronese-static-'));
  const [folder, outside] = [join(above, 'served'), join(above, 'served-not')];
  for (const path of [folder, outside, join(folder, 'inner')]) mkdirSync(path);
  for (const [path, text] of [['index.html', '<!doctype html>'], ['inner/index.html', 'inner'], ['a b+ü.js', 'export {};'], ['module.wasm', 'wasm']]) writeFileSync(join(folder, path), text);
  writeFileSync(join(outside, 'secret.txt'), 'secret');
  server = await serve(folder, { port: 0, host: '127.0.0.1', headers: { 'X-Own': 'yes' } });
  origin = `http://127.0.0.1:${server.address().port}`;
});
after(() => {
  server?.close();
  server?.closeAllConnections();
  rmSync(above, { recursive: true, force: true });
});

/** Asks for a path as it is written: `fetch` would tidy it. */
function ask(path, method = 'GET') {
  return new Promise((resolve, reject) => {
    const asking = request(origin, { path, method }, async (response) => {
      const text = Buffer.concat(await response.toArray()).toString();
      resolve({ status: response.statusCode, headers: response.headers, text });
    });
    asking.on('error', reject).end();
  });
}

test('files of the folder, by their names', async () => {
  for (const [path, text, type] of [
    ['/', '<!doctype html>', 'text/html;charset=utf-8'],
    ['/index.html?query', '<!doctype html>', 'text/html;charset=utf-8'],
    ['/inner/', 'inner', 'text/html;charset=utf-8'],
    ['/a%20b+%C3%BC.js', 'export {};', 'text/javascript'],
    ['/module.wasm', 'wasm', 'application/wasm'],
  ]) {
    const found = await ask(path);
    assert.deepEqual([found.status, found.text, found.headers['content-type']], [200, text, type], path);
    assert.deepEqual([found.headers['x-own'], found.headers['x-content-type-options']], ['yes', 'nosniff']);
  }
});

test('no file outside, however it is asked for', async () => {
  for (const path of [
    '/missing', '/../served-not/secret.txt', '/../../../../../../etc/hostname', '/%2e%2e/served-not/secret.txt', '/..%2fserved-not%2fsecret.txt', '/..\\served-not\\secret.txt',
    '//served-not/secret.txt', '/-not/secret.txt', '/%', '/%zz', '/%00', `/${'x'.repeat(5000)}`,
  ]) {
    const found = await ask(path);
    assert.deepEqual([found.status, found.headers['x-own']], [404, 'yes'], path);
    assert.doesNotMatch(found.text, /secret/);
  }
});

test('GET and HEAD only', async () => {
  const head = await ask('/index.html', 'HEAD');
  assert.deepEqual([head.status, head.text, head.headers['content-length']], [200, '', '15']);
  for (const method of ['POST', 'PUT', 'DELETE', 'OPTIONS', 'PATCH']) {
    const found = await ask('/index.html', method);
    assert.deepEqual([found.status, found.headers.allow], [405, 'GET, HEAD'], method);
  }
});
