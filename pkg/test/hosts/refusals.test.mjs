// Requests that the servers of examples/hosts refuse.

import assert from 'node:assert/strict';
import { describe, test } from 'node:test';
import { setTimeout as sleep } from 'node:timers/promises';
import { createFetch } from '../../../examples/hosts/fetch-file.mjs';
import { bmp, png, ppm } from '../support/frames.mjs';
import { backend, files, frames, listen, post, postAs, task } from './asking.mjs';

function base64(file) {
  return Buffer.from(file).toString('base64');
}

describe('the token', () => {
  test('goes to the configured origin alone, however an address is written', async (t) => {
    const [studio, other] = [await files(t), await files(t)];
    const address = await backend(t, { studio: studio.origin, token: 'secret', allow: [other.origin] });
    const host = new URL(other.origin).host;
    for (const foreign of [`//${host}/0.png`, `/\\${host}/0.png`, `/\t/${host}/0.png`, `\\\\${host}/0.png`, `${other.origin}/0.png`]) {
      assert.equal((await post(`${address}/predict`, task(foreign, '/data/1.png'))).status, 200, foreign);
    }
    assert.deepEqual(other.asked, Array(5).fill({ url: '/0.png', token: undefined }));
    assert.deepEqual(studio.asked, Array(5).fill({ url: '/data/1.png', token: 'Token secret' }));
  });

  test('is not sent on by a redirect, nor taken along on a way back', async (t) => {
    const [studio, other] = [await files(t), await files(t)];
    const ways = { '/away': `${other.origin}/0.png`, '/around': '/back', '/inside': `${studio.origin}/data/1.png` };
    const asked = [];
    const home = await listen(t, (incoming, response) => {
      asked.push({ url: incoming.url, token: incoming.headers.authorization });
      if (incoming.url === '/back.png') response.end(png(frames[1]));
      else response.writeHead(303, { Location: ways[incoming.url] ?? `${via}/return` }).end();
    });
    const via = await listen(t, (_, response) => response.writeHead(302, { Location: `${home}/back.png` }).end());
    const address = await backend(t, { studio: home, token: 'secret', allow: [other.origin, studio.origin, via] });
    assert.equal((await post(`${address}/predict`, task('/away', '/around'))).status, 200);
    assert.deepEqual(other.asked, [{ url: '/0.png', token: undefined }]);
    const tokens = Object.fromEntries(asked.map(({ url, token }) => [url, token]));
    assert.deepEqual(tokens, { '/away': 'Token secret', '/around': 'Token secret', '/back': 'Token secret', '/back.png': undefined });
    // Another origin is not the configured one because it asks for the same token.
    const { body } = await post(`${address}/predict`, task('/inside', '/inside'));
    assert.match(body.error.message, /answered 401/);
    assert.ok(studio.asked.every(({ token }) => token === undefined));
  });

  test('and its origin are not moved by set-up', async (t) => {
    const [studio, other] = [await files(t), await files(t)];
    const address = await backend(t, { studio: studio.origin });
    const setup = { hostname: other.origin, access_token: 'theirs' };
    assert.equal((await post(`${address}/setup`, setup, { 'Content-Type': 'text/plain' })).status, 415);
    assert.equal((await postAs('evil.example', `${address}/setup`, { ...setup, hostname: studio.origin })).status, 403);
    assert.equal((await post(`${address}/setup`, setup)).status, 200, 'the studio may call itself otherwise');
    const asked = task('/data/0.png', '/data/1.png');
    assert.equal((await post(`${address}/predict`, asked)).status, 422);
    for (const access_token of [{}, 'two\r\nlines', '']) {
      assert.equal((await post(`${address}/setup`, { hostname: studio.origin, access_token })).status, 200);
    }
    assert.ok(studio.asked.length > 0 && studio.asked.every(({ token }) => token === undefined), 'no token yet');
    await post(`${address}/setup`, { hostname: studio.origin, access_token: 'secret' });
    await post(`${address}/setup`, { ...setup });
    assert.equal((await post(`${address}/predict`, asked)).status, 200);
    assert.deepEqual(other.asked, []);
  });
});

