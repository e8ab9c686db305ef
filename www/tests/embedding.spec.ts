//! <veronese-segmenter> inside a page that knows nothing of it.

import { type Page } from '@playwright/test';
import { groupLabels } from 'veronese';

import { differences, expect, sample, segmentedInNode, test } from './support.js';

async function openHost(page: Page): Promise<void> {
  await page.goto('./embed.html');
  await expect(page.locator('#host-status')).toHaveText(/masks received/, { timeout: 30_000 });
}

/** The last labels of the element. */
function labels(page: Page): Promise<number[]> {
  return page.locator('veronese-segmenter').evaluate((element) => Array.from((element as HTMLElement & { labels(): Uint8Array }).labels()));
}

test('the host receives the masks of the package', async ({ page }) => {
  await openHost(page);
  const expected = await segmentedInNode(await sample('first'), await sample('second'), { quality: 'fast' });
  const groups = groupLabels(expected);
  expect(differences(await labels(page), groups)).toBe(0);
  const objects = [...new Set(groups)].filter((group) => group !== 0);
  await expect(page.locator('#annotations li')).toHaveCount(objects.length);
  const pixels = groups.filter((group) => group === objects[0]).length;
  await expect(page.locator('#annotations li').first()).toContainText(`${pixels} pixels`);
  await expect(page.getByRole('img', { name: /masks of \d motions?$/ })).toBeVisible();
});

test('attributes, events, methods and colours', async ({ page }) => {
  await openHost(page);
  await page.locator('[name=motions]').selectOption('2');
  await expect
    .poll(() => page.locator('veronese-segmenter').evaluate((element) => (element as HTMLElement & { result: { count: number } }).result.count))
    .toBe(2);
  // The host's own colour for mask 1.
  const colours = await page.locator('veronese-segmenter').evaluate((element) => {
    const canvas = element.shadowRoot!.querySelector<HTMLCanvasElement>('.masks')!;
    const { data } = canvas.getContext('2d')!.getImageData(0, 0, canvas.width, canvas.height);
    const seen = new Set<string>();
    for (let i = 0; i < data.length; i += 4) if (data[i + 3] !== 0) seen.add(data.slice(i, i + 4).join());
    return [...seen];
  });
  expect(colours).toEqual(['255,77,141,255']);

  const told = await page.evaluate(async () => {
    const element = document.createElement('veronese-segmenter') as HTMLElement & {
      setFrames(first: ImageData, second: ImageData): Promise<{ count: number }>;
      abort(): void;
      result: unknown;
    };
    const events: string[] = [];
    for (const type of ['progress', 'result', 'error']) element.addEventListener(type, (event) => events.push(`${type} ${(event as CustomEvent<{ code?: string }>).detail.code ?? ''}`.trim()));
    const picture = (shift: number): ImageData => {
      const image = new ImageData(96, 64);
      for (let p = 0; p < 96 * 64; p++) {
        const [x, y] = [(p % 96) - shift, Math.floor(p / 96)];
        const grey = 128 + 60 * Math.sin(0.5 * x + 0.2 * y) + 50 * Math.cos(0.4 * y - 0.15 * x);
        image.data.set([grey, grey, grey, 255], 4 * p);
      }
      return image;
    };
    document.body.append(element);
    const result = await element.setFrames(picture(0), picture(2));
    const cancelled = element.setFrames(picture(0), picture(3)).then(
      () => 'answered',
      (error: { code: string }) => error.code,
    );
    element.abort();
    const reason = await cancelled;
    element.setAttribute('motions', '99');
    await new Promise((resolve) => element.addEventListener('error', resolve, { once: true }));
    element.remove();
    return { events: [...new Set(events)], count: result.count, reason };
  });
  expect(told).toEqual({ events: ['progress', 'result', 'error invalid-option'], count: 1, reason: 'cancelled' });
});

test('a frame that is missing is an event of the element', async ({ page }) => {
  await openHost(page);
  await page.locator('veronese-segmenter').evaluate((element) => element.setAttribute('first', 'embed.html'));
  await expect(page.locator('#host-status')).toHaveText('No masks: the first frame is not an image that this browser can read.');
});
