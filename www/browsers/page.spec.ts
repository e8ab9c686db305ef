//! The page in Chromium, Firefox and WebKit: start-up, the samples, a clip, an export and a project. In each the masks have
//! the bits that the package gives in Node, and so the same in all.

import { mkdir, mkdtemp, rm, writeFile } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import { dirname, join } from 'node:path';

import { expect, test } from '@playwright/test';
import { unzipSync } from 'fflate';
import { Key } from 'selenium-webdriver';
import { davisPalette } from 'veronese';
import { decodeImage } from 'veronese/codecs';

import { type Upload, clipFrames, clipInNode, differences, labelsOfColours, sample, sampleClip, screen, segmentedInNode } from '../tests/support.js';
import { BROWSERS, Driven } from './driven.js';

/** Gives files to the page as a person does, by the picker. */
async function upload(browser: Driven, folder: string, files: readonly Upload[]): Promise<void> {
  const paths = files.map(({ name }) => join(folder, name));
  for (const [k, { buffer }] of files.entries()) await writeFile(paths[k]!, buffer);
  await browser.find('#open-pair').sendKeys(paths.join('\n'));
}

async function masks(browser: Driven): Promise<Uint8Array> {
  return labelsOfColours(await browser.pixelsOf('#fill'));
}

for (const found of BROWSERS) {
  test(`the page in ${found.name}: the samples, a clip, an export and a project`, async ({ baseURL }) => {
    test.skip(found.problem !== undefined, found.problem);
    const folder = await mkdtemp(join(tmpdir(), 'veronese-frames-'));
    const browser = await Driven.open(found);
    const segmented = (): Promise<void> => browser.untilAttribute('#clip-run', 'data-phase', 'done');
    const find = browser.find.bind(browser);
    try {
      await browser.driver.manage().window().setRect({ width: 1280, height: 860 });
      await browser.driver.get(`${baseURL}#sample=intel-two-cars&quality=fast`);
      await segmented();
      const pair = [await sample('first'), await sample('second')] as const;
      expect(differences(await masks(browser), (await clipInNode(pair))[0]!)).toBe(0);
      await screenshot(browser, `browser-${found.name}-start`);

      // The motions between the two.
      await find('#inspect > summary').click();
      await browser.untilText('#inspect-status', 'found in');
      await find('#inspect [name=motions]').click();
      await browser.untilText('#caption', 'Motions');
      const { labels } = await segmentedInNode(...pair);
      expect(differences(await masks(browser), labels)).toBe(0);
      expect(new Set(labels).size).toBeGreaterThan(2);
      await find('#inspect > summary').click();

      // The sample clip: every browser decodes its frames to the same pixels.
      await find('#samples .sample').click();
      await browser.untilText('#clip-name', '51 frames');
      await segmented();
      await find('#track').sendKeys(Key.HOME);
      const shipped = await sampleClip();
      const cars = await clipInNode(shipped);
      for (const [index, { buffer }] of shipped.entries()) {
        if (index > 0) await find('#track').sendKeys(Key.ARROW_RIGHT);
        await browser.untilText('#caption', `Frame ${index}`);
        expect(differences(await browser.pixelsOf('#frame'), (await decodeImage(buffer)).data)).toBe(0);
        expect(differences(await masks(browser), cars[index]!)).toBe(0);
      }

      const files = await clipFrames(6);
      const clip = await clipInNode(files);
      await upload(browser, folder, files);
      await browser.untilText('#clip-name', '6 frames');
      await segmented();
      await browser.untilText('#caption', 'Frame 0');
      await find('#track').sendKeys(Key.HOME);
      for (const [index, labels] of clip.entries()) {
        if (index > 0) await find('#track').sendKeys(Key.ARROW_RIGHT);
        await browser.untilText('#caption', `Frame ${index}`);
        expect(differences(await masks(browser), labels)).toBe(0);
      }
      await screenshot(browser, `browser-${found.name}-clip`);

      // The file that is saved: one indexed PNG for each frame.
      await find('#open-export').click();
      const davis = '#clip-export select option[value=davis]';
      await browser.until('the formats', () => browser.driver.executeScript<boolean>('return document.querySelector(arguments[0]) !== null;', davis));
      await find(davis).click();
      const save = find('#clip-export button');
      await browser.until('the button that saves', () => save.isEnabled());
      await save.click();
      const archive = unzipSync(await browser.downloaded('davis.zip'));
      const byColour = new Map(davisPalette().map((colour, label) => [colour.join(), label]));
      for (const [index, { name }] of files.entries()) {
        const { data } = await decodeImage(archive[`davis/Annotations/480p/f00_to_f05/${name}`]!);
        const labels = Uint8Array.from({ length: data.length / 4 }, (_, p) => byColour.get([...data.subarray(4 * p, 4 * p + 3)].join()) ?? -1);
        expect(differences(labels, clip[index]!)).toBe(0);
      }

      // The work is kept, and is there when the same frames are opened again.
      await browser.untilText('#project-status', 'Your work is kept in this browser');
      await browser.driver.navigate().refresh();
      await segmented();
      await upload(browser, folder, files);
      await browser.untilText('#clip-name', '6 frames');
      await browser.untilText('#clip-status', 'Continued: 2 objects in 6 frames.');
      await find('#track').sendKeys(Key.END);
      await browser.untilText('#caption', 'Frame 5');
      expect(differences(await masks(browser), clip[5]!)).toBe(0);
    } finally {
      await browser.close();
      await rm(folder, { recursive: true });
    }
  });
}

async function screenshot(browser: Driven, name: string): Promise<void> {
  const path = screen(name);
  await mkdir(dirname(path), { recursive: true });
  await writeFile(path, await browser.driver.takeScreenshot(), 'base64');
}
