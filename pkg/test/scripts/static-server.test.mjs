// The server that npm start and the tests in browsers use: files of one folder, nothing else.

import assert from 'node:assert/strict';
import { existsSync, mkdirSync, mkdtempSync, readdirSync, readlinkSync, rmSync, symlinkSync, truncateSync, writeFileSync } from 'node:fs';
import { request } from 'node:http';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { setTimeout as sleep } from 'node:timers/promises';
import { serve } from '../../../scripts/lib/static-server.mjs';

let [above, server, origin] = [];
before(async () => {
  above = mkdtempSync(join(tmpdir(), 'veronese-static-'));
  const [folder, outside] = [join(above, 'served'), join(above, 'served-not')];
  for (const path of [folder, outside, join(folder, 'inner'), join(folder, 'linked')]) mkdirSync(path);
  for (const [path, text] of [
    ['index.html', '<!doctype html>'], ['inner/index.html', 'inner'], ['a b+ü.js', 'export {};'], ['empty.txt', ''], ['long.txt', 'x'.repeat(300_000)], ['..dots', 'dots'],
  ]) writeFileSync(join(folder, path), text);
  writeFileSync(join(folder, 'larger-than-any-buffer'), '');
  truncateSync(join(folder, 'larger-than-any-buffer'), 256 * 1024 * 1024);
  writeFileSync(join(outside, 'secret.txt'), 'secret');
  for (const [path, target] of [
    ['file.txt', join(outside, 'secret.txt')], ['relative.txt', '../served-not/secret.txt'], ['folder', outside], ['linked/index.html', join(outside, 'secret.txt')],
    ['up', '..'], ['loop', 'loop'], ['nowhere', 'missing'], ['within.html', 'inner/index.html'], ['within', 'inner'],
  ]) symlinkSync(target, join(folder, path));
  // Served by a way that is a link itself, as temporary folders are on some systems.
  symlinkSync(folder, join(above, 'way'));
  server = await serve(join(above, 'way'), { port: 0, host: '127.0.0.1', headers: { 'X-Own': 'yes' } });
  origin = `http://127.0.0.1:${server.address().port}`;
});
after(() => {
  server?.close();
  server?.closeAllConnections();
  rmSync(above, { recursive: true, force: true });
});

/** Asks for a path as it is written: `fetch` would tidy it. */
function ask(path, { method = 'GET', headers } = {}) {
  return new Promise((resolve, reject) => {
    const asking = request(origin, { path, method, headers }, async (response) => {
      const text = Buffer.concat(await response.toArray()).toString();
      resolve({ status: response.statusCode, headers: response.headers, text });
    });
    asking.on('error', reject).end();
  });
}

test('files of the folder, by their names', async () => {
  for (const [path, text, type] of [
    ['/', '<!doctype html>', 'text/html; charset=utf-8'],
    ['/index.html?query', '<!doctype html>', 'text/html; charset=utf-8'],
    ['/inner', 'inner', 'text/html; charset=utf-8'],
    ['/inner/', 'inner', 'text/html; charset=utf-8'],
    ['/a%20b+%C3%BC.js', 'export {};', 'text/javascript; charset=utf-8'],
    ['/empty.txt', '', 'text/plain; charset=utf-8'],
    ['/long.txt', 'x'.repeat(300_000), 'text/plain; charset=utf-8'],
    ['/..dots', 'dots', 'application/octet-stream'],
    ['/inner/../index.html', '<!doctype html>', 'text/html; charset=utf-8'],
    ['/within.html', 'inner', 'text/html; charset=utf-8'],
    ['/within/', 'inner', 'text/html; charset=utf-8'],
  ]) {
    const found = await ask(path);
    assert.deepEqual([found.status, found.text, found.headers['content-type']], [200, text, type], path);
    assert.deepEqual([found.headers['content-length'], found.headers['x-own'], found.headers['x-content-type-options']], [String(Buffer.byteLength(text)), 'yes', 'nosniff']);
  }
});

test('no file outside, however it is asked for', async () => {
  for (const path of [
    '/file.txt', '/relative.txt', '/folder/secret.txt', '/folder/', '/linked', '/linked/', '/linked/index.html', '/up/served-not/secret.txt', '/up/served/index.html/',
    '/loop', '/nowhere', '/missing', '/index.html/', '/index.html/x', `/${'x'.repeat(5000)}`,
    '/../served-not/secret.txt', '/../../../../../../etc/hostname', '/%2e%2e/served-not/secret.txt', '/.%2e/%2e./served-not/secret.txt', '/..\\served-not\\secret.txt', '//served-not/secret.txt', '/-not/secret.txt',
  ]) {
    const found = await ask(path);
    assert.equal(found.status, 404, path);
    assert.doesNotMatch(found.text, /secret/);
  }
});

test('an address that can be none of a file is 400', async () => {
  for (const path of ['/%', '/%zz', '/%ff', '/index.html%', '/%00', '/index.html%00.js', '/inner%2findex.html', '/..%2fserved-not%2fsecret.txt', '/..%5cserved-not%5csecret.txt', '//', '//[']) {
    assert.equal((await ask(path)).status, 400, path);
  }
  assert.equal((await ask('/')).status, 200);
});

test('GET and HEAD only', async () => {
  const head = await ask('/long.txt', { method: 'HEAD' });
  assert.deepEqual([head.status, head.text, head.headers['content-length']], [200, '', '300000']);
  assert.equal((await ask('/missing', { method: 'HEAD' })).status, 404);
  for (const method of ['POST', 'PUT', 'DELETE', 'OPTIONS', 'PATCH']) {
    const found = await ask('/index.html', { method });
    assert.deepEqual([found.status, found.headers.allow], [405, 'GET, HEAD'], method);
  }
  assert.deepEqual((await ask('/long.txt', { headers: { Range: 'bytes=0-9' } })).text.length, 300_000, 'ranges are not taken');
});

test('who leaves in the middle leaves no file open', { skip: !existsSync('/proc/self/fd') && 'this system does not list open files', timeout: 20_000 }, async () => {
  const open = () => readdirSync('/proc/self/fd').filter((fd) => {
    try {
      return readlinkSync(`/proc/self/fd/${fd}`).startsWith(above);
    } catch {
      return false; // Closed since.
    }
  });
  for (let k = 0; k < 5; k++) {
    await new Promise((resolve, reject) => {
      const asking = request(origin, { path: '/larger-than-any-buffer' }, (response) => {
        assert.equal(open().length, 1);
        response.destroy();
        resolve();
      });
      asking.on('error', reject).end();
    });
    while (open().length > 0) await sleep(5);
  }
});
