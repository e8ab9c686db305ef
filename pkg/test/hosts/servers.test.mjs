// The servers of examples/hosts, asked over HTTP as the annotation tools ask.

import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { describe, test } from 'node:test';
import { segmentPair } from 'veronese';
import { encode } from 'veronese/formats';
import { png } from '../support/frames.mjs';
import { CONFIG, backend, files, frames, listen, post, recorded, task } from './asking.mjs';

describe('the Label Studio backend', () => {
  test('health, set-up, versions, webhook', async (t) => {
    const address = await backend(t);
    assert.equal((await (await fetch(`${address}/health`)).json()).status, 'UP');
    assert.match((await post(`${address}/setup`, { project: '1.2', schema: CONFIG, hostname: 'http://localhost:1', access_token: 'x' })).body.model_version, /^veronese-\d/);
    assert.equal((await (await fetch(`${address}/versions?project=1.2`)).json()).versions.length, 1);
    assert.equal((await post(`${address}/webhook`, { action: 'START_TRAINING' })).status, 200);
  });

  test('what Label Studio sends for the configurations and tasks of its page', async (t) => {
    const { origin, asked } = await files(t);
    const { pairs, videos } = recorded(origin);
    const page = readFileSync(new URL('../../../examples/hosts/label-studio.md', import.meta.url), 'utf8');
    const on = (pattern) => Array.from(page.matchAll(pattern), ([, text]) => text);
    assert.deepEqual(on(/```xml\n([^]*?)\n```/g), [pairs, videos].map(({ setup }) => setup.schema));
    const keys = ({ predict }) => Object.keys(predict.tasks[0].data);
    assert.deepEqual(on(/A task is `(\{[^`]*\})`/g).map((task) => Object.keys(JSON.parse(task))), [pairs, videos].map(keys));

    const address = await backend(t, { studio: origin });
    assert.equal((await post(`${address}/setup`, pairs.setup)).status, 200);
    const { status, body } = await post(`${address}/predict`, pairs.predict);
    assert.equal(status, 200, JSON.stringify(body));
    assert.deepEqual(body.results[0].result.map(({ value }) => value.brushlabels), [['moving-1']]);
    const uploads = Object.values(pairs.predict.tasks[0].data);
    assert.deepEqual(asked.sort((a, b) => uploads.indexOf(a.url) - uploads.indexOf(b.url)), uploads.map((url) => ({ url, token: 'Token secret' })));
  });

  test('predictions are the masks of segmentPair, one answer for each task', async (t) => {
    const { origin } = await files(t);
    const address = await backend(t, { allow: [origin] });
    const data = { first: `${origin}/0.png`, second: `${origin}/1.png` };
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
    const [{ content }] = await encode('label-studio', { labels, width: 64, height: 48 }, { labels: [1] });
    const [expected] = JSON.parse(content)[0].predictions[0].result;
    assert.deepEqual(value.rle, expected.value.rle);
  });

  test('frames may be in the task itself, as data addresses', async (t) => {
    const address = await backend(t);
    const [first, second] = frames.map((frame) => `data:image/png;base64,${Buffer.from(png(frame)).toString('base64')}`);
    const { status, body } = await post(`${address}/predict`, task(first, second));
    assert.equal(status, 200, JSON.stringify(body));
    assert.equal(body.results[0].result.length, 1);
  });

  test("fetches Label Studio's own files by the token of its set-up", async (t) => {
    const { origin, asked } = await files(t);
    const wanted = task('/data/0.png', `${origin}/data/1.png`);
    const without = await post(`${await backend(t)}/predict`, wanted);
    assert.deepEqual([without.status, without.body.error.code], [422, 'invalid-input']);
    const address = await backend(t, { studio: origin });
    const before = await post(`${address}/predict`, wanted);
    assert.deepEqual([before.status, before.body.error.code], [422, 'file-not-found']);
    assert.match(before.body.error.message, /answered 401.*LABEL_STUDIO_API_KEY/);
    await post(`${address}/setup`, { hostname: origin, access_token: 'secret' });
    asked.length = 0;
    assert.equal((await post(`${address}/predict`, wanted)).status, 200);
    assert.deepEqual(asked.map(({ url }) => url).sort(), ['/data/0.png', '/data/1.png']);
  });

  test('a personal access token is exchanged for one that opens files', async (t) => {
    const asked = [];
    const origin = await listen(t, async (incoming, response) => {
      const { method, url, headers } = incoming;
      const body = Buffer.concat(await incoming.toArray()).toString();
      asked.push([method, url]);
      const [, index] = /^\/data\/(\d)\.png$/.exec(url) ?? [];
      if (index !== undefined) response.writeHead(headers.authorization === 'Bearer brief' ? 200 : 401).end(png(frames[index]));
      else response.writeHead(body === '{"refresh":"a.b.c"}' ? 200 : 401).end('{"access":"brief"}');
    });
    const ask = async (token) => post(`${await backend(t, { studio: origin, token })}/predict`, task('/data/0.png', '/data/1.png'));
    assert.equal((await ask('a.b.c')).status, 200);
    assert.deepEqual(asked.slice(0, 2), Array(2).fill(['POST', '/api/token/refresh']));
    const { status, body } = await ask('a.b.d');
    assert.deepEqual([status, body.error.code], [422, 'file-not-found']);
    assert.match(body.error.message, /answered 401.*LABEL_STUDIO_API_KEY/);
  });

  test('origin and token of the environment', async (t) => {
    const { origin } = await files(t);
    Object.assign(process.env, { LABEL_STUDIO_URL: `${origin}/`, LABEL_STUDIO_API_KEY: 'secret' });
    t.after(() => {
      delete process.env.LABEL_STUDIO_URL;
      delete process.env.LABEL_STUDIO_API_KEY;
    });
    assert.equal((await post(`${await backend(t)}/predict`, task('/data/0.png', '/data/1.png'))).status, 200);
  });

  test('says what is wrong, and goes on', async (t) => {
    const { origin } = await files(t);
    const address = await backend(t, { allow: [origin, 'http://127.0.0.1:9'] });
    for (const [body, status, code] of [
      ['{"tasks', 400, 'invalid-json'],
      ['null', 400, 'invalid-input'],
      [{}, 400, 'invalid-input'],
      [{ tasks: [null], label_config: CONFIG }, 400, 'invalid-input'],
      [{ tasks: [{}] }, 422, 'invalid-input'],
      [{ tasks: [{}], label_config: CONFIG }, 422, 'invalid-input'],
      [{ tasks: [{}], label_config: '<View/>' }, 422, 'invalid-input'],
      [{ tasks: [{}], label_config: '<View><Image name="a" value="$a"/><BrushLabels name="b" toName="a"/></View>' }, 422, 'invalid-input'],
      [task(`${origin}/0.png`), 422, 'invalid-input'],
      [task(`${origin}/0.png`, `${origin}/7.png`), 422, 'file-not-found'],
      [task(`${origin}/0.png`, 'http://127.0.0.1:9/1.png'), 422, 'file-not-found'],
      [task(`${origin}/0.png`, 'data:image/png;base64,AAAA'), 422, 'unreadable-image'],
      [task(`${origin}/0.png`, 'data:nonsense'), 422, 'unreadable-file'],
    ]) {
      const answer = await post(`${address}/predict`, body);
      assert.deepEqual([answer.status, answer.body.error.code], [status, code], `${JSON.stringify(body)}: ${JSON.stringify(answer.body)}`);
    }
    for (const path of ['/setup', '/webhook']) assert.equal((await post(address + path, 'null')).status, 400, path);
    assert.equal((await fetch(`${address}/train`)).status, 404);
    assert.equal((await post(`${address}/predict`, task(`${origin}/0.png`, `${origin}/1.png`))).status, 200);
  });
});
