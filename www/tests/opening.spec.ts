//! What is open stays open until what replaces it is there; and what failed leaves no trace but a sentence.

import { type Page } from '@playwright/test';

import { film } from './film.js';
import { type Upload, done, expect, open, square, test, upload } from './support.js';

const BROKEN: Upload = { name: 'broken.png', mimeType: 'image/png', buffer: Buffer.from('no image at all') };

async function openFilm(page: Page, count: number): Promise<void> {
  await upload(page, [await film(page, count, 'webm', 'vp8')]);
  await expect(page.locator('#film-name')).toHaveText(`film.webm, ${count} frames, 192 × 128`);
  await done(page);
}

/** The film still gives frames. */
async function expectToStep(page: Page, first: number): Promise<void> {
  await page.getByRole('button', { name: 'Step both forward' }).click();
  await expect(page.locator('[data-slot=first] .slot-name')).toContainText(`#${first},`);
  await done(page);
}

test('one image in place of a film puts the timeline away', async ({ page }) => {
  await open(page);
  await openFilm(page, 4);
  await upload(page, [await square('alone.png', 96, 64, 0, 0)]);
  await expect(page.locator('#status')).toHaveText('Now add the second frame.');
  await expect(page.locator('#timeline')).toBeHidden();
  await page.keyboard.press('.'); // nothing is left to step through
  await expect(page.locator('[data-slot=first] .slot-name')).toHaveText('alone.png, 96 × 64');
});

test('a replaced frame is not called a frame of the film', async ({ page }) => {
  await open(page);
  await openFilm(page, 8);
  await page.getByLabel('Replace the second frame').setInputFiles(await square('other.png', 192, 128, 0, 0));
  await expect(page.locator('[data-slot=second] .slot-name')).toHaveText('other.png, 192 × 128');
  await done(page);
  await expect(page.locator('#film-first-at')).toHaveText('#0, 0.000 s');
  await expect(page.locator('#film-second-at')).toHaveText('another file');
  // The frame that is left moves on, the other stays.
  await page.getByRole('button', { name: 'Step both forward' }).click();
  await expect(page.locator('#film-first-at')).toHaveText('#1, 0.033 s');
  await done(page);
  await expect(page.locator('[data-slot=second] .slot-name')).toHaveText('other.png, 192 × 128');
  // Swapped, the film is in the other row.
  await page.getByRole('button', { name: 'Swap the two frames' }).click();
  await expect(page.locator('#film-first-at')).toHaveText('another file');
  await expect(page.locator('#film-second-at')).toHaveText('#1, 0.033 s');
  await done(page);
  // A row that is used is of the film again.
  await page.getByRole('button', { name: 'First frame: step forward' }).click();
  await expect(page.locator('#film-first-at')).toHaveText('#2, 0.067 s');
  await done(page);
  // Once neither frame is of the film, it is put away.
  for (const slot of ['first', 'second']) {
    await page.getByLabel(`Replace the ${slot} frame`).setInputFiles(await square(`${slot}.png`, 192, 128, 2, 0));
    await expect(page.locator(`[data-slot=${slot}] .slot-name`)).toHaveText(`${slot}.png, 192 × 128`);
  }
  await expect(page.locator('#timeline')).toBeHidden();
});

test('a frame that cannot be read leaves the film where it was', async ({ page }) => {
  await open(page);
  await upload(page, [await square('f0.png', 96, 64, 0, 0), await square('f1.png', 96, 64, 2, 0), { ...BROKEN, name: 'f2.png' }]);
  await expect(page.locator('#film-name')).toHaveText('f0.png, 3 frames, 96 × 64');
  await done(page);
  await page.getByRole('button', { name: 'Second frame: step forward' }).click();
  await expect(page.getByRole('alert')).toContainText('“f2.png” is not an image');
  await expect(page.locator('#film-second-at')).toHaveText('#1');
  await expect(page.locator('[name=film-second]')).toHaveValue('1');
  await expect(page.locator('#run')).toHaveAttribute('data-phase', 'done');
});

test('a sample that cannot be had leaves the film open', async ({ page, context }) => {
  await open(page);
  await openFilm(page, 4);
  await context.route('**/samples/parallax/second.png', (route) => route.fulfill({ status: 200, body: 'nothing' }));
  await page.getByRole('button', { name: 'Parallax' }).click();
  await expect(page.locator('#notice-code')).toHaveText('unreadable-image');
  await expect(page.locator('#timeline')).toBeVisible();
  await expectToStep(page, 1);
});