describe('addresses', () => {
  test('that are not public are not asked, however they are written', async (t) => {
    const asked = [];
    const origin = await listen(t, (incoming, response) => {
      asked.push(incoming.url);
      response.end(png(frames[0]));
    }, '0.0.0.0');
    const { port } = new URL(origin);
    const address = await backend(t, { allow: ['http://127.0.0.1:9'] });
    for (const host of [
      '127.0.0.1', '127.1', '2130706433', '0x7f000001', '0177.0.0.1', 'localhost', 'LOCALHOST', '127.0.0.2', '0.0.0.0', '0',
      '[::1]', '[::]', '[::ffff:127.0.0.1]', '[::ffff:7f00:1]', '[::127.0.0.1]', '[64:ff9b::7f00:1]', '[2002:7f00:1::]',
      '169.254.169.254', '[fe80::1]', '10.0.0.1', '172.16.0.1', '192.168.1.1', '100.64.0.1', '[fd00::1]', '224.0.0.1', '255.255.255.255',
    ]) {
      const { status, body } = await post(`${address}/predict`, task(`http://${host}:${port}/0.png`, `http://${host}:${port}/1.png`));
      assert.deepEqual([status, body.error.code], [422, 'address-refused'], `${host}: ${JSON.stringify(body)}`);
    }
    assert.deepEqual(asked, []);
  });

  test('that were allowed may not send on to others', async (t) => {
    const inner = await files(t);
    const targets = [`${inner.origin}/0.png`, 'http://169.254.169.254/latest', 'file:///etc/hostname', 'data:image/png;base64,AAAA', 'http://', 'http://u:p@[::1]/'];
    const outer = await listen(t, (incoming, response) => {
      const index = Number(incoming.url.slice(1));
      response.writeHead(307, { Location: targets[index] ?? incoming.url }).end();
    });
    const address = await backend(t, { allow: [outer] });
    const codes = ['address-refused', 'address-refused', 'invalid-input', 'invalid-input', 'invalid-input', 'invalid-input', 'file-not-found'];
    for (const [index, code] of codes.entries()) {
      const { status, body } = await post(`${address}/predict`, task(`${outer}/${index}`, `${outer}/${index}`));
      assert.deepEqual([status, body.error.code], [422, code], JSON.stringify(body));
    }
    assert.deepEqual(inner.asked, []);
  });

  test('of a name are looked up once, and all have to be public', async (t) => {
    const { origin, asked } = await files(t);
    const { port } = new URL(origin);
    const answers = (...addresses) => {
      const given = [];
      const lookup = (name, options, callback) => {
        given.push(name);
        // Whoever asked a second time would get another answer.
        const found = given.length > 1 ? ['127.0.0.1'] : addresses;
        callback(null, found.map((address) => ({ address, family: address.includes(':') ? 6 : 4 })));
      };
      return { given, lookup };
    };
    for (const addresses of [['127.0.0.1'], ['192.0.2.1', '127.0.0.1'], ['2606:4700::1111', '::ffff:10.0.0.1'], ['8.8.8.8', 'fe80::1']]) {
      const { given, lookup } = answers(...addresses);
      const fetchFile = createFetch({ lookup });
      await assert.rejects(fetchFile(`http://frames.example:${port}/0.png`), { code: 'address-refused' }, addresses.join());
      assert.deepEqual(given, ['frames.example']);
    }
    // 198.51.100.0/24 is for documentation, 8.8.8.8 is public: nothing here has a way there.
    const { given, lookup } = answers('8.8.8.8');
    await assert.rejects(createFetch({ lookup, patience: 300 })(`http://frames.example:${port}/0.png`), { code: 'file-not-found' });
    assert.deepEqual(given, ['frames.example']);
    assert.deepEqual(asked, []);
  });
});

