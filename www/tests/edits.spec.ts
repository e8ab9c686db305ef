//! Edits survive slow results, stepping through a clip and other settings, and leaving the page with unsaved ones asks first.

import { readFile } from 'node:fs/promises';

import type { Dialog, Page } from '@playwright/test';

import { PALETTE } from '../src/drawing/palette.js';
import { type Place, type Upload, PAIR, chooseMotions, differences, done, drag, drawAtOnce, enter, expect, labelsOfDavis, labelsOnCanvas, motionsChosen, openAdvanced, openClip, openEmpty, openExport, openSample, shown, square, test, undoAll, upload, withoutStorage } from './support.js';

/** Selects the brush, and a mask by its position in the list. */
async function brush(page: Page, row: number): Promise<void> {
  await page.locator('#tools [value=brush]').check();
  await expect(page.locator('#strokes .brush')).toBeAttached(); // it is loaded when it is first chosen
  const chosen = page.locator('#motions > li').nth(row);
  await chosen.locator('.motion-words').click();
  await expect(chosen).toHaveClass(/selected/);
}

const strokes = (page: Page) => page.locator('#strokes g path');

/** The numbers of the masks along a line of the picture. */
function along(labels: Uint8Array, width: number, height: number, from: Place, to: Place): Set<number> {
  const at = (k: number, axis: 0 | 1): number => from[axis] + ((to[axis] - from[axis]) * k) / 20;
  return new Set(Array.from({ length: 21 }, (_, k) => labels[Math.floor(at(k, 1) * height) * width + Math.floor(at(k, 0) * width)]!));
}

function mostCommon(values: readonly number[]): number {
  const counts = new Map<number, number>();
  for (const value of values) counts.set(value, (counts.get(value) ?? 0) + 1);
  return [...counts].reduce((most, one) => (one[1] > most[1] ? one : most))[0];
}

/** Frames of a square that moves right and down. */
function frames(count: number, width = 160, height = 96): Promise<Upload[]> {
  return Promise.all(Array.from({ length: count }, (_, k) => square(`f${k}.png`, width, height, 3 * k, k)));
}

/** Steps both frames of a clip and waits for the masks of the new pair. */
async function step(page: Page, by: 1 | -1, second: string): Promise<void> {
  await page.getByRole('button', { name: by > 0 ? 'Step both forward' : 'Step both back' }).click();
  await shown(page, 'second', second);
}

/** Opens a pair of them. */
async function openPair(page: Page): Promise<void> {
  await openEmpty(page);
  await upload(page, await frames(2));
  await shown(page, 'second', 'f1.png');
}

/** Whether the page asks before it is left. */
async function warns(page: Page): Promise<boolean> {
  const asked = new Promise<Dialog | null>((resolve) => {
    const answer = (event: Dialog | Page): void => {
      page.off('dialog', answer).off('load', answer);
      resolve(event === page ? null : (event as Dialog));
    };
    page.on('dialog', answer).on('load', answer);
  });
  // A navigation by Playwright would wait for a new page that never comes.
  await page.evaluate(() => setTimeout(() => location.reload()));
  const dialog = await asked;
  if (dialog === null) return false;
  expect(dialog.type()).toBe('beforeunload');
  await dialog.dismiss();
  return true;
}

