//! Drawing by hand: exactly, as polygons, and with the outlines of the frames beside for comparison.

import { type Locator, type Page } from '@playwright/test';
import { unzipSync } from 'fflate';

import { type Place, clipDone, clipFrames, differences, done, drag, expect, goTo, kept, labelsOfDavis, labelsOnCanvas, masksOf, openSegmented, reachPicture, reopen, said, savedClip, test } from './support.js';

const [WIDTH, HEIGHT] = [120, 84];
/** Of the brush, pixels. */
const RADIUS = 5;

const status = (page: Page): Locator => page.locator('#clip-status');
const exact = (page: Page): Locator => page.getByRole('checkbox', { name: 'Exact' });

/** Places of the picture in pixels of the frame: the centre of a pixel has whole numbers. */
const pixel = ([u, v]: Place, width = WIDTH, height = HEIGHT): Place => [u * width - 0.5, v * height - 0.5];

/** How far a pixel is from a line, pixels. */
function distance(p: number, [[x0, y0], [x1, y1]]: readonly [Place, Place], width = WIDTH): number {
  const [x, y] = [p % width, Math.floor(p / width)];
  const along = Math.min(Math.max(((x - x0) * (x1 - x0) + (y - y0) * (y1 - y0)) / Math.hypot(x1 - x0, y1 - y0) ** 2, 0), 1);
  return Math.hypot(x - x0 - along * (x1 - x0), y - y0 - along * (y1 - y0));
}

/** Whether a pixel is inside a polygon: the angles at which its sides are seen make a full turn. */
function isInside(p: number, corners: readonly Place[], width = WIDTH): boolean {
  const angle = ([x, y]: Place): number => Math.atan2(y - Math.floor(p / width), x - (p % width));
  const turns = corners.map((corner, k) => angle(corners[(k + 1) % corners.length]!) - angle(corner)).map((turn) => turn - 2 * Math.PI * Math.round(turn / (2 * Math.PI)));
  return Math.abs(turns.reduce((sum, turn) => sum + turn, 0)) > Math.PI;
}

/** Checks that a stroke between two places made exactly the pixels under the brush what is `drawn`, and nothing else. */
function isDrawn(now: Uint8Array, before: Uint8Array, [from, to]: readonly [Place, Place], radius: number, drawn: (label: number) => number, width = WIDTH, height = HEIGHT): void {
  const line = [pixel(from, width, height), pixel(to, width, height)] as const;
  // Discs along a line leave out slivers at its sides.
  const wrong = [...now].filter((label, p) => {
    const far = distance(p, line, width);
    const [kept, said] = [before[p]!, drawn(before[p]!)];
    return far > radius + 0.1 ? label !== kept : far < 0.9 * radius ? label !== said : label !== kept && label !== said;
  });
  expect(wrong).toEqual([]);
}

/** Presses on places of the picture. Returns where that is in the frame: mice press on whole pixels of the screen. */
async function press(page: Page, ...places: readonly Place[]): Promise<Place[]> {
  const box = (await page.locator('.layers').boundingBox())!;
  const pressed: Place[] = [];
  for (const [u, v] of places) {
    const [x, y] = [Math.round(box.x + u * box.width), Math.round(box.y + v * box.height)];
    await page.mouse.click(x, y);
    pressed.push(pixel([(x - box.x) / box.width, (y - box.y) / box.height]));
  }
  return pressed;
}

/** The labels of a frame in the archive of DAVIS masks that the page saves. */
async function exported(page: Page, name: string): Promise<Uint8Array> {
  const files = unzipSync((await savedClip(page, 'DAVIS')).bytes);
  await page.keyboard.press('Escape');
  return labelsOfDavis(Object.entries(files).find(([path]) => path.endsWith(name))![1]);
}

/** Over the disc of `clipFrames` in frame 4, and over the background beside it. */
const OVER_DISC = [[0.25, 0.4], [0.4, 0.4]] as const;
const BESIDE = [[0.55, 0.15], [0.7, 0.3]] as const;

