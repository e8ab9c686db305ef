//! The open pair stays until its replacement is ready, and a failure to open something changes nothing.

import { type Page } from '@playwright/test';

import { video } from './video.js';
import { type Upload, clipDone, clipFrames, done, expect, held, holdSamples, openEmpty, openSample, opened, said, square, test, upload, withSamples } from './support.js';

const BROKEN: Upload = { name: 'broken.png', mimeType: 'image/png', buffer: Buffer.from('no image at all') };

async function openClip(page: Page, count: number): Promise<void> {
  await upload(page, [await video(page, count, 'webm', 'vp8')]);
  await expect(page.locator('#clip-name')).toHaveText(`clip.webm, ${count} frames, 192 × 128`);
  await done(page);
}

/** The clip can still be stepped through. */
async function expectToStep(page: Page, first: number): Promise<void> {
  await page.getByRole('button', { name: 'Step forward' }).click();
  await expect(page.locator('#caption')).toHaveText(`Frame ${first}`);
  await done(page);
}

test('the worker starts and warms up while the first frames are on their way; a broken file does not lose a correction that is being carried', async ({ page }) => {
  await holdSamples(page);
  const worker = page.waitForEvent('worker');
  await page.goto('./#sample=parallax&quality=fast');
  await worker;
  await withSamples(page);
  await clipDone(page);

  await page.locator('#tools [value=brush]').check();
  const box = (await page.locator('.layers').boundingBox())!;
  await page.mouse.move(box.x + 0.2 * box.width, box.y + 0.3 * box.height);
  await page.mouse.down();
  await page.mouse.move(box.x + 0.26 * box.width, box.y + 0.7 * box.height, { steps: 8 });
  // The stroke ends and the file is pasted in one task, so the stroke is not carried yet.
  await page.evaluate(() => {
    const layers = document.querySelector('.layers')!;
    layers.addEventListener('pointerup', () => {
      const transfer = new DataTransfer();
      transfer.items.add(new File(['no image at all'], 'broken.png', { type: 'image/png' }));
      document.body.dispatchEvent(new ClipboardEvent('paste', { bubbles: true, cancelable: true, clipboardData: transfer }));
    });
  });
  await page.mouse.up();
  await expect(page.getByRole('alert')).toContainText('“broken.png” is not an image');
  await said(page, /^Corrected/);
  await expect(page.locator('#undo')).toBeEnabled();
});

test('a broken file does not switch the camera off, and the camera replaces a clip once it is on', async ({ page, context }) => {
  await context.grantPermissions(['camera']);
  await openEmpty(page);
  await page.getByRole('button', { name: 'Camera' }).click();
  await expect(page.locator('#status')).toHaveText(/^Live: /);
  await upload(page, [BROKEN]);
  await expect(page.getByRole('alert')).toContainText('“broken.png” is not an image');
  await expect(page.locator('#status')).toHaveText(/^Live: /);
  await expect(page.getByRole('button', { name: 'Stop camera' })).toBeVisible();
  // A readable one does.
  await upload(page, [await square('a.png', 96, 64, 0, 0), await square('b.png', 96, 64, 2, 0)]);
  await opened(page, 'a and b, 2 frames, 96 × 64');
  await expect(page.getByRole('button', { name: 'Camera', exact: true })).toBeVisible();

  // The camera replaces a clip once it is on.
  await upload(page, await clipFrames(3));
  await expect(page.locator('#clip-name')).toContainText('3 frames');
  await done(page);
  await page.getByRole('button', { name: 'Camera' }).click();
  await expect(page.locator('#status')).toHaveText(/^Live: /);
  await expect(page.locator('#timeline')).toBeHidden();
  await page.getByRole('button', { name: 'Stop camera' }).click();
});

