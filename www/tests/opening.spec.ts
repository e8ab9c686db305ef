//! What is open stays until its replacement is ready, and a failure to open something changes nothing.

import { type Page } from '@playwright/test';

import { type Upload, clipDone, clipFrames, done, expect, held, holdSamples, openClip, openEmpty, opened, openSample, said, square, test, upload, withSamples } from './support.js';

const BROKEN: Upload = { name: 'broken.png', mimeType: 'image/png', buffer: Buffer.from('no image at all') };

/** The clip can still be stepped through. */
async function expectToStep(page: Page, to: number): Promise<void> {
  await page.getByRole('button', { name: 'Step forward' }).click();
  await expectAt(page, to);
}

/** This frame is on screen, and the timeline is there. */
async function expectAt(page: Page, index: number): Promise<void> {
  await expect(page.locator('#caption')).toHaveText(`Frame ${index}`);
  await expect(page.getByRole('slider', { name: 'Current frame' })).toHaveAttribute('aria-valuenow', String(index));
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

test('a broken file does not switch the camera off, a readable clip does, and the camera replaces it once it is on', async ({ page, context }) => {
  await context.grantPermissions(['camera']);
  await openEmpty(page);
  await page.getByRole('button', { name: 'Camera' }).click();
  await expect(page.locator('#status')).toHaveText(/^Live: /);
  await upload(page, [BROKEN]);
  await expect(page.getByRole('alert')).toContainText('“broken.png” is not an image');
  await expect(page.locator('#status')).toHaveText(/^Live: /);
  await expect(page.getByRole('button', { name: 'Stop camera' })).toBeVisible();
  await upload(page, await clipFrames(2, 96, 64));
  await opened(page, 'f00 and f01, 2 frames, 96 × 64');
  await expect(page.getByRole('button', { name: 'Camera', exact: true })).toBeVisible();
  await expectAt(page, 0);

  await page.getByRole('button', { name: 'Camera' }).click();
  await expect(page.locator('#status')).toHaveText(/^Live: /);
  await expect(page.locator('#timeline')).toBeHidden();
  await page.getByRole('button', { name: 'Stop camera' }).click();
});

test('a step can be cancelled; a sample or a frame that cannot be read leaves the clip open, one image does not', async ({ page, context }) => {
  await openClip(page, await clipFrames(4, 96, 64));
  // In one task, so that no frame can be loaded between the two keys.
  await page.evaluate(() => {
    for (const key of ['.', 'Escape']) document.body.dispatchEvent(new KeyboardEvent('keydown', { key, bubbles: true, cancelable: true }));
  });
  await expectAt(page, 0);
  await expectToStep(page, 1);

  await context.route('**/samples/parallax/second.png', (route) => route.fulfill({ status: 200, body: 'nothing' }));
  await openSample(page, 'Parallax');
  await expect(page.locator('#notice-code')).toHaveText('unreadable-image');
  await expectToStep(page, 2);

  await upload(page, [await square('alone.png', 80, 60, 0, 0)]);
  await expect(page.locator('#status')).toHaveText('Now add the second frame.');
  await expect(page.locator('#timeline')).toBeHidden();
  await page.keyboard.press('.'); // there is no clip to step through
  await expect(page.locator('#caption')).toHaveText('First frame');
  await expect(page.locator('#frame')).toHaveAttribute('width', '80');

  await upload(page, [...(await clipFrames(2, 96, 64)), { ...BROKEN, name: 'f02.png' }]);
  await opened(page, 'f00 to f02, 3 frames, 96 × 64');
  await page.getByRole('button', { name: 'Step forward' }).click();
  await expect(page.getByRole('alert')).toContainText('“f02.png” is not an image');
  await expectAt(page, 0);
});

test('frames that are chosen before the page is ready are opened, not the sample', async ({ page, context }) => {
  let release = (): void => undefined;
  const waiting = new Promise<void>((resolve) => (release = resolve));
  await context.route('**/assets/index-*.js', async (route) => {
    await waiting;
    await route.continue();
  });
  await page.goto('./#segment=asked', { waitUntil: 'commit' });
  await upload(page, await clipFrames(3, 96, 64));
  release();
  await opened(page, 'f00 to f02, 3 frames, 96 × 64');
  await expect(page.locator('#samples [aria-current=true]')).toHaveCount(0);
});

test('what is opened last wins: steps and what was chosen before it do not give it up; it can be cancelled', async ({ page, context }) => {
  const release = await held(page, 'slow.png');
  await openClip(page, await clipFrames(3, 96, 64));

  await test.step('files about which the page was still in doubt', async () => {
    let go = (): void => undefined;
    const waiting = new Promise<void>((resolve) => (go = resolve));
    await context.route('**/assets/importing-*.js', async (route) => {
      await waiting;
      await route.continue();
    });
    const asked = page.waitForRequest('**/assets/importing-*.js');
    await upload(page, [await square('early-a.png', 80, 60, 0, 0), await square('early-b.png', 80, 60, 2, 0)]);
    await asked;
    // Files of this name are no masks.
    await upload(page, (await clipFrames(3, 96, 64)).map((frame, k) => ({ ...frame, name: `late${k}.webp` })));
    await opened(page, 'late0 to late2');
    const came = page.waitForResponse('**/assets/importing-*.js');
    go();
    await came;
    await expectToStep(page, 1);
    await expect(page.locator('#clip-name')).toContainText('late0 to late2');
  });

  const files = [await square('fast.png', 80, 60, 0, 0), await square('slow.png', 80, 60, 2, 0)];
  await test.step('a press on Cancel', async () => {
    await upload(page, files);
    await expect(page.locator('#status')).toHaveText('Opening…');
    await expect(page.getByRole('progressbar', { name: 'Progress of opening' })).toBeVisible();
    await page.locator('#cancel').click();
    await expect(page.locator('#status')).toHaveText('This frame has no masks yet.');
    await expect(page.locator('#cancel')).toBeHidden();
    await expectToStep(page, 2);
  });

  await test.step('a step through the clip, and one that leads nowhere', async () => {
    await upload(page, files);
    await expect(page.locator('#status')).toHaveText('Opening…');
    await page.keyboard.press(',');
    await expect(page.locator('#caption')).toHaveText('Frame 1');
    await page.getByRole('slider', { name: 'Current frame' }).press('Home');
    await expect(page.locator('#caption')).toHaveText('Frame 0');
    await page.keyboard.press(',');
    await expect(page.locator('#status')).toHaveText('Opening…');
    await release();
    await opened(page, 'fast and slow, 2 frames, 80 × 60');
  });
});
