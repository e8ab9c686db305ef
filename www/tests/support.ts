//! Shared by the tests: a page whose errors fail the test, files to upload, masks read back from the canvas.

import { createHash } from 'node:crypto';
import { readFileSync } from 'node:fs';
import { readFile, readdir } from 'node:fs/promises';
import { fileURLToPath } from 'node:url';

import { type CDPSession, type Locator, type Page, expect } from '@playwright/test';
import { type RangeOptions, type Segmentation, type SegmentOptions, Segmenter, davisPalette, segmentPair } from 'veronese';
import { decodeImage, encodePng } from 'veronese/codecs';

import { PALETTE, UNKNOWN_COLOUR } from '../src/drawing/palette.js';
import { SAMPLES } from '../src/frames/samples.js';
import type { Header } from '../src/projects/file.js';
import { test as unwatched } from './kept.js';

export { expect, unwatched };

/** A file for Playwright's `setInputFiles`. */
export interface Upload {
  name: string;
  mimeType: string;
  buffer: Buffer;
}

/** A test that fails if its page logs an error, violates the content security policy or contacts another host. */
export const test = unwatched.extend<{ page: Page }>({
  page: async ({ page, baseURL }, use) => {
    const complaints: string[] = [];
    page.on('console', (message) => {
      if (message.type() === 'error') complaints.push(`console: ${message.text()}`);
    });
    page.on('pageerror', (error) => complaints.push(`uncaught: ${error.message}`));
    page.on('request', (request) => {
      const { protocol, origin } = new URL(request.url());
      const own = protocol === 'blob:' || protocol === 'data:' || origin === new URL(baseURL ?? '').origin;
      if (!own || request.method() !== 'GET') complaints.push(`request: ${request.method()} ${request.url()}`);
    });
    await page.addInitScript(() => {
      document.addEventListener('securitypolicyviolation', (event) => {
        console.error(`policy violated: ${event.violatedDirective} by ${event.blockedURI}`);
      });
    });
    await use(page);
    await withSamples(page);
    page.removeAllListeners();
    expect(complaints).toEqual([]);
  },
});

/** How long a clip may take on a busy machine, in milliseconds. */
const PATIENCE = 120_000;

/** The options of {@link open}: most tests need masks, not the best ones. */
export const FAST: SegmentOptions = { quality: 'fast' };

/** The address of the sample pair. Without a sample, the page opens with a clip. */
export const PAIR = './#sample=intel-two-cars';

/** Opens the page with the sample pair and waits for its masks, with quality `fast`. */
export async function open(page: Page): Promise<void> {
  await page.goto(`${PAIR}&quality=fast`);
  await clipDone(page);
}

/** Opens the page without frames, for tests that bring their own: those of samples never arrive. Clips wait until a test asks for their masks. */
export async function openEmpty(page: Page, quality: 'fast' | 'best' = 'fast'): Promise<void> {
  await holdSamples(page);
  await page.goto(`${PAIR}&quality=${quality}&segment=asked`);
}

/** Samples never arrive until {@link withSamples}. */
export async function holdSamples(page: Page): Promise<void> {
  if (withoutSamples.has(page)) return;
  // Not by a route: with routes the browser caches nothing, and compiles all code anew in every page.
  const devtools = await page.context().newCDPSession(page);
  await devtools.send('Fetch.enable', { patterns: ['first.*', 'second.*', 'frames/*'].map((frame) => ({ urlPattern: `*/samples/*/${frame}` })) });
  withoutSamples.set(page, devtools);
}

/** The pages whose samples never arrive, with what stops them. */
const withoutSamples = new WeakMap<Page, CDPSession>();

/** After {@link openEmpty}: samples can be opened again. */
export async function withSamples(page: Page): Promise<void> {
  await withoutSamples.get(page)?.detach();
  withoutSamples.delete(page);
}

/** The page is on a machine with so many processors, of which it leaves one alone if there are more than two. Called before it is opened. */
export async function withProcessors(page: Page, count: number): Promise<void> {
  await page.addInitScript((value) => Object.defineProperty(Navigator.prototype, 'hardwareConcurrency', { get: () => value }), count);
}