test('strokes that are still being applied are undone, cancelled, exported and segmented with', async ({ page }) => {
  await openPair(page);

  await test.step('strokes drawn, undone or cancelled while they are being applied are kept, undone or kept', async () => {
    const found = await labelsOnCanvas(page);
    await brush(page, 1);
    const rows = [0.15, 0.2, 0.25, 0.3].map((y): [Place, Place] => [[0.7, y], [0.8, y]]);
    await drawAtOnce(page, rows);
    await expect(strokes(page)).toHaveCount(4); // at once
    await done(page);
    for (const [from, to] of rows) expect([...along(await labelsOnCanvas(page), 160, 96, from, to)]).toEqual([1]);

    for (let k = 3; k >= 0; k--) {
      await page.locator('#undo').click();
      await expect(strokes(page)).toHaveCount(k);
    }
    await done(page);
    await expect(page.locator('#undo')).toBeDisabled();
    expect(differences(await labelsOnCanvas(page), found)).toBe(0);

    // Undone while it is being applied, a stroke stays undone.
    await drawAtOnce(page, [[[0.7, 0.2], [0.8, 0.2]]], { last: '#undo' });
    await done(page);
    await expect(page.locator('#status')).toHaveText('Undone.');
    // Its result would come before that of the next.
    await drag(page, [0.7, 0.3], [0.8, 0.3]);
    await done(page);
    await expect(strokes(page)).toHaveCount(1);
    await page.keyboard.press('Control+z');
    await expect(page.locator('#status')).toHaveText('Undone.');
    expect(differences(await labelsOnCanvas(page), found)).toBe(0);
    await expect(page.locator('#undo')).toBeDisabled();

    // Cancelling keeps them.
    await drawAtOnce(page, [[[0.7, 0.2], [0.8, 0.2]]], { last: '#cancel' });
    await expect(page.locator('#status')).toHaveText('Cancelled. Your strokes are kept, but not all are applied yet.');
    await expect(strokes(page)).toHaveCount(1);
    await page.locator('#again').click();
    await done(page);
    expect([...along(await labelsOnCanvas(page), 160, 96, [0.7, 0.2], [0.8, 0.2])]).toEqual([1]);
    await undoAll(page);
  });

  await test.step('a stroke drawn during segmentation is applied afterwards', async () => {
    const found = await labelsOnCanvas(page);
    await brush(page, 1);
    await drawAtOnce(page, [[[0.7, 0.2], [0.8, 0.2]]], { first: '#settings [value=best]' });
    await expect(page.locator('#run')).toHaveAttribute('data-phase', 'working');
    await expect(strokes(page)).toHaveCount(1);
    await done(page);
    await expect(page.getByLabel('Best')).toBeChecked();
    await expect(page.locator('#status')).toHaveText(/motions found in .* Your stroke is applied\.$/);
    // The better result numbers its motions differently, and may split the mask in two. The stroke applies to one of its parts, which is
    // still selected.
    const now = await labelsOnCanvas(page);
    const goesOn = (label: number): boolean => mostCommon([...found].filter((_, p) => now[p] === label)) === 1;
    const drawn = [...along(now, 160, 96, [0.7, 0.2], [0.8, 0.2])];
    expect(drawn).toHaveLength(1);
    expect(drawn.filter(goesOn)).toEqual(drawn);
    const same = mostCommon([...now].filter((_, p) => found[p] === 1));
    await expect(page.locator('#motions > li.selected')).toHaveAttribute('data-mask', String(same));
    await undoAll(page);
    await page.getByLabel('Fast').check();
    await done(page);
  });

  await test.step('an exported file includes them, and a name that is being typed survives', async () => {
    await openExport(page);
    await expect(page.locator('.export-buttons button').first()).toBeEnabled();
    await page.keyboard.press('Escape');
    await brush(page, 1);
    const [download] = await Promise.all([page.waitForEvent('download'), drawAtOnce(page, [[[0.7, 0.2], [0.8, 0.2]]], { last: '.export-buttons button' })]);
    const labels = await labelsOfDavis(await readFile(await download.path()));
    expect(labels[Math.floor(0.2 * 96) * 160 + Math.floor(0.75 * 160)]).toBe(1);

    // A name that is being typed survives a new result.
    await drag(page, [0.7, 0.3], [0.8, 0.3]);
    const name = page.locator('#motions > li').nth(1).locator('.motion-name');
    await name.dblclick({ position: { x: 12, y: 10 } });
    await page.keyboard.type('Van', { delay: 5 });
    await done(page);
    await page.keyboard.type(' 2');
    await page.keyboard.press('Enter');
    await expect(name).toHaveValue('Van 2');
    await expect(page.locator('#motions > li').nth(1).getByRole('checkbox')).toHaveAccessibleName('Show Van 2');
    await page.locator('#undo').click();
    await page.locator('#undo').click();

    // A stroke without effect is rejected with a message.
    await chooseMotions(page, 1);
    await done(page);
    await page.locator('#tools [value=eraser]').check();
    await page.locator('#motions > li').first().locator('.motion-words').click();
    await drag(page, [0.7, 0.2], [0.8, 0.2]);
    await expect(page.locator('#notice')).toContainText('There is no other mask that these pixels could belong to.');
    await expect(strokes(page)).toHaveCount(0);
  });
});