test('what is drawn exactly is kept, exported and left alone by corrections elsewhere', async ({ page }) => {
  const files = await clipFrames(6, WIDTH, HEIGHT);
  await openSegmented(page, files);
  await page.locator('#tools [name=radius]').fill(String(RADIUS));
  const [fifth, before] = (await masksOf(page, [5, 4])) as [Uint8Array, Uint8Array];
  const disc = before[Math.round(0.4 * HEIGHT) * WIDTH + Math.round(0.33 * WIDTH)]!;
  expect(disc).toBeGreaterThan(0);
  await page.keyboard.press(String(disc));
  await page.keyboard.press('q');
  await expect(exact(page)).toBeChecked();
  await expect(page.getByRole('combobox', { name: 'Frames that follow a correction' })).toBeDisabled();
  await page.keyboard.press('p');
  await expect(page.locator('#tool-help [data-help=brush]')).toContainText('Nothing else changes.');
  await drag(page, ...BESIDE);
  await said(page, /^Corrected: the masks of one frame have changed\.$/);
  const brushed = await labelsOnCanvas(page);
  isDrawn(brushed, before, BESIDE, RADIUS, () => disc);
  await page.keyboard.press('e');
  await drag(page, ...OVER_DISC);
  const erased = await labelsOnCanvas(page);
  isDrawn(erased, brushed, OVER_DISC, RADIUS, (label) => (label === disc ? 0 : label));
  await goTo(page, 5);
  expect(differences(await labelsOnCanvas(page), fifth)).toBe(0);

  // Each is one step.
  await page.keyboard.press('Shift+C');
  await expect(page.locator('#caption')).toHaveText('Frame 4');
  await page.keyboard.press('Control+z');
  await expect(status(page)).toHaveText('Undone in one frame.');
  await expect.poll(async () => differences(await labelsOnCanvas(page), brushed)).toBe(0);
  await page.keyboard.press('Control+z');
  await expect.poll(async () => differences(await labelsOnCanvas(page), before)).toBe(0);
  await page.keyboard.press('Control+y');
  await page.keyboard.press('Control+y');
  await expect.poll(async () => differences(await labelsOnCanvas(page), erased)).toBe(0);

  // So is a mask that is copied to another frame, or made of a box there.
  await page.keyboard.press('Shift+>');
  await expect(page.locator('#caption')).toHaveText('Frame 5');
  await done(page);
  expect(differences((await labelsOnCanvas(page)).map((label) => Number(label === disc)), erased.map((label) => Number(label === disc)))).toBe(0);
  await page.keyboard.press('Control+z');
  expect(differences(await labelsOnCanvas(page), fifth)).toBe(0);
  await page.keyboard.press('x');
  await drag(page, [0.24, 0.24], [0.5, 0.6]);
  await said(page, /^Corrected: the masks of one frame have changed\.$/);
  const boxed = await labelsOnCanvas(page);
  expect(boxed).toContain(3);
  // Nothing around the box is drawn: another box takes of it.
  await drag(page, [0.05, 0.05], [0.15, 0.15]);
  await expect.poll(() => page.locator('#objects > li').count()).toBe(5); // and the background
  await done(page);
  const both = await labelsOnCanvas(page);
  expect(both.every((label, p) => label === boxed[p] || (label === 4 && boxed[p] === 0))).toBe(true);
  for (let k = 0; k < 2; k++) await page.keyboard.press('Control+z');
  await expect.poll(async () => (await labelsOnCanvas(page)).some((label) => label > 2)).toBe(false);
  await goTo(page, 4);
  expect(differences(await labelsOnCanvas(page), erased)).toBe(0);

  // It is there after a reload, and what spreads from another frame goes around it.
  await kept(page);
  await reopen(page, files);
  await said(page, /^Continued/);
  await goTo(page, 4);
  expect(differences(await labelsOnCanvas(page), erased)).toBe(0);
  await goTo(page, 3);
  await page.keyboard.press(String(disc));
  await page.keyboard.press('p');
  await expect(exact(page)).not.toBeChecked();
  await page.locator('#tools [name=radius]').fill(String(RADIUS));
  await drag(page, [0.22, 0.38], [0.36, 0.38]);
  await drag(page, [0.55, 0.13], [0.7, 0.27]);
  await said(page, /^Corrected: the masks of \d+ frames have changed\.$/);
  await clipDone(page);
  const after = (await masksOf(page, [5, 4]))[1]!;
  const drawn = [...after.keys()].filter((p) => brushed[p] !== before[p] || erased[p] !== brushed[p]);
  expect(drawn.length).toBeGreaterThan(300);
  expect(drawn.filter((p) => after[p] !== erased[p])).toEqual([]);
  expect(differences(await exported(page, 'f04.png'), after)).toBe(0);
});

