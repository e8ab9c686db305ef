// A page on one origin, the package on another, as from a CDN: the same bits as a direct call in Node, and clear errors where the page's
// policy or the other server does not allow it.

import assert from 'node:assert/strict';
import { cpSync, rmSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { before, describe, test } from 'node:test';
import { segmentPair } from 'veronese';
import { png } from '../support/frames.mjs';
import { pair } from '../support/moving.mjs';
import { policyFor as documented } from '../support/readme.mjs';
import { outcomeOf, serve } from '../packed/browser.mjs';
import { app, browser } from '../packed/installed.mjs';
import { report } from '../packed/app/report.js';

const SHARED = { 'Access-Control-Allow-Origin': '*' };

let expected;
before(async () => {
  expected = await segmentPair(...pair());
  for (const [index, name] of ['first', 'second'].entries()) writeFileSync(join(app, `${name}.png`), png(pair()[index]));
});

/** The policy of the README; everything else is forbidden, but for the page's icon. */
const policyFor = (origin) => `default-src 'none'; img-src data:; ${documented(origin)}`;

/** Serves the package from an origin of its own, and a page with the script; returns the page's address. */
async function page(t, script, { folder = join(app, 'node_modules/veronese'), policy = policyFor } = {}) {
  const { address: far } = await serve(t, folder, SHARED);
  writeFileSync(join(app, 'far.js'), script(`${far}dist`));
  writeFileSync(join(app, 'far.html'), '<!doctype html>\n<link rel="icon" href="data:," />\n<script type="module" src="/far.js"></script>\n');
  const { address } = await serve(t, app, { 'Content-Security-Policy': policy(new URL(far).origin) });
  assert.notEqual(new URL(address).origin, new URL(far).origin);
  return `${address}far.html`;
}

const IN_WORKERS = (dist) => `
  import { Segmenter, segmentPair, segmentPairs } from '${dist}/web.js';
  import { first, second } from './frames.js';
  import { report } from './report.js';

  async function main() {
    const direct = report(await segmentPair(first, second));
    const segmenter = new Segmenter();
    const inWorker = report(await segmenter.segmentPair(first, second));
    const signal = AbortSignal.timeout(1);
    const cancelled = await segmenter.segmentPair(first, second, { signal }).catch(({ code }) => code);
    const again = report(await segmenter.segmentPair(first, second));
    segmenter.close();
    const pooled = [];
    for await (const { segmentation } of segmentPairs([{ first, second }, { first, second }], { jobs: 2 })) pooled.push(report(segmentation));
    return { direct, inWorker, cancelled, again, pooled };
  }

  globalThis.outcome = main().catch((error) => ({ error: error.code + ': ' + error.message }));
`;

describe('a package on another origin, under a strict content security policy', () => {
  test('direct, in a worker that is ended and replaced, in a pool', async (t) => {
    const { outcome, complaints } = await outcomeOf(t, browser, await page(t, IN_WORKERS));
    assert.deepEqual(complaints, []);
    const same = report(expected);
    assert.deepEqual(outcome, { direct: same, inWorker: same, cancelled: 'cancelled', again: same, pooled: [same, same] });
  });

  test('the element, with two frames and with a clip that a form submits', async (t) => {
    const script = (dist) => `
      import '${dist}/element.js';

      const segmented = (make, end) => new Promise((resolve, reject) => {
        const form = document.createElement('form');
        const element = document.createElement('veronese-segmenter');
        element.addEventListener(end, () => resolve({ form, element }));
        element.addEventListener('error', ({ detail: { code, message } }) => reject(new Error(code + ': ' + message)));
        element.setAttribute('name', 'masks');
        make(element);
        form.append(element);
        document.body.append(form);
      });

      async function main() {
        const pair = await segmented((element) => {
          element.setAttribute('first', 'first.png');
          element.setAttribute('second', 'second.png');
        }, 'result');
        const clip = await segmented((element) => (element.frames = ['first.png', 'second.png']), 'tracks');
        const files = new FormData(clip.form).getAll('masks').map(({ name, size }) => name + ' ' + (size > 50));
        return { labels: Array.from(pair.element.labels()).join(''), files };
      }

      globalThis.outcome = main().catch(({ message }) => ({ error: message }));
    `;
    const { outcome, complaints } = await outcomeOf(t, browser, await page(t, script));
    assert.deepEqual(complaints, []);
    assert.deepEqual(outcome, { labels: Array.from(expected.labels).join(''), files: ['00000.png true', '00001.png true'] });
  });

  test('a policy that allows no workers of blobs is an error that says what to allow', async (t) => {
    const policy = (origin) => policyFor(origin).replace(`worker-src blob: ${origin}`, "worker-src 'self'");
    const { outcome } = await outcomeOf(t, browser, await page(t, IN_WORKERS, { policy }));
    assert.match(outcome.error, /^worker-failed: .* its origin and blob: in worker-src/);
  });

  test('a file that the worker cannot import is an error that says what may be missing', async (t) => {
    const folder = join(app, 'without-worker');
    cpSync(join(app, 'node_modules/veronese'), folder, { recursive: true });
    rmSync(join(folder, 'dist/worker.js'));
    const { outcome } = await outcomeOf(t, browser, await page(t, IN_WORKERS, { folder }));
    assert.match(outcome.error, /^worker-failed: .*CORS/);
  });
});
