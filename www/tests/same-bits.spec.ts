//! The browser and Node give identical bits: motions, evidence and labels of problems; pixels and labels of the sample clip.

import { fileURLToPath } from 'node:url';

import { type MotionFit, fitMotions } from 'veronese';
import { decodeImage } from 'veronese/codecs';

import { clipInNode, differences, expect, labelsOnCanvas, openEmpty, openSegmented, pixelsOf, sampleClip, test } from './support.js';

// Every kind of them once; many in npm run soak.
const PROBLEMS = process.env.VERONESE_SOAK === undefined ? 20 : 200;
const PACKAGE = fileURLToPath(new URL('../../pkg/', import.meta.url));

interface Problem {
  positions: number[];
  derivatives: number[];
  motions: number | 'auto';
}

/** Measurements of one to four motions with noise and outliers, from operations that are exact on every platform. */
function problem(index: number): Problem {
  let state = 0x9e3779b9 ^ Math.imul(index + 1, 0x85ebca6b);
  const next = (): number => {
    state = (Math.imul(state, 1664525) + 1013904223) | 0;
    return (state >>> 8) / (1 << 23) - 1;
  };
  const n = 1 + (index % 4);
  const motions = Array.from({ length: n }, () => Array.from({ length: 6 }, next));
  const positions: number[] = [];
  const derivatives: number[] = [];
  for (let j = 0; j < 80 * n; j++) {
    const [x, y] = [next(), next()];
    const [a, b, c, d, e, f] = motions[j % n] as [number, number, number, number, number, number];
    const [gx, gy] = [next(), next()];
    const change = -(gx * (a * x + b * y + c) + gy * (d * x + e * y + f));
    positions.push(x, y);
    derivatives.push(gx + 0.02 * next(), gy + 0.02 * next(), j % 11 === 5 ? next() : change + 0.02 * next());
  }
  return { positions, derivatives, motions: index % 10 === 9 ? 'auto' : n };
}

/** All bits of a result as text: numbers survive JSON exactly. */
function bits(fit: Omit<MotionFit, 'labels'> & { labels: ArrayLike<number> }): string {
  return JSON.stringify([fit.motions, fit.evidence, Array.from(fit.labels)]);
}

test('fits in the browser equal those in Node', async ({ page, baseURL }) => {
  await page.route('**/package/**', async (route) => {
    await route.fulfill({ path: PACKAGE + new URL(route.request().url()).pathname.replace(/^.*\/package\//, '') });
  });
  await openEmpty(page);
  const problems = Array.from({ length: PROBLEMS }, (_, index) => problem(index));
  const inBrowser = await page.evaluate(
    async ([url, list]) => {
      const { fitMotions: fit } = (await import(url)) as typeof import('veronese');
      const answers: string[] = [];
      for (const { positions, derivatives, motions } of list) {
        const found = await fit({ positions: new Float64Array(positions), derivatives: new Float64Array(derivatives) }, { motions });
        answers.push(JSON.stringify([found.motions, found.evidence, Array.from(found.labels)]));
      }
      return answers;
    },
    [new URL('package/dist/web.js', baseURL).href, problems] as const,
  );
  expect(inBrowser).toHaveLength(PROBLEMS);
  for (const [index, { positions, derivatives, motions }] of problems.entries()) {
    const found = await fitMotions({ positions: new Float64Array(positions), derivatives: new Float64Array(derivatives) }, { motions });
    expect(inBrowser[index] === bits(found), `problem ${index}`).toBe(true);
  }
});

test('the frames of the sample clip have the same pixels and masks in the browser as in Node', { tag: '@soak' }, async ({ page }) => {
  const files = await sampleClip();
  const labels = await clipInNode(files);
  await openSegmented(page, files);
  await page.getByRole('slider', { name: 'Current frame' }).press('Home');
  for (const [index, { buffer }] of files.entries()) {
    if (index > 0) await page.keyboard.press('ArrowRight');
    await expect(page.locator('#caption')).toContainText(`Frame ${index}`);
    const { data } = await decodeImage(buffer);
    expect(differences((await pixelsOf(page, '#frame')).data, data), `pixels of frame ${index}`).toBe(0);
    expect(differences(await labelsOnCanvas(page), labels[index]!), `masks of frame ${index}`).toBe(0);
  }
});