describe('files', { timeout: 120_000 }, () => {
  /** A server that answers as the path says, and a function that fetches from it with small limits. */
  async function odd(t, limits) {
    const closed = [];
    const origin = await listen(t, async (incoming, response) => {
      response.on('close', () => closed.push(incoming.url));
      const answers = {
        '/stated': () => response.writeHead(200, { 'Content-Length': 5000 }).end(Buffer.alloc(5000)),
        '/endless': async () => {
          while (!response.destroyed) {
            response.write(Buffer.alloc(1000));
            await sleep(1);
          }
        },
        '/page': () => response.writeHead(200, { 'Content-Type': 'text/html; charset=utf-8' }).end('<!doctype html>'),
        '/cut': () => {
          response.writeHead(200, { 'Content-Length': 500 }).write(Buffer.alloc(100));
          setTimeout(() => response.destroy(), 20);
        },
        '/silent': () => undefined,
        '/slow': async () => {
          while (!response.destroyed) {
            response.write('.');
            await sleep(20);
          }
        },
        '/octets': () => response.writeHead(200, { 'Content-Type': 'binary/octet-stream' }).end('octets'),
      };
      await answers[incoming.url]();
    });
    const fetchFile = createFetch({ allow: [origin], ...limits });
    return { get: (path, options) => fetchFile(origin + path, options), closed };
  }

  test('have a size, a type and an end', async (t) => {
    const { get, closed } = await odd(t, { largest: 4000 });
    await assert.rejects(get('/stated'), { code: 'unreadable-file' });
    await assert.rejects(get('/endless'), { code: 'unreadable-file' });
    await assert.rejects(get('/page'), /is text\/html; charset=utf-8, not an image/);
    await assert.rejects(get('/cut'), { code: 'file-not-found' });
    assert.equal(Buffer.from(await get('/octets')).toString(), 'octets');
    while (!closed.includes('/endless')) await sleep(5);
  });

  test('that do not come are given up', async (t) => {
    const { get, closed } = await odd(t, { patience: 200 });
    await assert.rejects(get('/silent'), /takes longer than 200 ms/);
    await assert.rejects(get('/slow'), /takes longer than 200 ms/);
    const stop = new AbortController();
    setTimeout(() => stop.abort(), 20);
    await assert.rejects(get('/silent', { signal: stop.signal }), { name: 'AbortError' });
    await assert.rejects(get('/silent', { signal: AbortSignal.abort() }), { name: 'AbortError' });
    while (closed.length < 3) await sleep(5);
  });
});

describe('work', { timeout: 120_000 }, () => {
  /** Frames that are sent when `release` is called; `open` counts those that wait, `most` is the highest it was. */
  async function held(t) {
    const waiting = [];
    const state = { most: 0, asked: 0, closed: 0 };
    const origin = await listen(t, (incoming, response) => {
      state.asked++;
      response.on('close', () => (state.closed += Number(!response.writableFinished)));
      waiting.push(() => response.end(png(frames[Number(/(\d)\.png/.exec(incoming.url)[1])])));
      state.most = Math.max(state.most, waiting.length);
    });
    let free = false;
    const release = async () => {
      free = true;
      while (free) {
        for (const send of waiting.splice(0)) send();
        await sleep(2);
      }
    };
    t.after(() => (free = false));
    return { origin, state, release, wanted: (count) => ({ ...task(), tasks: Array(count).fill(task(`${origin}/0.png`, `${origin}/1.png`).tasks[0]) }) };
  }

  test('is done for few tasks at once; for many others it waits, for more it is refused', async (t) => {
    const { origin, state, release, wanted } = await held(t);
    const address = await backend(t, { jobs: 2, tasks: 7, allow: [origin] });
    const many = await post(`${address}/predict`, wanted(8));
    assert.deepEqual([many.status, many.body.error.code], [413, 'too-many-tasks']);
    const first = post(`${address}/predict`, wanted(5));
    while (state.asked < 4) await sleep(5);
    const busy = await post(`${address}/predict`, wanted(3));
    assert.deepEqual([busy.status, busy.body.error.code], [503, 'busy']);
    assert.match(busy.headers.get('Retry-After'), /^\d+$/);
    const second = post(`${address}/predict`, wanted(2));
    void release();
    for (const [answer, count] of [[await first, 5], [await second, 2]]) {
      assert.equal(answer.status, 200, JSON.stringify(answer.body));
      assert.equal(answer.body.results.length, count);
    }
    assert.deepEqual([state.asked, state.most], [14, 4], 'two frames of two tasks');
    assert.equal((await post(`${address}/predict`, wanted(7))).status, 200, 'all are free again');
  });

  test('ends when nobody waits for it any more', async (t) => {
    const { origin, state, release, wanted } = await held(t);
    const address = await backend(t, { tasks: 4, allow: [origin] });
    const stop = new AbortController();
    const headers = { 'Content-Type': 'application/json' };
    const left = fetch(`${address}/predict`, { method: 'POST', headers, body: JSON.stringify(wanted(4)), signal: stop.signal });
    while (state.asked < 2) await sleep(5);
    stop.abort();
    await assert.rejects(left, { name: 'AbortError' });
    while (state.closed < 2) await sleep(5);
    void release();
    assert.equal((await post(`${address}/predict`, wanted(4))).status, 200);
    assert.equal(state.asked, 10, 'nothing was fetched for the tasks that waited');
  });

  test('is done for frames of a certain size, by their header', async (t) => {
    const pixels = 64 * 48 - 1;
    // The first bytes of a PNG of 4000×4000: a decoder that began would miss the rest.
    const header = Buffer.from(png(frames[0]).subarray(0, 33));
    header.writeUInt32BE(4000, 16);
    header.writeUInt32BE(4000, 20);
    const large = [header, png(frames[0]), ppm(frames[0]), bmp(frames[0])];
    // A header with a smaller size than the decoder finds: a comment longer than it is looked for.
    large.push(Buffer.concat([Buffer.from(`P6\n#${'.'.repeat(300_000)}\n64 48\n255\n`), Buffer.alloc(64 * 48 * 3)]));
    const of = async (file, options) => {
      const data = `data:image/png;base64,${base64(file)}`;
      return post(`${await backend(t, options)}/predict`, task(data, data));
    };
    for (const file of large) {
      const { status, body } = await of(file, { pixels });
      assert.deepEqual([status, body.error.code], [422, 'frame-size-unsupported'], JSON.stringify(body));
    }
    assert.equal((await of(png(frames[0]), { pixels: 64 * 48 })).status, 200);
  });
});

