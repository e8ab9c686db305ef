//! <veronese-segmenter> in a host page.

import { type Page } from '@playwright/test';
import { groupLabels } from 'veronese';

import { differences, expect, sample, segmentedInNode, test } from './support.js';

async function openHost(page: Page): Promise<void> {
  await page.goto('./embed.html');
  await expect(page.locator('#host-status')).toHaveText(/masks received/, { timeout: 30_000 });
}

/** The current labels of the element. */
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
  // The host page's style sets the colour of mask 1.
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

test('frames are copied, and invalid ones rejected', async ({ page }) => {
  await openHost(page);
  const told = await page.evaluate(async () => {
    type Frames = HTMLElement & { setFrames(first: unknown, second: unknown): Promise<{ labels: Uint8Array }>; segment(): Promise<{ labels: Uint8Array }> };
    const element = document.createElement('veronese-segmenter') as Frames;
    element.setAttribute('quality', 'fast');
    document.body.append(element);
    const picture = (shift: number): ImageData => {
      const image = new ImageData(96, 64);
      for (let p = 0; p < 96 * 64; p++) {
        const [x, y] = [(p % 96) - (p % 96 > 48 ? shift : 0), Math.floor(p / 96)];
        const grey = 128 + 60 * Math.sin(0.5 * x + 0.2 * y) + 50 * Math.cos(0.4 * y - 0.15 * x);
        image.data.set([grey, grey, grey, 255], 4 * p);
      }
      return image;
    };
    const expected = (await element.setFrames(picture(0), picture(2))).labels;
    const bitmaps = [await createImageBitmap(picture(0)), await createImageBitmap(picture(2))] as const;
    const images = [picture(0), picture(2)] as const;
    const answers: Uint8Array[] = [];
    for (const [first, second] of [images, bitmaps]) {
      const answer = element.setFrames(first, second);
      for (const frame of [first, second]) frame instanceof ImageData ? frame.data.fill(7) : frame.close();
      answers.push((await answer).labels);
      // The element segments them again when an attribute changes.
      answers.push((await element.segment()).labels);
    }
    const same = answers.map((labels) => String(labels) === String(expected));
    const gone = picture(0);
    structuredClone(gone.data.buffer, { transfer: [gone.data.buffer] });
    const codes: string[] = [];
    for (const wrong of [null, undefined, 5, {}, [], { data: [1], width: 16, height: 16 }, gone, bitmaps[0], new Blob(['text'])]) {
      codes.push(await element.setFrames(picture(0), wrong).then(() => 'answered', ({ code }: { code: string }) => code));
    }
    for (const [name, value] of [['motions', 'two'], ['quality', 'good'], ['seed', '-1']] as const) {
      element.setAttribute(name, value);
      codes.push(await element.setFrames(picture(0), picture(2)).then(() => 'answered', ({ code }: { code: string }) => code));
      element.removeAttribute(name);
    }
    const after = await element.setFrames(picture(0), picture(2)).then(({ labels }) => labels.length);
    element.remove();
    return { same, codes, after };
  });
  expect(told.same).toEqual([true, true, true, true]);
  const input = Array<string>(7).fill('invalid-input');
  expect(told.codes).toEqual([...input, 'unreadable-image', 'unreadable-image', 'invalid-option', 'invalid-option', 'invalid-option']);
  expect(told.after).toBe(96 * 64);
});

test('an unreadable frame raises an error event', async ({ page }) => {
  await openHost(page);
  await page.locator('veronese-segmenter').evaluate((element) => element.setAttribute('first', 'embed.html'));
  await expect(page.locator('#host-status')).toHaveText('No masks: the first frame is not an image that this browser can read.');
});