test('corrections of a pair are there when its frames are shown again', async ({ page }) => {
  await openClip(page, await frames(4), { kind: 'motions' });

  await test.step('strokes, names, colours and undo', async () => {
    const rows = page.locator('#motions > li');
    await enter(rows.nth(1).locator('.motion-name'), 'Square');
    await rows.nth(1).locator('.swatch').fill('#112233');
    await brush(page, 1);
    await drag(page, [0.8, 0.2], [0.9, 0.2]);
    await done(page);
    await drag(page, [0.8, 0.8], [0.9, 0.8]);
    await done(page);
    await page.locator('#undo').click();

    await step(page, 1, 'f2.png');
    await expect(page.locator('#undo')).toBeDisabled();
    await expect(rows.nth(1).locator('.motion-name')).toHaveValue('Motion 1');
    await step(page, -1, 'f1.png');
    await expect(page.locator('#status')).toHaveText('Restored your corrections of these frames.');
    await expect(rows.nth(1).locator('.motion-name')).toHaveValue('Square');
    await expect(rows.nth(1).locator('.swatch')).toHaveValue('#112233');
    await rows.nth(1).locator('.swatch').fill(`#${PALETTE[1]!.map((c) => c.toString(16).padStart(2, '0')).join('')}`);
    await expect(strokes(page)).toHaveCount(1);
    await page.locator('#redo').click();
    await done(page);
    await expect(strokes(page)).toHaveCount(2);
    await page.locator('#undo').click();
    await page.locator('#undo').click();
    await expect(page.locator('#undo')).toBeDisabled();
  });

  await test.step('a stroke drawn just before a step, or in progress then', async () => {
    await brush(page, 1);
    await drag(page, [0.8, 0.2], [0.9, 0.2]);
    await page.keyboard.press('.'); // while it is being applied
    await shown(page, 'second', 'f2.png');
    await expect(strokes(page)).toHaveCount(0);
    await step(page, -1, 'f1.png');
    await expect(strokes(page)).toHaveCount(1);
    expect([...along(await labelsOnCanvas(page), 160, 96, [0.8, 0.2], [0.9, 0.2])]).toEqual([1]);
    await page.locator('#undo').click();
    await expect(strokes(page)).toHaveCount(0);

    // In progress when the frames change, it belongs to the old ones.
    await brush(page, 1);
    const box = (await page.locator('.layers').boundingBox())!;
    await page.mouse.move(box.x + 0.8 * box.width, box.y + 0.2 * box.height);
    await page.mouse.down();
    await page.mouse.move(box.x + 0.9 * box.width, box.y + 0.2 * box.height, { steps: 4 });
    await page.keyboard.press('.');
    await expect(page.locator('[data-slot=second] .slot-name')).toContainText('f2.png');
    await page.mouse.up();
    await done(page);
    await expect(strokes(page)).toHaveCount(0);
    await step(page, -1, 'f1.png');
    await expect(strokes(page)).toHaveCount(1);
    await undoAll(page);
  });

  await test.step('frames that are opened again in any way', async () => {
    const files = await frames(4);
    const pair = async (): Promise<void> => {
      await upload(page, files.slice(0, 2));
      await expect(page.locator('#timeline')).toBeHidden();
      await shown(page, 'second', 'f1.png');
    };
    await pair();
    await brush(page, 1);
    await drag(page, [0.8, 0.2], [0.9, 0.2]);
    await done(page);

    const replaceBy = (k: number) => () => page.getByLabel('Replace the second frame').setInputFiles([files[k]!]);
    const swap = (): Promise<void> => page.locator('#swap').click();
    // Replaced and put back, swapped and swapped back.
    for (const [change, second, count] of [[replaceBy(3), 'f3.png', 0], [replaceBy(1), 'f1.png', 1], [swap, 'f0.png', 0], [swap, 'f1.png', 1]] as const) {
      await change();
      await shown(page, 'second', second);
      await expect(strokes(page)).toHaveCount(count);
    }

    // Replaced by a sample and opened again.
    await openSample(page, 'Parallax');
    await shown(page, 'first', '400 × 300');
    await pair();
    await expect(strokes(page)).toHaveCount(1);

    // Opened as frames of a clip.
    await upload(page, files);
    await expect(page.locator('#clip-name')).toContainText('4 frames');
    await done(page);
    await expect(strokes(page)).toHaveCount(1);
    expect([...along(await labelsOnCanvas(page), 160, 96, [0.8, 0.2], [0.9, 0.2])]).toEqual([1]);
    await undoAll(page);
  });

  await test.step('a number of motions that is chosen', async () => {
    await chooseMotions(page, 1);
    await done(page);
    await motionsChosen(page, 1);
    await expect(page.locator('#motions > li')).toHaveCount(1);
    await step(page, 1, 'f2.png');
    await motionsChosen(page, 'Automatic');
    expect(await page.locator('#motions > li').count()).toBeGreaterThan(1);
    await step(page, -1, 'f1.png');
    await motionsChosen(page, 1);
    await expect(page.locator('#motions > li')).toHaveCount(1);
  });
});

