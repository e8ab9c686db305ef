//! <veronese-segmenter> in a host page.

import { readFile } from 'node:fs/promises';

import { type Page } from '@playwright/test';
import { davisPalette, groupLabels } from 'veronese';
import { decodeImage } from 'veronese/codecs';

import { axe, clipFrames, clipInNode, differences, expect, sample, segmentedInNode, smallSampleClip, test, withSmallSampleClip } from './support.js';
import { video } from './video.js';

/** Opens the host page with its clip or, by name, another of its sources. */
async function openHost(page: Page, source = 'Passing cars, clip'): Promise<void> {
  await withSmallSampleClip(page);
  await page.goto('./embed.html');
  if (source !== 'Passing cars, clip') await page.getByLabel('Source').selectOption(source);
  await expect(page.locator('#host-status')).toHaveText(source.endsWith('clip') ? /objects? in 33 frames\.$/ : /objects? in two frames\.$/);
}

/** The current labels of the element. */
async function labels(page: Page): Promise<Uint8Array> {
  const base64 = await page.locator('veronese-segmenter').evaluate((element) => {
    let binary = '';
    for (const label of (element as HTMLElement & { labels(): Uint8Array }).labels()) binary += String.fromCharCode(label);
    return btoa(binary);
  });
  return new Uint8Array(Buffer.from(base64, 'base64'));
}

test('the host receives the masks of the package; attributes, events, methods and colours', async ({ page }) => {
  await openHost(page, 'Two cars, pair');
  const expected = await segmentedInNode(await sample('first'), await sample('second'), { quality: 'fast' });
  const groups = groupLabels(expected);
  expect(differences(await labels(page), groups)).toBe(0);
  const objects = [...new Set(groups)].filter((group) => group !== 0);
  await expect(page.locator('#annotations li')).toHaveCount(objects.length);
  const pixels = groups.filter((group) => group === 1).length;
  await expect(page.locator('#annotations li').first()).toContainText(`${pixels.toLocaleString('en-GB')} pixels`);
  await expect(page.getByRole('img', { name: /masks of \d motions?$/ })).toBeVisible();
  await expect(page.locator('#timeline')).toBeHidden();

  await page.locator('#motions').selectOption('2');
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
  expect(colours).toEqual(['255,92,147,255']);

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

  // An unreadable frame raises an error event.
  await page.locator('veronese-segmenter').evaluate((element) => {
    element.setAttribute('first', 'embed.html');
    element.setAttribute('second', 'embed.html');
  });
  await expect(page.locator('#host-status')).toHaveText('No masks: the first frame is not an image that this browser can read.');
});

test('a clip is stepped, named and saved', async ({ page }) => {
  await openHost(page);
  const expected = await clipInNode((await smallSampleClip()).slice(16, 49));
  expect(differences(await labels(page), expected[0]!)).toBe(0);
  await page.getByRole('button', { name: 'Next frame' }).click();
  await expect(page.locator('#position')).toHaveText('Frame 2 of 33');
  expect(differences(await labels(page), expected[1]!)).toBe(0);
  const lane = page.locator('#lanes > div').nth(1);
  const box = (await lane.boundingBox())!;
  await lane.click({ position: { x: box.width - 2, y: 10 } });
  await expect(page.locator('#position')).toHaveText('Frame 33 of 33');
  await expect(page.getByRole('option', { name: 'Object 2', selected: true })).toBeAttached();
  await expect(page.getByRole('button', { name: 'Choose object 2' })).toHaveAttribute('aria-pressed', 'true');

  await page.getByRole('textbox', { name: 'Name of object 2' }).fill('red car');
  await expect(lane).toHaveText('red car');
  await page.getByRole('button', { name: 'Save' }).click();
  const saved = page.getByRole('dialog', { name: 'Saved by the form' });
  await expect(saved.getByRole('listitem')).toHaveCount(35);
  await expect(saved.getByRole('listitem').last()).toHaveText('object-2red car');
  const waiting = page.waitForEvent('download');
  await saved.getByRole('link', { name: '00002.png' }).click();
  const download = await waiting;
  expect(download.suggestedFilename()).toBe('00002.png');
  const { data } = await decodeImage(await readFile(await download.path()));
  const palette = davisPalette().map((colour) => [...colour, 255]);
  const colours = new Uint8Array(data.length);
  expected[2]!.forEach((label, p) => colours.set(palette[label]!, 4 * p));
  expect(differences(data, colours)).toBe(0);
  await saved.getByRole('button', { name: 'Close' }).click();

  await page.getByRole('button', { name: 'Reset' }).click();
  await expect(page.locator('#position')).toHaveText('Frame 1 of 33');
  await expect(page.getByRole('textbox', { name: 'Name of object 2' })).toHaveValue('');
  await expect(page.getByRole('listbox', { name: 'Objects' }).getByRole('option', { selected: true })).toHaveCount(0);
});

