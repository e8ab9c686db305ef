// The servers of examples/hosts, asked over HTTP as the annotation tools ask.

import assert from 'node:assert/strict';
import { createServer } from 'node:http';
import { describe, test } from 'node:test';
import { segmentPair } from 'veronese';
import { detect, end, handler, startFunction } from '../../../examples/hosts/cvat.mjs';
import { readConfig, startBackend } from '../../../examples/hosts/label-studio.mjs';
import { png } from '../support/frames.mjs';
import { pair } from '../support/moving.mjs';

const CONFIG = `<View>
  <Image name="before" value="$first"/><Image name="after" value="$second"/>
  <BrushLabels name="moving" toName="before"><Label value="car &amp; shadow" background="#f00"/><Label value="second"/></BrushLabels>
</View>`;
const frames = pair();

/** The frames on a server of their own; one address wants a token, as Label Studio's uploads do. */
async function files(t) {
  const asked = [];
  const server = createServer((request, response) => {
    asked.push(request.url);
    const [, index] = /^\/(?:data\/)?(\d)\.png$/.exec(request.url) ?? [];
    const allowed = !request.url.startsWith('/data/') || request.headers.authorization === 'Token secret';
    if (!frames[index] || !allowed) response.writeHead(allowed ? 404 : 401).end();
    else response.end(png(frames[index]));
  });
  await new Promise((resolve) => server.listen(0, '127.0.0.1', resolve));
  t.after(() => server.close());
  return { address: `http://127.0.0.1:${server.address().port}`, asked };
}

async function post(address, body) {
  const text = typeof body === 'string' ? body : JSON.stringify(body);
  const response = await fetch(address, { method: 'POST', headers: { 'Content-Type': 'application/json' }, body: text });
  return { status: response.status, body: await response.json() };
}

/** Label Studio's own way of reading a brush, by its description: bits, from the highest of each byte. */
function decodeBrush(bytes) {
  let at = 0;
  const read = (count) => {
    let value = 0;
    for (let k = 0; k < count; k++, at++) value = value * 2 + ((bytes[at >> 3] >> (7 - (at & 7))) & 1);
    return value;
  };
  const count = read(32);
  const wordSize = read(5) + 1;
  const sizes = [0, 0, 0, 0].map(() => read(4) + 1);
  const values = [];
  while (values.length < count) {
    const repeated = read(1);
    const length = read(sizes[read(2)]) + 1;
    if (repeated) {
      const value = read(wordSize);
      for (let k = 0; k < length; k++) values.push(value);
    } else for (let k = 0; k < length; k++) values.push(read(wordSize));
  }
  return values;
}

describe('the Label Studio backend', () => {
  async function backend(t) {
    const started = await startBackend({ jobs: 1 });
    t.after(() => started.close());
    return started.address;
  }

  test('health, set-up, versions, webhook', async (t) => {
    const address = await backend(t);
    assert.equal((await (await fetch(`${address}/health`)).json()).status, 'UP');
    assert.match((await post(`${address}/setup`, { project: '1.2', schema: CONFIG, hostname: 'http://localhost:1', access_token: 'x' })).body.model_version, /^veronese-\d/);
    assert.equal((await (await fetch(`${address}/versions?project=1.2`)).json()).versions.length, 1);
    assert.equal((await post(`${address}/webhook`, { action: 'START_TRAINING' })).status, 200);
  });

  test('predictions are the masks of segmentPair, one answer for each task', async (t) => {
    const [address, { address: host }] = [await backend(t), await files(t)];
    const data = { first: `${host}/0.png`, second: `${host}/1.png` };
    const { status, body } = await post(`${address}/predict`, { tasks: [{ id: 1, data }, { id: 2, data }], label_config: CONFIG });
    assert.equal(status, 200);
    assert.equal(body.results.length, 2);
    assert.deepEqual(body.results[0], body.results[1]);
    const { labels, count } = await segmentPair(...frames);
    const [{ result, score, model_version: version }] = body.results;
    assert.equal(result.length, count - 1);
    assert.ok(score > 0.5 && score <= 1, String(score));
    assert.match(version, /^veronese-/);
    const [{ from_name: from, to_name: to, type, original_width: width, original_height: height, value }] = result;
    assert.deepEqual([from, to, type, width, height, value.format, value.brushlabels], ['moving', 'before', 'brushlabels', 64, 48, 'rle', ['car & shadow']]);
    assert.deepEqual(decodeBrush(value.rle), [...labels].flatMap((label) => Array(4).fill(label === 1 ? 255 : 0)));
  });

  test("fetches Label Studio's own files by the token of its set-up", async (t) => {
    const [address, { address: host, asked }] = [await backend(t), await files(t)];
    const task = { data: { first: '/data/0.png', second: '/data/1.png' } };
    const before = await post(`${address}/predict`, { tasks: [task], label_config: CONFIG });
    assert.deepEqual([before.status, before.body.error.code], [422, 'invalid-input']);
    await post(`${address}/setup`, { hostname: host, access_token: 'secret' });
    assert.equal((await post(`${address}/predict`, { tasks: [task], label_config: CONFIG })).status, 200);
    assert.deepEqual(asked.sort(), ['/data/0.png', '/data/1.png']);
  });

  test('says what is wrong, and goes on', async (t) => {
    const [address, { address: host }] = [await backend(t), await files(t)];
    const task = (first, second) => ({ tasks: [{ data: { first, second } }], label_config: CONFIG });
    for (const [body, status, code] of [
      ['{"tasks', 400, 'invalid-json'],
      [{}, 400, 'invalid-input'],
      [{ tasks: [{}], label_config: '<View/>' }, 422, 'invalid-input'],
      [{ tasks: [{}], label_config: '<View><Image name="a" value="$a"/><BrushLabels name="b" toName="a"/></View>' }, 422, 'invalid-input'],
      [task(`${host}/0.png`), 422, 'invalid-input'],
      [task(`${host}/0.png`, 'file:///etc/hostname'), 422, 'invalid-input'],
      [task(`${host}/0.png`, `${host}/7.png`), 422, 'file-not-found'],
      [task(`${host}/0.png`, 'http://127.0.0.1:9/1.png'), 422, 'file-not-found'],
    ]) {
      const answer = await post(`${address}/predict`, body);
      assert.deepEqual([answer.status, answer.body.error.code], [status, code], JSON.stringify(body));
    }
    assert.equal((await fetch(`${address}/train`)).status, 404);
    assert.equal((await post(`${address}/predict`, task(`${host}/0.png`, `${host}/1.png`))).status, 200);
  });

  test('reads configurations however they are written', () => {
    assert.deepEqual(readConfig(CONFIG), { fromName: 'moving', toName: 'before', labels: ['car & shadow', 'second'], keys: ['first', 'second'] });
  });
});