test('fewer motions than requested are mentioned', async ({ page }) => {
  await openEmpty(page);
  await upload(page, await frames(2));
  await shown(page, 'second', 'f1.png');
  await page.evaluate(() => (location.hash = '#quality=fast&masks=motions&motions=10'));
  await done(page);
  const count = await page.locator('#motions > li').count();
  expect(count).toBeLessThan(10);
  await expect(page.locator('#status')).toHaveText(/\. Of the 10 motions requested, only (one|\d) could be told apart\.$/);
  await chooseMotions(page, 2);
  await done(page);
  await expect(page.locator('#status')).toHaveText(/^2 motions found in [\d.]+\sm?s, as requested\.$/);
});

test('corrections are scaled to another working size', async ({ page }) => {
  await openClip(page, await frames(3, 660, 396), { kind: 'motions' });
  await brush(page, 1);
  await drag(page, [0.8, 0.2], [0.9, 0.2]);
  await done(page);
  await openAdvanced(page);
  await page.getByLabel('Working size').selectOption('640');
  await done(page);
  await step(page, 1, 'f2.png');
  await step(page, -1, 'f1.png');
  await expect(strokes(page)).toHaveCount(1);
  expect([...along(await labelsOnCanvas(page), 640, 384, [0.8, 0.2], [0.9, 0.2])]).toEqual([1]);
});