/** Opens frames, or a video of `count` frames, as a clip. */
export async function openClip(page: Page, files: Upload[], { count = files.length, quality = 'fast' }: { count?: number; quality?: 'fast' | 'best' } = {}): Promise<void> {
  await openEmpty(page, quality);
  await upload(page, files);
  await expect(page.locator('#clip-name')).toContainText(`${count} frames`);
  await done(page);
  await withSamples(page);
}

/** Leaves the page and comes back, without frames: those of samples never arrive. */
export async function reloadEmpty(page: Page): Promise<void> {
  await holdSamples(page);
  await page.reload();
}

/** Leaves the page, comes back and opens the same frames again. */
export async function reopen(page: Page, files: Upload[], count = files.length): Promise<void> {
  await reloadEmpty(page);
  await upload(page, files);
  if (count > 2) await expect(page.locator('#clip-name')).toContainText(`${count} frames`);
  await done(page);
  await withSamples(page);
}

/** Segments the open clip. */
export async function segmentClip(page: Page): Promise<void> {
  await page.getByRole('button', { name: 'Segment the clip' }).click();
  await clipDone(page);
}

/**
 * Opens frames, or a video of `count` frames, as a clip that has its masks: with a project of them, which takes a third of the time of segmenting.
 * Its status is that of work that goes on. Tests that are about a run call {@link segmentClip}.
 */
export async function openSegmented(page: Page, files: Upload[], count = files.length): Promise<void> {
  await openClip(page, [await projectOf(page, files, count), ...files], { count });
  await clipDone(page);
}

/** Goes to a frame of the clip by the track of its frames. */
export async function goTo(page: Page, index: number): Promise<void> {
  const track = page.getByRole('slider', { name: 'Current frame' });
  const box = (await track.boundingBox())!;
  const count = Number(await track.getAttribute('aria-valuemax')) + 1;
  await track.click({ position: { x: ((index + 0.5) * box.width) / count, y: 10 } });
  await expect(page.locator('#caption')).toHaveText(`Frame ${index}`);
  await done(page);
}

/** A point of the picture, 0…1 from its left and its top. */
export type Place = readonly [number, number];

/** Drags between two points of the picture, or presses where they are one, without waiting for the result. */
export async function drag(page: Page, from: Place, to: Place): Promise<void> {
  const box = (await page.locator('.layers').boundingBox())!;
  const at = ([x, y]: Place): [number, number] => [box.x + x * box.width, box.y + y * box.height];
  await page.mouse.move(...at(from));
  // What lasts is no press: nothing comes between its beginning and its end.
  if (from.join() === to.join()) return void (await Promise.all([page.mouse.down(), page.mouse.up()]));
  await page.mouse.down();
  await page.mouse.move(...at(to), { steps: 4 });
  await page.mouse.up();
}

/** A function whose results are kept, for all tests of a process, by what it is given. */
function once<F extends (...given: never[]) => unknown>(make: F, keyOf: (...given: Parameters<F>) => string = (...given) => given.join()): F {
  const made = new Map<string, unknown>();
  return ((...given: Parameters<F>) => {
    const key = keyOf(...given);
    if (!made.has(key)) made.set(key, make(...given));
    return made.get(key);
  }) as F;
}

/** The frames of the clip that opens the page. */
export const sampleClip = once(async (): Promise<Upload[]> => {
  const folder = new URL('../public/samples/passing-cars/frames/', import.meta.url);
  const names = (await readdir(folder)).sort();
  return Promise.all(names.map(async (name) => ({ name, mimeType: 'image/webp', buffer: await readFile(new URL(name, folder)) })));
});

/** The same clip, an eighth as wide and as high: large enough for the same two cars. */
export const smallSampleClip = once(async (): Promise<Upload[]> => {
  const by = 8;
  const frames: Upload[] = [];
  for (const { name, buffer } of await sampleClip()) {
    const { width, height, data } = await decodeImage(buffer);
    const [w, h] = [width / by, height / by];
    const means = Uint8Array.from({ length: w * h * 3 }, (_, i) => {
      const [x, y, c] = [Math.floor(i / 3) % w, Math.floor(i / 3 / w), i % 3];
      let sum = 0;
      for (let k = 0; k < by * by; k++) sum += data[4 * ((by * y + Math.floor(k / by)) * width + by * x + (k % by)) + c]!;
      return sum / (by * by);
    });
    frames.push({ name, mimeType: 'image/png', buffer: Buffer.from(await encodePng(w, h, means)) });
  }
  return frames;
});