describe('the CVAT function', () => {
  const request = () => ({ image: Buffer.from(png(frames[0])).toString('base64'), second: Buffer.from(png(frames[1])).toString('base64') });

  async function check(found) {
    const { labels, motions } = await segmentPair(...frames);
    assert.equal(found.length, motions.length - 1);
    for (const { confidence, label, type, points, mask } of found) {
      const number = Number(label.replace('motion-', ''));
      const [left, top, right, bottom] = mask.slice(-4);
      assert.deepEqual([left, top, right - left + 1, bottom - top + 1], motions[number].bbox);
      const pixels = mask.slice(0, -4);
      assert.equal(pixels.length, motions[number].bbox[2] * motions[number].bbox[3]);
      const whole = [...labels].map((_, at) => {
        const [x, y] = [at % 64, Math.floor(at / 64)];
        const inside = x >= left && x <= right && y >= top && y <= bottom;
        return inside ? pixels[(y - top) * (right - left + 1) + x - left] : 0;
      });
      assert.deepEqual(whole, [...labels].map((label) => Number(label === number)));
      assert.equal(type, 'mask');
      assert.ok(points.length >= 6 && points.length % 2 === 0);
      assert.ok(Number(confidence) > 0.5 && Number(confidence) <= 1);
    }
  }

  test('over HTTP', async (t) => {
    const server = await startFunction({ jobs: 1 });
    t.after(() => server.close());
    const { status, body } = await post(server.address, request());
    assert.equal(status, 200);
    await check(body);
    assert.deepEqual((await post(server.address, { ...request(), threshold: 1 })).body, []);
    for (const [bad, code] of [[{}, 'invalid-input'], [{ image: request().image }, 'invalid-input'], [{ ...request(), second: 'AAAA' }, 'unreadable-image']]) {
      const answer = await post(server.address, bad);
      assert.deepEqual([answer.status, answer.body.error.code], [422, code]);
    }
  });

  test("as nuclio's handler", async (t) => {
    t.after(end);
    const call = (body) => new Promise((resolve) => {
      class Response { constructor(body, headers, type, status) { Object.assign(this, { body, type, status }); } }
      handler({ Response, callback: resolve }, { body });
    });
    const { status, type, body } = await call(Buffer.from(JSON.stringify(request())));
    assert.deepEqual([status, type], [200, 'application/json']);
    await check(JSON.parse(body));
    assert.equal((await call(request())).status, 200, 'or an object, as nuclio gives it');
    assert.equal((await call({})).status, 422);
  });

  test('nothing moves: no masks', async (t) => {
    t.after(end);
    const segment = async () => segmentPair(frames[0], frames[0], { confidence: true });
    assert.deepEqual(await detect(segment, request()), []);
  });
});