test('the onion skin shows the frames beside; polygons are filled pixel for pixel', async ({ page }) => {
  await openSegmented(page, await clipFrames(6, WIDTH, HEIGHT));

  await test.step('the onion skin shows the objects of the frames beside, but not while the clip plays', async () => {
    const [second, fourth, first] = await masksOf(page, [1, 3, 0]);
    await goTo(page, 2);
    const skin = page.getByRole('checkbox', { name: 'Onion skin' });
    await expect(skin).not.toBeChecked();
    await page.keyboard.press('u');
    await expect(skin).toBeChecked();
    await expect.poll(() => outlined(page, 'before')).toEqual(boxesIn(second!));
    await expect.poll(() => outlined(page, 'after')).toEqual(boxesIn(fourth!));
    await page.getByLabel('Show Object 2').uncheck();
    await expect(page.locator('#onion path')).toHaveCount(2);
    await page.getByLabel('Show Object 2').check();
    await page.keyboard.press('.');
    await page.keyboard.press('.');
    await expect.poll(() => outlined(page, 'before')).toEqual(boxesIn(fourth!));
    await goTo(page, 0);
    await expect.poll(() => outlined(page, 'after')).toEqual(boxesIn(second!));
    expect(await outlined(page, 'before')).toEqual([]);
    expect(differences(await labelsOnCanvas(page), first!)).toBe(0);

    // Lines while it plays would be of frames that have passed.
    await page.evaluate(() => {
      const seen: number[] = [];
      Object.assign(window, { seen });
      const play = document.querySelector('#play')!;
      const look = (): void => {
        const count = document.querySelectorAll('#onion path').length;
        // From when those there were are gone.
        if (play.getAttribute('aria-label') === 'Pause' && (count === 0 || seen.length > 0)) seen.push(count);
        requestAnimationFrame(look);
      };
      look();
    });
    await page.locator('#play').click();
    await expect(page.locator('#caption')).toHaveText('Frame 5');
    await expect.poll(() => outlined(page, 'before')).not.toEqual([]);
    const seen = await page.evaluate(() => (window as unknown as { seen: number[] }).seen);
    expect(seen.length).toBeGreaterThan(0);
    expect(seen.every((count) => count === 0)).toBe(true);
    await skin.uncheck();
    await expect(page.locator('#onion path')).toHaveCount(0);
  });

  await test.step('a polygon is filled pixel for pixel, by pointer and by keyboard, and what is not closed can be taken back', async () => {
    await goTo(page, 2);
    const before = await labelsOnCanvas(page);
    const corners: Place[] = [[0.41, 0.13], [0.62, 0.21], [0.55, 0.43], [0.5, 0.24]];
    let set: Place[] = [];
    const inside = (p: number): boolean => isInside(p, set);
    const filled = (label: number): Uint8Array => before.map((was, p) => (inside(p) ? label : was));
    await page.keyboard.press('1');
    await exact(page).check();
    await page.keyboard.press('w');
    await expect(page.getByRole('radio', { name: 'Polygon' })).toBeChecked();
    set = await press(page, ...corners);
    await expect(page.locator('.corners')).toHaveAttribute('d', /^(M[^M]+){4}$/);
    expect(differences(await labelsOnCanvas(page), before)).toBe(0);
    await press(page, corners[0]!);
    await said(page, /^Corrected: the masks of one frame have changed\.$/);
    await expect(page.locator('.corners')).toHaveAttribute('d', '');
    expect(differences(await labelsOnCanvas(page), filled(1))).toBe(0);

    // With Shift a part of it is removed; a second press at the last corner closes as well.
    const part: Place[] = [[0.45, 0.1], [0.58, 0.12], [0.52, 0.45]];
    const cut = await press(page, ...part);
    await page.keyboard.down('Shift');
    await press(page, part[2]!);
    await page.keyboard.up('Shift');
    expect(differences(await labelsOnCanvas(page), filled(1).map((label, p) => (label === 1 && isInside(p, cut) ? 0 : label)))).toBe(0);
    await page.keyboard.press('Control+z');
    await page.keyboard.press('Control+z');
    await expect.poll(async () => differences(await labelsOnCanvas(page), before)).toBe(0);

    // By keyboard alone: from where the pointer was, in steps of the brush's radius. Backspace is about the corners, not about the selected object.
    await page.mouse.move(0, 0);
    await reachPicture(page);
    const at = (await page.locator('.brush').evaluate((circle) => ['cx', 'cy'].map((name) => Number(circle.getAttribute(name))))) as [number, number];
    const walked: Place[] = [at];
    const step = async (key: string, times: number): Promise<void> => {
      for (let k = 0; k < times; k++) await page.keyboard.press(key);
      const [x, y] = walked.at(-1)!;
      const far = (key === 'ArrowLeft' || key === 'ArrowUp' ? -8 : 8) * times;
      walked.push(key === 'ArrowLeft' || key === 'ArrowRight' ? [x + far, y] : [x, y + far]);
    };
    await page.keyboard.press('Space');
    await step('ArrowRight', 4);
    await page.keyboard.press('Space');
    await page.keyboard.press('Enter'); // two corners are no polygon
    await step('ArrowUp', 1);
    await page.keyboard.press('Space');
    await page.keyboard.press('Backspace');
    await step('ArrowDown', 3);
    await page.keyboard.press('Space');
    await expect(page.locator('.corners')).toHaveAttribute('d', /^(M[^M]+){3}$/);
    await page.keyboard.press('Enter');
    await expect(page.locator('.corners')).toHaveAttribute('d', '');
    const [first, second, , third] = walked as [Place, Place, Place, Place];
    // No centre is on a side: the pointer was between pixels.
    expect(differences(await labelsOnCanvas(page), before.map((was, p) => (isInside(p, [first, second, third]) ? 1 : was)))).toBe(0);
    await expect(page.locator('#objects > li')).toHaveCount(3);

    // Given up, wherever the focus is.
    const now = await labelsOnCanvas(page);
    await press(page, ...corners);
    await page.locator('#tools [name=radius]').focus();
    await page.keyboard.press('Backspace');
    await expect(page.locator('.corners')).toHaveAttribute('d', /^(M[^M]+){3}$/);
    await page.keyboard.press('Escape');
    await expect(page.locator('.corners')).toHaveAttribute('d', '');
    await expect(page.locator('#objects > li')).toHaveCount(3);
    await press(page, ...corners);
    await page.keyboard.press('v');
    await expect(page.locator('.stroke.now')).toHaveAttribute('d', '');
    expect(differences(await labelsOnCanvas(page), now)).toBe(0);

    // Otherwise it is the object in this frame, and other frames follow.
    await exact(page).uncheck();
    await page.keyboard.press('Control+z');
    await page.keyboard.press('w');
    await press(page, ...corners, corners[0]!);
    await said(page, /^Corrected: the masks of \d+ frames have changed\.$/);
    expect((await labelsOnCanvas(page)).every((label, p) => inside(p) === (label === 1))).toBe(true);
  });
});