/** What the page has of the small clip: the frames around the first that is shown, in which both cars are whole. */
export const SMALL_SAMPLE = { from: 26, count: 12, start: 6 } as const;

/** Gives the page some frames of the small clip, for tests that are not about the masks of the other; the host page takes its own from all. */
export async function withSmallSampleClip(page: Page): Promise<void> {
  const frames = await smallSampleClip();
  const { from, count, start } = SMALL_SAMPLE;
  // Not by routes: with them the browser caches nothing.
  const devtools = await page.context().newCDPSession(page);
  devtools.on('Fetch.requestPaused', ({ requestId, request: { url } }) => {
    const name = url.replace(/^.*\//, '');
    const index = frames.findIndex((frame) => frame.name === name);
    const { mimeType, buffer } = index < 0 ? shorterSample(name, count, start) : frames[index < count ? from + index : index]!;
    const responseHeaders = [{ name: 'Content-Type', value: mimeType }];
    // The page may have been left.
    devtools.send('Fetch.fulfillRequest', { requestId, responseCode: 200, responseHeaders, body: buffer.toString('base64') }).catch(() => undefined);
  });
  await devtools.send('Fetch.enable', { patterns: ['samples/passing-cars/frames/*', 'assets/index-*.js'].map((file) => ({ urlPattern: `*/${file}` })) });
}

/** The script of the page in which the sample that opens it has so many frames. */
const shorterSample = once((name: string, count: number, start: number): Omit<Upload, 'name'> => {
  const script = readFileSync(new URL(`../dist/assets/${name}`, import.meta.url), 'utf8');
  const [sample] = SAMPLES;
  const shorter = script.replace(new RegExp(`(${sample.title}.,)${sample.frames.length},${sample.start}\\b`), `$1${count},${start}`);
  expect(shorter, 'the script names the sample').not.toBe(script);
  return { mimeType: 'text/javascript', buffer: Buffer.from(shorter) };
});

/** Opens the page as a first visitor does, with the sample clip, and waits until it is segmented. */
export async function openSampleClip(page: Page, settings = 'quality=fast'): Promise<void> {
  await page.goto(`./#${settings}`);
  await clipDone(page);
}

/** Cancels the next run on the clip as soon as it says how far it is, or this of it, however fast it goes on. */
export async function cancelWhen(page: Page, said = /./): Promise<void> {
  await page.locator('#clip-detail').evaluate((detail, source) => {
    const observer = new MutationObserver(() => {
      if (!new RegExp(source).test(detail.textContent)) return;
      observer.disconnect();
      document.querySelector<HTMLButtonElement>('#clip-cancel')!.click();
    });
    observer.observe(detail, { childList: true, characterData: true, subtree: true });
  }, said.source);
}

/** Keeps the open page from reading a frame until what this gives is called. */
export async function holdBack(page: Page, name: string): Promise<() => Promise<void>> {
  await page.evaluate(holdReading, name);
  return () => release(page, name);
}

/** {@link holdBack} of a page that is opened next. */
export async function held(page: Page, name: string): Promise<() => Promise<void>> {
  await page.addInitScript(holdReading, name);
  return () => release(page, name);
}

function holdReading(name: string): void {
  const decode = window.createImageBitmap;
  const released = new Promise<void>((release) => Object.assign(window, { [`release ${name}`]: release }));
  window.createImageBitmap = async (source: ImageBitmapSource, ...rest: []) => {
    if (source instanceof File && source.name === name) await released;
    return decode(source, ...rest);
  };
}

function release(page: Page, name: string): Promise<void> {
  return page.evaluate((name) => (window as unknown as Record<string, () => void>)[`release ${name}`]!(), name);
}

/** Waits until the clip is segmented. */
export async function clipDone(page: Page): Promise<void> {
  await clipPhase(page, 'done');
}

/** Waits until the run on the clip has this phase. */
export async function clipPhase(page: Page, name: string): Promise<void> {
  await phase(page, '#clip-run', name);
}

/** Waits until an element has this phase. */
async function phase(page: Page, selector: string, name: string): Promise<void> {
  const pattern = new RegExp(`^(${name})$`);
  await until(page, selector, 'data-phase', pattern);
  const notice = await page.locator('#notice').innerText().catch(() => '');
  await expect(page.locator(selector), `the last notice was “${notice}”`).toHaveAttribute('data-phase', pattern, { timeout: PATIENCE });
}

/** Waits until each undo and redo is on screen. */
async function moved(page: Page): Promise<void> {
  await until(page, '#clip-status', 'aria-busy', /^(?!true)/);
}

/** Waits until the clip says this of what was done last. */
export async function said(page: Page, sentence: RegExp): Promise<void> {
  await moved(page);
  await until(page, '#clip-status', null, sentence);
  await expect(page.locator('#clip-status')).toHaveText(sentence, { timeout: PATIENCE });
}

/** Waits until an attribute of an element, or its text, is so: the page tells at once, where `expect` asks once a second. */
async function until(page: Page, selector: string, attribute: string | null, pattern: RegExp): Promise<void> {
  const reached = page.evaluate(
    ([selector, attribute, source, timeout]) =>
      new Promise<void>((resolve) => {
        const element = document.querySelector(selector)!;
        const observer = new MutationObserver(() => setTimeout(look));
        const look = (): void => {
          const is = attribute === null ? element.textContent : (element.getAttribute(attribute) ?? '');
          if (!new RegExp(source).test(is)) return;
          observer.disconnect();
          resolve();
        };
        observer.observe(element, attribute === null ? { childList: true, characterData: true, subtree: true } : { attributeFilter: [attribute] });
        look();
        setTimeout(resolve, timeout);
      }),
    [selector, attribute, pattern.source, PATIENCE] as const,
  );
  await reached.catch(() => undefined); // another page has taken its place
}

/** Whether the page can be left without a question: nothing is still to be written. */
export function leaves(page: Page): Promise<boolean> {
  return page.evaluate(() => window.dispatchEvent(new Event('beforeunload', { cancelable: true })));
}

/** Waits until the browser keeps all work on what is open. */
export async function kept(page: Page): Promise<void> {
  await expect(page.locator('#saving button[aria-busy=false]')).toHaveText(/^Saved/);
  await expect.poll(() => leaves(page)).toBe(true);
}

/** Takes all corrections of a pair back. */
export async function undoAll(page: Page): Promise<void> {
  const undo = page.locator('#undo');
  while (await undo.isEnabled()) {
    await undo.evaluate((button: HTMLButtonElement) => button.click());
    await moved(page);
  }
  await done(page);
}

/** What the browser keeps of projects beside their journals. */
export function projectsInBrowser(page: Page): Promise<Header[]> {
  return page.evaluate(async () => {
    const name = 'veronese-projects';
    if (!(await indexedDB.databases()).some((database) => database.name === name)) return [];
    const settled = <T>(request: IDBRequest<T>): Promise<T> =>
      new Promise((resolve, reject) => {
        request.onsuccess = () => resolve(request.result);
        request.onerror = () => reject(request.error);
      });
    const database = await settled(indexedDB.open(name));
    const headers = await settled(database.transaction('headers').objectStore('headers').getAll());
    database.close();
    return headers;
  });
}

/** Hides the page, which keeps at once what is to be kept. */
export async function hide(page: Page): Promise<void> {
  await page.evaluate(() => {
    Object.defineProperty(document, 'visibilityState', { value: 'hidden', configurable: true });
    document.dispatchEvent(new Event('visibilitychange'));
  });
}

/** The masks of frames, shown one after another. */
export async function masksOf(page: Page, indices: readonly number[]): Promise<Uint8Array[]> {
  const masks: Uint8Array[] = [];
  for (const index of indices) {
    await goTo(page, index);
    masks.push(await labelsOnCanvas(page));
  }
  return masks;
}

/** Makes the browser one that keeps no projects. */
export async function withoutStorage(page: Page): Promise<void> {
  await page.addInitScript(() => {
    delete (StorageManager.prototype as { getDirectory?: unknown }).getDirectory;
    delete (window as { indexedDB?: unknown }).indexedDB;
  });
}

/** Waits until what was opened is on screen. */
export async function done(page: Page): Promise<void> {
  await phase(page, '#run', 'done|idle|live');
}

/** Inspects the frame on screen, and waits for its motions. */
export async function inspect(page: Page): Promise<void> {
  await page.locator('#inspect').evaluate((details: HTMLDetailsElement) => (details.open = true));
  await expect(page.locator('#inspect-status')).toHaveText(/found in/, { timeout: PATIENCE });
}

/** Moves the focus to the picture by keys: after a press on it, they are about the clip. */
export async function reachPicture(page: Page): Promise<void> {
  await page.locator('.layers').focus();
  await page.keyboard.press('Tab');
  await page.keyboard.press('Shift+Tab');
}

/** Types a value into a field, and Enter. A double click makes a name one. */
export async function enter(field: Locator, value: string): Promise<void> {
  if (await field.evaluate((input: HTMLInputElement) => input.readOnly)) await field.dblclick({ position: { x: 12, y: 10 } });
  await field.fill(value);
  await field.press('Enter');
}

/** Names the object of a row. */
export function rename(page: Page, row: number, name: string): Promise<void> {
  return enter(page.locator('#objects .motion-name').nth(row), name);
}

/** Waits until a clip of this name is on screen. */
export async function opened(page: Page, name: string): Promise<void> {
  await expect(page.locator('#clip-name')).toContainText(name);
  await done(page);
}

/** Clicks what saves a file. */
export async function saved(page: Page, button: Locator): Promise<{ name: string; bytes: Buffer }> {
  const [download] = await Promise.all([page.waitForEvent('download'), button.click()]);
  return { name: download.suggestedFilename(), bytes: await readFile(await download.path()) };
}

/** Saves the clip in a format. */
export async function savedClip(page: Page, format: string): Promise<{ name: string; bytes: Buffer }> {
  await openExport(page);
  await page.getByLabel('Format of the clip').selectOption({ label: format });
  return saved(page, page.getByRole('button', { name: 'Save clip' }));
}

export async function savedProject(page: Page): Promise<Upload> {
  await openExport(page);
  const { name, bytes } = await saved(page, page.getByRole('button', { name: 'Save project' }));
  await page.keyboard.press('Escape');
  return { name, mimeType: '', buffer: bytes };
}

/** The project of a clip whose masks are of quality `fast` and not corrected. A page of its own makes it, which keeps nothing in the browser. */
const projectOf = once(async (beside: Page, files: Upload[], count: number): Promise<Upload> => {
  const page = await beside.context().newPage();
  await withoutStorage(page);
  await openClip(page, files, { count });
  await segmentClip(page);
  const project = await savedProject(page);
  await page.close();
  return project;
}, (_, files) => keyOf(files, 'project'));

/** Merges the mask of a row of the list, whose details are open, with another. */
export async function mergeWith(row: Locator, other: number): Promise<void> {
  await row.locator('[data-action=merge-with]').selectOption(String(other));
  await row.locator('[data-action=merge]').click();
}

/** Opens the settings that are folded away. */
export async function openAdvanced(page: Page): Promise<void> {
  await page.locator('#settings details').evaluate((details) => void ((details as HTMLDetailsElement).open = true));
}

/** Opens files through the picker. */
export async function upload(page: Page, files: Upload[]): Promise<void> {
  await page.locator('#open-pair').setInputFiles(files);
}

/** A frame of the sample pair. */
export async function sample(name: 'first' | 'second', as = `${name}.png`): Promise<Upload> {
  const path = fileURLToPath(new URL(`../public/samples/intel-two-cars/${name}.png`, import.meta.url));
  return { name: as, mimeType: 'image/png', buffer: await readFile(path) };
}

/** A PNG file of a textured background and a textured square in front of it, moved by (`dx`, `dy`) pixels. */
export async function square(name: string, width: number, height: number, dx: number, dy: number): Promise<Upload> {
  const pixels = new Uint8Array(width * height * 3);
  const side = Math.min(width, height) / 3;
  for (let y = 0, i = 0; y < height; y++) {
    for (let x = 0; x < width; x++, i += 3) {
      const [u, v] = [x - width / 3 - dx, y - height / 3 - dy];
      const inside = u >= 0 && u < side && v >= 0 && v < side;
      pixels.set(inside ? texture(u + 500, v + 300, 0.7) : texture(x, y, 0.45), i);
    }
  }
  return { name, mimeType: 'image/png', buffer: Buffer.from(await encodePng(width, height, pixels)) };
}

/** A smooth texture, nowhere flat, that differs between the channels. */
function texture(x: number, y: number, pitch: number): [number, number, number] {
  const wave = (a: number, b: number): number => Math.round(128 + 60 * Math.sin(pitch * (a * x + b * y)) + 50 * Math.cos(pitch * (b * x - a * y) * 0.61));
  return [wave(0.9, 0.4), wave(0.5, -0.8), wave(0.2, 0.95)];
}

/** The segmentation of two files in Node. */
export const segmentedInNode = once(
  async (first: Upload, second: Upload, options: SegmentOptions = FAST): Promise<Segmentation> => segmentPair(await decodeImage(first.buffer), await decodeImage(second.buffer), options),
  (first, second, options) => keyOf([first, second], options),
);

/** The labels of each frame of a clip, found in Node. */
export const clipInNode = once(async (files: readonly Upload[], options: RangeOptions = { quality: 'fast' }): Promise<Uint8Array[]> => {
  const frames = { length: files.length, read: async (index: number) => decodeImage(files[index]!.buffer) };
  const segmenter = new Segmenter();
  const clip = await segmenter.openClip(frames);
  try {
    await clip.segment(options);
    return await Promise.all(files.map(async (_, index) => (await clip.labels(index)).labels));
  } finally {
    await clip.close();
    segmenter.close();
  }
}, keyOf);

function keyOf(files: readonly Upload[], options: unknown): string {
  const hash = createHash('sha256');
  for (const { buffer } of files) hash.update(buffer);
  return hash.digest('hex') + JSON.stringify(options);
}

/** Drops or pastes files on the page. */
export async function give(page: Page, how: 'drop' | 'paste', files: readonly Upload[]): Promise<void> {
  await page.evaluate(
    ([how, all]) => {
      const transfer = new DataTransfer();
      for (const { name, type, bytes } of all) transfer.items.add(new File([Uint8Array.from(atob(bytes), (c) => c.charCodeAt(0))], name, { type }));
      const common = { bubbles: true, cancelable: true };
      if (how === 'paste') document.body.dispatchEvent(new ClipboardEvent('paste', { ...common, clipboardData: transfer }));
      else for (const type of ['dragenter', 'drop']) document.body.dispatchEvent(new DragEvent(type, { ...common, dataTransfer: transfer }));
    },
    [how, files.map(({ name, mimeType, buffer }) => ({ name, type: mimeType, bytes: buffer.toString('base64') }))] as const,
  );
}

/** Opens a sample by its name, also where they are folded away. */
export async function openSample(page: Page, name: string): Promise<void> {
  await page.locator('#welcome').evaluate((details: HTMLDetailsElement) => (details.open = true));
  await page.getByRole('button', { name, exact: true }).click();
}

/** Opens the panel of exports, if it is closed. */
export async function openExport(page: Page): Promise<void> {
  if (!(await page.locator('#export').isVisible())) await page.locator('#open-export').click();
}

interface CanvasPixels {
  width: number;
  height: number;
  data: Uint8Array;
}

/** The RGBA bytes of a canvas. */
export function pixelsOf(page: Page, selector: string): Promise<CanvasPixels> {
  return pixelsIn(page.locator(selector));
}

async function pixelsIn(picture: Locator): Promise<CanvasPixels> {
  const { width, height, base64 } = await picture.evaluate(async (source: HTMLCanvasElement | HTMLImageElement) => {
    // The page may give the image another file meanwhile.
    for (let attempt = 0; source instanceof HTMLImageElement; attempt++) {
      try {
        await source.decode();
        break;
      } catch (error) {
        if (attempt === 20) throw error;
      }
    }
    const { width, height } = source instanceof HTMLImageElement ? { width: source.naturalWidth, height: source.naturalHeight } : source;
    // Reads from a copy: frequent reads change how a browser stores a canvas.
    const copy = new OffscreenCanvas(width, height).getContext('2d', { willReadFrequently: true })!;
    copy.drawImage(source, 0, 0);
    return { width, height, base64: (new Uint8Array(copy.getImageData(0, 0, width, height).data.buffer) as Uint8Array & { toBase64(): string }).toBase64() };
  });
  return { width, height, data: new Uint8Array(Buffer.from(base64, 'base64')) };
}

/** The RGBA bytes of an `<img>`. */
export async function pixelsOfPicture(picture: Locator): Promise<Uint8Array> {
  return (await pixelsIn(picture)).data;
}

/** The number of each pixel's mask, read back from its colour; 0 where nothing is painted. Waits for an undo or redo. */
export async function labelsOnCanvas(page: Page): Promise<Uint8Array> {
  await moved(page);
  return labelsOfColours((await pixelsOf(page, '#fill')).data);
}

/** The numbers of masks, of the RGBA bytes of their canvas. */
export function labelsOfColours(data: Uint8Array): Uint8Array {
  const view = new DataView(data.buffer, data.byteOffset, data.byteLength);
  return Uint8Array.from({ length: data.length / 4 }, (_, p) => {
    const colour = view.getUint32(4 * p);
    if ((colour & 255) === 0) return 0;
    const label = LABEL_BY_COLOUR.get(colour);
    if (label === undefined) throw new Error(`pixel ${p} has the colour ${data.subarray(4 * p, 4 * p + 4).join()} of no label`);
    return label;
  });
}

/** By red, green, blue and 255 as one number. */
const LABEL_BY_COLOUR = new Map([...PALETTE.entries(), [255, UNKNOWN_COLOUR] as const].slice(1).map(([label, [r, g, b]]) => [((r << 24) | (g << 16) | (b << 8) | 255) >>> 0, label]));

/** The labels of a picture in the palette of DAVIS, of its file or its RGBA bytes. */
export async function labelsOfDavis(png: Uint8Array): Promise<Uint8Array> {
  return labelsInPalette((await decodeImage(png)).data);
}

export function labelsInPalette(data: ArrayLike<number>): Uint8Array {
  const byColour = new Map(davisPalette().map((colour, label) => [colour.join(), label]));
  return Uint8Array.from({ length: data.length / 4 }, (_, p) => byColour.get([data[4 * p], data[4 * p + 1], data[4 * p + 2]].join()) ?? -1);
}

/** The number of elements that differ: more readable in a failure than two large arrays. */
export function differences(a: ArrayLike<number>, b: ArrayLike<number>): number {
  if (a.length !== b.length) return Math.max(a.length, b.length);
  let count = 0;
  for (let i = 0; i < a.length; i++) if (a[i] !== b[i]) count += 1;
  return count;
}

/** The path of a screenshot. */
export function screen(name: string): string {
  return fileURLToPath(new URL(`../../out/screens/${name}.png`, import.meta.url));
}

/**
 * The frames of a clip, as PNG files f00.png, f01.png …: a disc and a square with textures of their own move across a textured background,
 * the disc to the right and the square to the left.
 */
export async function clipFrames(count: number, width = 100, height = 70): Promise<Upload[]> {
  return Promise.all(Array.from({ length: count }, (_, k) => clipFrame(k, width, height)));
}

const clipFrame = once(async (k: number, width: number, height: number): Promise<Upload> => {
  const pixels = new Uint8Array(width * height * 3);
  for (let y = 0, i = 0; y < height; y++) {
    for (let x = 0; x < width; x++, i += 3) {
      const disc = Math.hypot(x - 0.2 * width - 4 * k, y - 0.36 * height - k) < 0.16 * height;
      const box = Math.abs(x - 0.75 * width + 3 * k) < 0.12 * height && Math.abs(y - 0.7 * height) < 0.12 * height;
      pixels.set(disc ? texture(x - 4 * k + 500, y - k + 300, 0.7) : box ? texture(x + 3 * k + 900, y + 100, 0.9) : texture(x, y, 0.45), i);
    }
  }
  return { name: `f${String(k).padStart(2, '0')}.png`, mimeType: 'image/png', buffer: Buffer.from(await encodePng(width, height, pixels)) };
});

/** The serious and critical violations that axe finds, of some rules or of all. */
export async function axe(page: Page, rules?: string[]): Promise<string[]> {
  const source = readFileSync(new URL('../../node_modules/axe-core/axe.min.js', import.meta.url), 'utf8');
  await page.evaluate(source);
  return page.evaluate(async (rules) => {
    const { axe } = window as unknown as { axe: { run(options: { runOnly?: string[] }): Promise<{ violations: { id: string; impact: string; nodes: { target: string[] }[] }[] }> } };
    const { violations } = await axe.run(rules ? { runOnly: rules } : {});
    return violations
      .filter(({ impact }) => impact === 'serious' || impact === 'critical')
      .map(({ id, nodes }) => `${id}: ${nodes.map(({ target }) => target.join(' ')).join(', ')}`);
  }, rules);
}