test('a broken file does not switch the camera off', async ({ page, context }) => {
  await context.grantPermissions(['camera']);
  await open(page);
  await page.getByRole('button', { name: 'Camera' }).click();
  await expect(page.locator('#status')).toHaveText(/^Live: /, { timeout: 20_000 });
  await upload(page, [BROKEN]);
  await expect(page.getByRole('alert')).toContainText('“broken.png” is not an image');
  await expect(page.locator('#status')).toHaveText(/^Live: /);
  await expect(page.getByRole('button', { name: 'Stop camera' })).toBeVisible();
  // One that can be read does.
  await upload(page, [await square('a.png', 96, 64, 0, 0), await square('b.png', 96, 64, 2, 0)]);
  await expect(page.locator('[data-slot=first] .slot-name')).toHaveText('a.png, 96 × 64');
  await done(page);
  await expect(page.getByRole('button', { name: 'Camera', exact: true })).toBeVisible();
});

test('a film gives way to the camera once that is on', async ({ page, context }) => {
  await context.grantPermissions(['camera']);
  await open(page);
  await openFilm(page, 4);
  await page.getByRole('button', { name: 'Camera' }).click();
  await expect(page.locator('#status')).toHaveText(/^Live: /, { timeout: 20_000 });
  await expect(page.locator('#timeline')).toBeHidden();
  await page.getByRole('button', { name: 'Stop camera' }).click();
});

test('a broken file does not undo the strokes that are being solved', async ({ page }) => {
  await open(page);
  await page.locator('#tools [value=brush]').check();
  const box = (await page.locator('.layers').boundingBox())!;
  await page.mouse.move(box.x + 0.2 * box.width, box.y + 0.3 * box.height);
  await page.mouse.down();
  await page.mouse.move(box.x + 0.26 * box.width, box.y + 0.7 * box.height, { steps: 8 });
  // The stroke ends and the file comes in one task: nothing is solved by then.
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
  await done(page);
  await expect(page.locator('#undo')).toBeEnabled();
  await expect(page.locator('#strokes .stroke:not(.now)')).toHaveCount(1);
});

test('a step that is cancelled while its frame is read leaves numbers and picture together', async ({ page }) => {
  await open(page);
  await openFilm(page, 8);
  // In one task: no frame can be there between the two keys.
  await page.evaluate(() => {
    for (const key of ['.', 'Escape']) document.body.dispatchEvent(new KeyboardEvent('keydown', { key, bubbles: true, cancelable: true }));
  });
  await expect(page.locator('#film-first-at')).toHaveText('#0, 0.000 s');
  await expect(page.locator('[name=film-second]')).toHaveValue('1');
  await expect(page.locator('#run')).toHaveAttribute('data-phase', 'done');
  await expectToStep(page, 1);
  await expect(page.locator('#film-first-at')).toHaveText('#1, 0.033 s');
});

test('what is drawn while a film is stepped on belongs to the frames that are shown', async ({ page }) => {
  await open(page);
  await openFilm(page, 8);
  await page.locator('#tools [value=brush]').check();
  // The stroke begins before the step and ends before the frames are there.
  await page.locator('.layers').evaluate((layers) => {
    layers.setPointerCapture = () => undefined; // this pointer is not real
    const { x, y, width, height } = layers.getBoundingClientRect();
    const point = (type: string, u: number): void => {
      const at = { clientX: x + u * width, clientY: y + 0.2 * height };
      layers.dispatchEvent(new PointerEvent(type, { pointerId: 1, isPrimary: true, button: type === 'pointermove' ? -1 : 0, bubbles: true, ...at }));
    };
    point('pointerdown', 0.8);
    document.body.dispatchEvent(new KeyboardEvent('keydown', { key: '.', bubbles: true, cancelable: true }));
    point('pointermove', 0.9);
    point('pointerup', 0.9);
  });
  // How long it stays in sight depends on how fast the frames are there.
  const strokes = page.locator('#strokes g path');
  await expect(page.locator('[data-slot=first] .slot-name')).toContainText('#1,');
  await done(page);
  await expect(strokes).toHaveCount(0);
  await page.getByRole('button', { name: 'Step both back' }).click();
  await expect(page.locator('[data-slot=first] .slot-name')).toContainText('#0,');
  await done(page);
  await expect(strokes).toHaveCount(1);
});
