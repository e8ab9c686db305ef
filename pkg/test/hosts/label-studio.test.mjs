// examples/hosts/label-studio.mjs, asked over HTTP as Label Studio asks.

import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { request } from 'node:http';
import { describe, test } from 'node:test';
import { segmentPair } from 'veronese';
import { encode } from 'veronese/formats';
import { startBackend } from '../../../examples/hosts/label-studio.mjs';
import { png } from '../support/frames.mjs';
import { pair } from '../support/moving.mjs';
import { listen, post } from './asking.mjs';

/**
 * The bodies of /setup and /predict that Label Studio 1.23.2 sent, word for word but for the token, of a project with the configuration of its
 * page. `label-studio start` of PyPI's package sent them, when a model was connected and predictions were retrieved. Here Label Studio is at
 * `origin`.
 */
function recorded(origin) {
  return JSON.parse(readFileSync(new URL('label-studio.json', import.meta.url), 'utf8').replaceAll('http://localhost:8097', origin));
}

/** Label Studio with these uploads, and a backend for it; `asked` is what came. */
async function studio(t, uploads, options = {}) {
  const asked = [];
  const origin = await listen(t, ({ url, headers }, response) => {
    asked.push([url, headers.authorization]);
    if (url === '/away') response.writeHead(302, { Location: options.away }).end();
    else response.writeHead(headers.authorization === 'Token secret' && uploads[url] ? 200 : 401).end(uploads[url]);
  });
  const started = await startBackend({ jobs: 1, studio: origin, ...options });
  t.after(() => started.close());
  return { origin, asked, address: started.address, requests: recorded(origin) };
}

/** The prediction of its one task. */
async function predicted(address, { setup, predict }) {
  assert.equal((await post(`${address}/setup`, setup)).status, 200);
  const { status, body } = await post(`${address}/predict`, predict);
  assert.equal(status, 200, JSON.stringify(body));
  assert.equal(body.results.length, 1);
  return body.results[0];
}

describe('the Label Studio backend', { timeout: 120_000 }, () => {
  test('predicts the masks of segmentPair for two images that only the token opens', async (t) => {
    const uploads = Object.values(recorded('').predict.tasks[0].data);
    const frames = pair();
    const { address, asked, requests } = await studio(t, Object.fromEntries(uploads.map((url, k) => [url, png(frames[k])])));
    assert.equal((await (await fetch(`${address}/health`)).json()).status, 'UP');
    const { result, score } = await predicted(address, requests);
    const { labels } = await segmentPair(...frames);
    const [{ content }] = await encode('label-studio', { labels, width: 64, height: 48 }, { labels: [1] });
    const [expected] = JSON.parse(content)[0].predictions[0].result;
    const [{ from_name: from, to_name: to, value }] = result;
    assert.deepEqual([result.length, from, to, value.brushlabels, value.rle], [1, 'moving', 'first', ['moving-1'], expected.value.rle]);
    assert.ok(score > 0.5 && score <= 1, String(score));
    assert.deepEqual(asked.sort((a, b) => uploads.indexOf(a[0]) - uploads.indexOf(b[0])), uploads.map((url) => [url, 'Token secret']));
  });

  test('asks no server that was not named, sends its token to none but Label Studio, and answers programs alone', async (t) => {
    const others = [];
    const other = await listen(t, ({ url, headers }, response) => {
      others.push([url, headers.authorization]);
      response.end(png(pair()[0]));
    });
    const { address, requests } = await studio(t, {}, { token: 'secret', away: `${other}/away.png` });
    const ask = async (to, first, headers) => {
      const { predict } = structuredClone(requests);
      predict.tasks[0].data = { first, second: first };
      const { status, body } = await post(`${to}/predict`, predict, headers);
      return [status, body.error?.code];
    };
    for (const foreign of [`${other}/0.png`, `//${new URL(other).host}/0.png`, '/away', 'file:///etc/hostname']) {
      assert.deepEqual(await ask(address, foreign), [422, 'address-refused'], foreign);
    }
    assert.deepEqual(others, []);
    const allowing = await studio(t, {}, { token: 'secret', away: `${other}/away.png`, allow: [other] });
    assert.deepEqual(await ask(allowing.address, '/away'), [200, undefined]);
    assert.deepEqual(others, Array(2).fill(['/away.png', undefined]));
    assert.deepEqual(allowing.asked, Array(2).fill(['/away', 'Token secret']));

    assert.deepEqual(await ask(address, '/0.png', { 'Content-Type': 'text/plain' }), [415, 'not-json']);
    // `fetch` sends no other host.
    const status = await new Promise((resolve) => request(`${address}/health`, { headers: { Host: 'evil.example' } }, (response) => resolve(response.statusCode)).end());
    assert.equal(status, 403);
  });
});
