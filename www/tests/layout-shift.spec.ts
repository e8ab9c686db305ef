//! Nothing that is done, found or said shifts the layout.

import { type Page } from '@playwright/test';
import { encodePng } from 'veronese/codecs';

import { type Upload, clipDone, clipFrames, clipPhase, differences, drag, expect, inspect, labelsOnCanvas, openClip, openSampleClip, openSegmented, opened, said, screen, segmentClip, test, upload, withSmallSampleClip } from './support.js';

/** Sums layout shifts from now on, including those after user input, which browsers exclude from their score. */
async function watchShifts(page: Page): Promise<() => Promise<number>> {
  await page.evaluate(() => {
    const shifts = { sum: 0, what: [] as string[] };
    const add = (entries: PerformanceEntryList): void => {
      for (const entry of entries as (PerformanceEntry & { value: number; sources: { node: Node | null }[] })[]) {
        shifts.sum += entry.value;
        for (const { node } of entry.sources) shifts.what.push(node instanceof Element ? `${node.localName}#${node.id}.${node.className}` : String(node?.nodeName));
      }
    };
    const observer = new PerformanceObserver((list) => add(list.getEntries()));
    observer.observe({ type: 'layout-shift' });
    Object.assign(window, { shifts, observer, add });
  });
  return () =>
    page.evaluate(async () => {
      // Of the frame that is on its way as well: entries are there after it.
      await new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve)));
      const { shifts, observer, add } = window as unknown as { shifts: { sum: number; what: string[] }; observer: PerformanceObserver; add: (entries: PerformanceEntryList) => void };
      add(observer.takeRecords());
      observer.disconnect();
      console.log(`layout shift ${shifts.sum.toFixed(3)}: ${shifts.what.join(', ')}`);
      return shifts.sum;
    });
}

test('three steps through a clip that is inspected, and choosing a tool, shift nothing, on a desktop and on a phone', async ({ page }) => {
  await openSegmented(page, await clipFrames(8));
  for (const [from, width, height] of [[0, 1280, 860], [3, 390, 780]] as const) {
    await page.setViewportSize({ width, height });
    await inspect(page);
    // With the timeline in view, and whatever is below it.
    if (width < 640) await page.locator('#track').scrollIntoViewIfNeeded();
    else await page.locator('#inspect').scrollIntoViewIfNeeded();
    const shift = await watchShifts(page);
    for (let k = from + 1; k <= from + 3; k++) {
      await page.getByRole('button', { name: 'Step forward' }).click();
      await expect(page.locator('#caption')).toHaveText(`Frame ${k}`);
      await inspect(page);
    }
    expect(await shift(), `${width} × ${height}`).toBeLessThanOrEqual(0.01);
    await page.evaluate(() => scrollTo(0, 0));
    const places = (): Promise<number[]> =>
      page.evaluate(() => [...document.querySelectorAll('.layers, #tools label, #tools button, #run, #look')].map((part) => part.getBoundingClientRect().top + part.getBoundingClientRect().left));
    const before = await places();
    for (const tool of ['brush', 'eraser', 'look']) {
      await page.locator(`#tools [value=${tool}]`).check();
      expect(await places()).toEqual(before);
    }
  }
});

test('the picture never moves under the pen, whatever is said of a correction', async ({ page }) => {
  await openSegmented(page, await clipFrames(6));
  await page.keyboard.press('1');
  for (const [width, height] of [[1280, 720], [1440, 900], [390, 844]] as const) {
    await page.setViewportSize({ width, height });
    await page.locator('#tools [value=brush]').check({ force: true });
    await page.locator('.layers').scrollIntoViewIfNeeded();
    await page.evaluate(() => {
      const places = new Set<string>();
      const look = (): void => {
        const { x, y, width, height } = document.querySelector('.layers')!.getBoundingClientRect();
        places.add([x, y + scrollY, width, height].join(' '));
        requestAnimationFrame(look);
      };
      look();
      Object.assign(window, { places });
    });
    const places = (): Promise<string[]> => page.evaluate(() => [...(window as unknown as { places: Set<string> }).places]);
    const before = await labelsOnCanvas(page);
    await drag(page, [0.1, 0.85], [0.3, 0.85]);
    await expect.poll(async () => differences(await labelsOnCanvas(page), before)).toBeGreaterThan(0);
    await clipDone(page);
    // Sentences are longer in clips that are.
    await page.locator('#clip-status').evaluate((status) => (status.textContent = 'Corrected: the masks of 1,234 frames have changed. 1,200 accepted frames stay as they are. '.repeat(3)));
    await page.locator('#clip-detail').evaluate((detail) => (detail.textContent = 'Your correction has come to 1,234 of 2,345 frames; about 12 minutes left. '.repeat(2)));
    await page.evaluate(() => new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve))));
    expect(await places(), `${width} × ${height}`).toHaveLength(1);
    await page.screenshot({ path: screen(`correcting-${width}`) });
    await page.keyboard.press('Control+z');
    await clipDone(page);
  }
});