test('a step can be cancelled; a sample that cannot be read leaves the clip open, one image does not', async ({ page, context }) => {
  await openEmpty(page);
  await openClip(page, 5);
  // In one task, so that no frame can be loaded between the two keys.
  await page.evaluate(() => {
    for (const key of ['.', 'Escape']) document.body.dispatchEvent(new KeyboardEvent('keydown', { key, bubbles: true, cancelable: true }));
  });
  const track = page.getByRole('slider', { name: 'Current frame' });
  await expect(track).toHaveAttribute('aria-valuetext', 'Frame 0 of 0–4, 0.00 s');
  await done(page);
  await expectToStep(page, 1);
  await expect(track).toHaveAttribute('aria-valuetext', 'Frame 1 of 0–4, 0.03 s');
  await page.getByRole('button', { name: 'Step back' }).click();
  await expect(page.locator('#caption')).toHaveText('Frame 0');

  // An unreadable sample leaves the clip open.
  await withSamples(page);
  await context.route('**/samples/parallax/second.png', (route) => route.fulfill({ status: 200, body: 'nothing' }));
  await openSample(page, 'Parallax');
  await expect(page.locator('#notice-code')).toHaveText('unreadable-image');
  await expect(page.locator('#timeline')).toBeVisible();
  await expectToStep(page, 1);

  // One image instead of a clip hides the timeline.
  await upload(page, [await square('alone.png', 96, 64, 0, 0)]);
  await expect(page.locator('#status')).toHaveText('Now add the second frame.');
  await expect(page.locator('#timeline')).toBeHidden();
  await page.keyboard.press('.'); // there is no clip to step through
  await expect(page.locator('#caption')).toHaveText('First frame');

  await test.step('an unreadable frame leaves the timeline where it was', async () => {
    await upload(page, [await square('f0.png', 96, 64, 0, 0), await square('f1.png', 96, 64, 2, 0), { ...BROKEN, name: 'f2.png' }]);
    await expect(page.locator('#clip-name')).toHaveText('f0 to f2, 3 frames, 96 × 64');
    await done(page);
    await page.keyboard.press('.');
    await expect(page.getByRole('alert')).toContainText('“f2.png” is not an image');
    await expect(page.getByRole('slider', { name: 'Current frame' })).toHaveAttribute('aria-valuenow', '0');
    await expect(page.locator('#caption')).toHaveText('Frame 0');
  });
});

test('frames that are chosen before the page is ready are opened, not the sample', async ({ page, context }) => {
  let release = (): void => undefined;
  const waiting = new Promise<void>((resolve) => (release = resolve));
  await context.route('**/assets/index-*.js', async (route) => {
    await waiting;
    await route.continue();
  });
  await page.goto('./', { waitUntil: 'commit' });
  await upload(page, await clipFrames(4));
  release();
  await expect(page.locator('#clip-name')).toHaveText('f00 to f03, 4 frames, 100 × 70');
  await done(page);
  await expect(page.locator('#samples [aria-current=true]')).toHaveCount(0);
});

test('what is opened last wins: steps and what was chosen before it do not give it up', async ({ page, context }) => {
  await openEmpty(page);
  const release = await held(page, 'slow.png');
  await page.reload();
  await upload(page, await clipFrames(4));
  await expect(page.locator('#clip-name')).toContainText('4 frames');
  await done(page);

  await test.step('files about which the page was still in doubt', async () => {
    let go = (): void => undefined;
    const waiting = new Promise<void>((resolve) => (go = resolve));
    await context.route('**/assets/importing-*.js', async (route) => {
      await waiting;
      await route.continue();
    });
    const asked = page.waitForRequest('**/assets/importing-*.js');
    await upload(page, [await square('early-a.png', 96, 64, 0, 0), await square('early-b.png', 96, 64, 2, 0)]);
    await asked;
    await upload(page, [await video(page, 6, 'webm', 'vp8')]);
    await expect(page.locator('#clip-name')).toContainText('clip.webm, 6 frames');
    await done(page);
    const came = page.waitForResponse('**/assets/importing-*.js');
    go();
    await came;
    await expectToStep(page, 1);
    await expect(page.locator('#clip-name')).toContainText('clip.webm, 6 frames');
  });

  await test.step('a step through the clip, and one that leads nowhere', async () => {
    await upload(page, [await square('fast.png', 96, 64, 0, 0), await square('slow.png', 96, 64, 2, 0)]);
    await expect(page.locator('#status')).toHaveText('Opening…');
    await page.keyboard.press('.');
    await expect(page.locator('#track')).toHaveAttribute('aria-valuenow', '2');
    await page.getByRole('slider', { name: 'Current frame' }).press('Home');
    await expect(page.locator('#track')).toHaveAttribute('aria-valuenow', '0');
    await page.keyboard.press(',');
    await expect(page.locator('#status')).toHaveText('Opening…');
    await release();
    await opened(page, 'fast and slow, 2 frames, 96 × 64');
  });
});