describe('requests', { timeout: 120_000 }, () => {
  test('are JSON', async (t) => {
    const address = await backend(t);
    for (const type of ['text/plain', 'application/x-www-form-urlencoded', 'multipart/form-data; boundary=x', 'text/plain; application/json', 'application/jsonp', '']) {
      const { status, body } = await post(`${address}/webhook`, {}, { 'Content-Type': type });
      assert.deepEqual([status, body.error.code], [415, 'not-json'], type);
    }
    for (const type of ['application/json; charset=utf-8', 'Application/JSON', 'application/json;charset=utf-8']) {
      assert.notEqual((await post(`${address}/webhook`, {}, { 'Content-Type': type })).status, 415, type);
    }
  });

  test('are for a name that the server has', async (t) => {
    const address = await backend(t, { knownAs: ['veronese.lan', '::1'] });
    const { port } = new URL(address);
    for (const host of ['evil.example', `evil.example:${port}`, '127.0.0.1.evil.example', 'localhost.evil.example', 'localhost@evil.example', '192.0.2.7', 'a b', '[::2]', 'localhost/']) {
      const { status, body } = await postAs(host, `${address}/health`, undefined, 'GET');
      assert.deepEqual([status, body.error?.code], [403, 'unknown-host'], host);
    }
    for (const host of [`127.0.0.1:${port}`, 'localhost', 'LocalHost:1', 'veronese.lan', 'VERONESE.lan:9090', '[::1]:9090']) {
      assert.equal((await postAs(host, `${address}/health`, undefined, 'GET')).status, 200, host);
    }
  });

  test('have a largest size', async (t) => {
    const address = await backend(t, { largest: 1000 });
    assert.equal((await post(`${address}/webhook`, JSON.stringify({ a: 'x'.repeat(900) }))).status, 200);
    const stated = await post(`${address}/webhook`, JSON.stringify({ a: 'x'.repeat(1000) }));
    assert.deepEqual([stated.status, stated.body.error.code], [413, 'too-large']);
    const pieces = new ReadableStream({
      start(controller) {
        for (let k = 0; k < 100; k++) controller.enqueue(Buffer.alloc(500, 32));
        controller.close();
      },
    });
    const headers = { 'Content-Type': 'application/json' };
    const streamed = await fetch(`${address}/webhook`, { method: 'POST', headers, body: pieces, duplex: 'half' });
    assert.equal(streamed.status, 413);
    assert.notEqual((await post(`${address}/webhook`, {})).status, 413);
  });
});