test('nothing is saved before the masks are there, and a clip can be cancelled; frames are copied, and invalid ones rejected', async ({ page }) => {
  await withSmallSampleClip(page);
  await page.goto('./embed.html');
  const cancel = page.getByRole('button', { name: 'Cancel' });
  await cancel.waitFor();
  await page.getByRole('button', { name: 'Save' }).click();
  await expect(page.getByRole('dialog')).toBeHidden();
  expect(await page.locator('veronese-segmenter').evaluate((element) => (element as HTMLInputElement).validationMessage)).toBe('The masks are not ready yet.');
  await cancel.click();
  await expect(page.locator('#host-status')).toHaveText('Cancelled.');
  await expect(cancel).toBeHidden();

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
    for (const [name, value] of [['motions', 'two'], ['quality', 'good']] as const) {
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
  expect(told.codes).toEqual([...input, 'unreadable-image', 'unreadable-image', 'invalid-option', 'invalid-option']);
  expect(told.after).toBe(96 * 64);
});

test('frames and videos are opened from files', async ({ page }) => {
  await openHost(page, 'Parallax, pair');
  await page.getByLabel('Open a video, or frames as images').setInputFiles((await clipFrames(3, 96, 64)).reverse());
  await expect(page.locator('#host-status')).toHaveText(/in 3 frames\.$/);
  await page.getByLabel('Open a video, or frames as images').setInputFiles(await video(page, 4, 'webm', 'vp8'));
  await expect(page.locator('#host-status')).toHaveText(/in 4 frames\.$/);
  await page.getByLabel('Open a video, or frames as images').setInputFiles({ name: 'notes.mp4', mimeType: 'video/mp4', buffer: Buffer.from('text') });
  await expect(page.locator('#host-status')).toHaveText('No masks: the clip is not a video that this browser can read.');
});

test('axe finds nothing serious, light and dark; nothing scrolls at 1280 × 720, nor sideways on a phone', async ({ page }) => {
  await page.setViewportSize({ width: 1280, height: 720 });
  await page.emulateMedia({ reducedMotion: 'reduce' });
  await openHost(page);
  const overflow = (): Promise<number[]> =>
    page.evaluate(() => {
      const { scrollWidth, scrollHeight, clientWidth, clientHeight } = document.documentElement;
      return [scrollWidth - clientWidth, scrollHeight - clientHeight];
    });
  expect(await overflow()).toEqual([0, 0]);
  await page.getByRole('button', { name: 'Choose object 1' }).click();
  for (const colorScheme of ['light', 'dark'] as const) {
    await page.emulateMedia({ colorScheme });
    expect(await axe(page)).toEqual([]);
    await page.getByRole('button', { name: 'Save' }).click();
    await expect(page.getByRole('dialog')).toBeVisible();
    expect(await axe(page)).toEqual([]);
    await page.getByRole('dialog').getByRole('button', { name: 'Close' }).click();
  }
  await page.setViewportSize({ width: 390, height: 844 });
  expect((await overflow())[0]).toBe(0);
});