test('where nothing is kept, leaving the page asks first only with unsaved corrections, which survive the camera', async ({ page, context }) => {
  await context.grantPermissions(['camera']);
  await withoutStorage(page);
  await openClip(page, await frames(3), { kind: 'motions' });
  await page.locator('#look [name=outlines]').uncheck();
  await page.locator('#zoom-in').click();
  await page.keyboard.press('0');
  await brush(page, 1);
  expect(await warns(page)).toBe(false);
  await expect(page.locator('#timeline')).toBeHidden();

  await openClip(page, await frames(3), { kind: 'motions' });
  await brush(page, 1);
  await drag(page, [0.8, 0.2], [0.9, 0.2]);
  await done(page);
  expect(await warns(page)).toBe(true);
  await step(page, 1, 'f2.png');
  expect(await warns(page)).toBe(true); // edits of the pair before
  await step(page, -1, 'f1.png');

  await openExport(page);
  await Promise.all([page.waitForEvent('download'), page.getByRole('button', { name: 'Result JSON' }).click()]);
  expect(await warns(page)).toBe(true); // the report has no masks
  await openExport(page);
  await Promise.all([page.waitForEvent('download'), page.getByRole('button', { name: 'Labels PNG' }).click()]);
  expect(await warns(page)).toBe(false);

  await done(page); // the pair that its address names
  await brush(page, 1);
  await drag(page, [0.7, 0.2], [0.8, 0.2]);
  await page.getByRole('button', { name: 'Camera' }).click();
  await expect(page.locator('#status')).toHaveText(/^Live/);
  await expect(strokes(page)).toHaveCount(0);
  expect(await warns(page)).toBe(true);
  await page.getByRole('button', { name: 'Stop camera' }).click();
  await done(page);
  await openSample(page, 'Two cars');
  await shown(page, 'first', 'first.png');
  await expect(strokes(page)).toHaveCount(1);
  expect([...along(await labelsOnCanvas(page), 768, 432, [0.7, 0.2], [0.8, 0.2])]).toEqual([1]);
});

test('masks of two cars, corrected', async ({ page }) => {
  await page.goto(PAIR); // as well as it can: with quality fast each group is one motion
  await done(page);

  await test.step('the status says how many motions or objects are found', async () => {
    const status = page.locator('#status');
    const rows = page.locator('#motions > li');
    const groups = await rows.count();
    await page.locator('#look [name=colouring][value=motions]').check();
    const motions = await rows.count();
    expect(motions).toBeGreaterThan(groups);
    await expect(status).toHaveText(new RegExp(`^${motions} motions found in [\\d.]+\\sm?s\\.$`));
    await page.locator('#look [name=colouring][value=groups]').check();
    await expect(status).toHaveText(new RegExp(`^${groups - 1 === 1 ? 'One object' : `${groups - 1} objects`} found in [\\d.]+\\sm?s\\.$`));

    await page.getByLabel('Fast').check();
    await done(page);
  });

  await test.step('strokes and names follow their masks to a result with other settings', async () => {
    await page.locator('#look [name=colouring][value=motions]').check();
    const rows = page.locator('#motions > li');
    const count = await rows.count();
    await enter(rows.nth(2).locator('.motion-name'), 'Car');
    await brush(page, 1);
    await drag(page, [0.7, 0.2], [0.8, 0.2]);
    await done(page);
    const painted = await labelsOnCanvas(page);

    await openAdvanced(page);
    await page.getByLabel('Leave unexplained pixels unlabelled').check();
    await done(page);
    await expect(strokes(page)).toHaveCount(1);
    await expect(page.locator('#status')).toHaveText(/Your stroke is applied\.$/);
    expect([...along(await labelsOnCanvas(page), 768, 432, [0.7, 0.2], [0.8, 0.2])]).toEqual([1]);
    expect(await page.locator('.motion-name').evaluateAll((inputs) => inputs.filter((input) => (input as HTMLInputElement).value === 'Car').length)).toBe(1);

    // With one motion the stroke has no effect. With the first settings everything is as before.
    await chooseMotions(page, 1);
    await done(page);
    await expect(rows).toHaveCount(1 + (await page.locator('#motions > [data-mask="255"]').count()));
    await expect(page.locator('#status')).toHaveText(/Your stroke has no effect: its mask is not in this result\.$/);
    await chooseMotions(page, 'Automatic');
    await page.getByLabel('Leave unexplained pixels unlabelled').uncheck();
    await done(page);
    await expect(rows).toHaveCount(count);
    expect(differences(await labelsOnCanvas(page), painted)).toBe(0);
    await expect(rows.nth(2).locator('.motion-name')).toHaveValue('Car');
    await page.locator('#undo').click();
    await expect(page.locator('#undo')).toBeDisabled();
  });
});