/** The boxes around the outlines of a neighbouring frame, in pixels of the frame: left, top, right, bottom. */
function outlined(page: Page, side: 'before' | 'after'): Promise<number[][]> {
  return page.locator(`#onion .${side}`).evaluateAll((paths) =>
    paths.map((path) => {
      const { x, y, width, height } = (path as SVGPathElement).getBBox();
      return [x, y, x + width, y + height];
    }),
  );
}

/** The box around each object. */
function boxesIn(labels: Uint8Array): number[][] {
  const boxes = new Map<number, number[]>();
  for (const [p, label] of labels.entries()) {
    if (label === 0) continue;
    const [x, y] = [p % WIDTH, Math.floor(p / WIDTH)];
    const [left, top, right, bottom] = boxes.get(label) ?? [x, y, x + 1, y + 1];
    boxes.set(label, [Math.min(left!, x), Math.min(top!, y), Math.max(right!, x + 1), Math.max(bottom!, y + 1)]);
  }
  return [...boxes.values()];
}

test.describe('on a phone', () => {
  test.use({ viewport: { width: 390, height: 780 }, hasTouch: true, isMobile: true });

  test('fingers draw a polygon exactly; two of them set no corner', async ({ page }) => {
    await openSegmented(page, await clipFrames(6, WIDTH, HEIGHT));
    await goTo(page, 2);
    const before = await labelsOnCanvas(page);
    await page.locator('#objects > li').nth(1).locator('.motion-share').tap();
    await page.locator('#tools [value=polygon]').tap();
    await exact(page).tap();
    await expect(exact(page)).toBeChecked();
    for (const part of await page.locator('.options label.exact, .options select, .steps button').all()) {
      const { width, height } = (await part.boundingBox())!;
      expect(Math.min(width, height)).toBeGreaterThanOrEqual(44);
    }
    await page.locator('.layers').scrollIntoViewIfNeeded();
    const corners: Place[] = [[0.44, 0.12], [0.68, 0.2], [0.55, 0.55]];
    const box = (await page.locator('.layers').boundingBox())!;
    const at = ([u, v]: Place, id = 0): { x: number; y: number; id: number } => ({ x: box.x + u * box.width, y: box.y + v * box.height, id });
    const tap = (place: Place): Promise<void> => page.touchscreen.tap(at(place).x, at(place).y);
    for (const corner of corners) await tap(corner);
    await expect(page.locator('.corners')).toHaveAttribute('d', /^(M[^M]+){3}$/);
    const cdp = await page.context().newCDPSession(page);
    await cdp.send('Input.dispatchTouchEvent', { type: 'touchStart', touchPoints: [at([0.3, 0.5])] });
    await cdp.send('Input.dispatchTouchEvent', { type: 'touchStart', touchPoints: [at([0.3, 0.5]), at([0.6, 0.7], 1)] });
    await cdp.send('Input.dispatchTouchEvent', { type: 'touchEnd', touchPoints: [] });
    await expect(page.locator('.corners')).toHaveAttribute('d', /^(M[^M]+){3}$/);
    await tap(corners[0]!);
    await said(page, /^Corrected: the masks of one frame have changed\.$/);
    const drawn = corners.map((corner) => pixel(corner));
    expect(differences(await labelsOnCanvas(page), before.map((was, p) => (isInside(p, drawn) ? 1 : was)))).toBeLessThanOrEqual(3);
    await clipDone(page);
  });
});
