// The worker of the figures: what ends it does not end them.

import { expect, test } from '@playwright/test';

test('a trap ends the worker, and the next call and those that wait get a fresh one', async ({ page, baseURL }) => {
  const whole = `http://127.0.0.1:${Number(new URL(baseURL).port) + 1}/`;
  const addresses = [];
  page.on('worker', (worker) => addresses.push(worker.url()));
  await page.goto(`${whole}out/site/404.html`);
  const told = await page.evaluate(async () => {
    const { computer } = await import('/site/client/compute.mjs');
    const ask = computer(new URL('/out/site/client/worker.js', location.href));
    const lines = () => ask('veroneseMap', Float64Array.of(1, 1, 2, 2, -1, 1, -3, 3), 2, 2).then(({ rank }) => rank);
    const failure = (promise) => promise.then(() => 'no failure', ({ code, message }) => `${code}: ${message}`);
    // The module has no room for an array of this length.
    const trap = () => ask('veroneseMap', { length: 2 ** 28 }, 2, 1);
    const before = await lines();
    const refused = await failure(ask('veroneseMap', Float64Array.of(1, 1), 2, 0));
    const still = await lines();
    const [trapped, waited] = await Promise.all([failure(trap()), lines()]);
    const again = await failure(trap());
    return { before, refused, still, trapped, waited, again, after: await lines() };
  });
  expect(told).toEqual({ before: 2, refused: expect.stringMatching(/^invalid-option: /), still: 2, trapped: 'undefined: unreachable', waited: 2, again: 'undefined: unreachable', after: 2 });
  // A refusal keeps the worker; each of the two traps costs one.
  expect(addresses.map((address) => new URL(address).pathname)).toEqual(Array(3).fill('/out/site/client/worker.js'));
});