/** Grey frames, 96 × 72. */
function greyFrames(count: number, grey: (x: number, y: number, k: number) => number): Promise<Upload[]> {
  return Promise.all(
    Array.from({ length: count }, async (_, k) => {
      const pixels = Uint8Array.from({ length: 3 * 96 * 72 }, (_, i) => grey(Math.floor(i / 3) % 96, Math.floor(i / 288), k));
      return { name: `g${k}.png`, mimeType: 'image/png', buffer: Buffer.from(await encodePng(96, 72, pixels)) };
    }),
  );
}

const wave = (x: number, y: number): number => 128 + 50 * Math.sin(0.31 * x + 0.17 * y) + 40 * Math.cos(0.23 * x - 0.41 * y) + 20 * Math.sin(0.9 * x) * Math.cos(0.8 * y);

test.describe('on a phone', () => {
  test.use({ viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true });

  test('bar and dock keep their height whatever they say, and all of it can be read', async ({ page }) => {
    const heights = new Map<number, Set<string>>();
    /** Looks at a sentence in windows of different widths. Returns in which it is not shown as a whole until it is tapped. */
    const cut = async (sentence: string): Promise<number[]> => {
      const cut: number[] = [];
      for (const width of [360, 390, 1280]) {
        await page.setViewportSize({ width, height: 844 });
        const told = page.locator('.told', { has: page.locator(sentence) });
        const look = (): Promise<{ height: string; whole: boolean; seen: boolean }> =>
          told.evaluate((told) => {
            const text = told.firstElementChild!;
            const { left, bottom } = text.getBoundingClientRect();
            const height = ['.masthead', '#clip-run'].map((part) => document.querySelector(part)!.getBoundingClientRect().height).join();
            return { height, whole: text.scrollHeight <= text.clientHeight, seen: text.contains(document.elementFromPoint(left + 2, bottom - 4)) };
          });
        await told.scrollIntoViewIfNeeded();
        const before = await look();
        if (!before.whole) cut.push(width);
        await told.tap();
        expect(await look(), `${sentence} ${width}`).toEqual({ height: before.height, whole: true, seen: true });
        await page.locator('#motions-title').tap();
        heights.set(width, (heights.get(width) ?? new Set()).add(before.height));
      }
      return cut;
    };

    // The whole picture moves as one piece.
    await openClip(page, await greyFrames(3, (x, y, k) => wave(x + 2 * k, y)));
    expect(await cut('#status')).toEqual([]);
    await segmentClip(page);
    await said(page, /^No objects in 3 frames\. The whole picture follows one motion, of up to 2\.\d pixels: nothing is seen to move by itself\.$/);
    expect(await cut('#status')).toEqual([]);
    await cut('#clip-status');
    // What is around the middle moves.
    await upload(page, await greyFrames(6, (x, y, k) => (Math.abs(x - 48) < 40 && Math.abs(y - 36) < 30 ? wave(3 * x, y) : wave(x + 3 * k, y + 2 * k))));
    await opened(page, 'g0 to g5');
    await segmentClip(page);
    await said(page, /it is likely to be the ground\.$/);
    expect(await cut('#clip-status')).toEqual([360, 390, 1280]);
    await upload(page, [...(await greyFrames(1, wave)), ...(await clipFrames(1, 64, 48))]);
    await opened(page, 'f00 and g0');
    await page.getByRole('button', { name: 'Segment the clip' }).click();
    await clipPhase(page, 'failed');
    await cut('#clip-status');
    for (const [width, seen] of heights) expect([...seen], String(width)).toHaveLength(1);
  });

  test('the page keeps its layout while it opens, and while the clip is segmented', async ({ page }) => {
    await withSmallSampleClip(page);
    await page.addInitScript(() => {
      type Shift = PerformanceEntry & { value: number; sources: { node: Node | null; previousRect: DOMRect; currentRect: DOMRect }[] };
      const shifts = { sum: 0, parts: [] as string[] };
      new PerformanceObserver((list) => {
        for (const { value, sources } of list.getEntries() as Shift[]) {
          shifts.sum += value;
          for (const { node, previousRect: was, currentRect: is } of sources) {
            const isPart = node instanceof Element && node.matches('.masthead, main, #stage, .layers, #timeline, .tracks, #track, #tools, .panel, .panel > section');
            if (isPart && (was.x !== is.x || was.y !== is.y)) shifts.parts.push(`${node.localName}#${node.id}.${node.className}`);
          }
        }
      }).observe({ type: 'layout-shift' });
      Object.assign(window, { shifts });
    });
    await openSampleClip(page);
    const { sum, parts } = await page.evaluate(() => (window as unknown as { shifts: { sum: number; parts: string[] } }).shifts);
    // Lines of text within their place, and the end of the list, may move; the parts of the page do not.
    expect(parts).toEqual([]);
    expect(sum).toBeLessThanOrEqual(0.05);
  });
});
