//! Clips exported as videos: played by the browser, and compared with the masks on screen.

import { type Page } from '@playwright/test';
import { ALL_FORMATS, BufferSource, EncodedPacketSink, Input } from 'mediabunny';
import { decodeImage } from 'veronese/codecs';

import { clipDone, clipFrames, done, expect, masksOf, openEmpty, openExport, openSegmented, pixelsOfPicture, savedClip, test, upload } from './support.js';
import { video } from './video.js';

/** Odd, which H.264 cannot be. */
const [WIDTH, HEIGHT] = [201, 141];

/** The RGBA bytes of these frames, of 25 a second, as a `<video>` element shows them, and its size and duration. */
async function played(page: Page, bytes: Buffer, type: string, indices: readonly number[]): Promise<{ width: number; height: number; duration: number; frames: Uint8Array[] }> {
  const seen = await page.evaluate(
    async ([base64, type, indices]) => {
      const video = document.createElement('video');
      video.muted = true;
      video.src = URL.createObjectURL(new Blob([Uint8Array.from(atob(base64), (c) => c.charCodeAt(0))], { type }));
      const event = (name: string): Promise<unknown> =>
        new Promise((resolve, reject) => {
          video.addEventListener(name, resolve, { once: true });
          video.addEventListener('error', () => reject(new Error(video.error?.message)), { once: true });
        });
      await event('loadeddata');
      const context = new OffscreenCanvas(video.videoWidth, video.videoHeight).getContext('2d', { willReadFrequently: true })!;
      const frames: string[] = [];
      for (const index of indices) {
        // When the search ends, the frame before may still be shown.
        const presented = new Promise<void>((resolve) => {
          const look = (_now: number, { mediaTime }: VideoFrameCallbackMetadata): void => (Math.round(25 * mediaTime) === index ? resolve() : void video.requestVideoFrameCallback(look));
          video.requestVideoFrameCallback(look);
        });
        video.currentTime = (index + 0.5) / 25;
        await presented;
        context.clearRect(0, 0, video.videoWidth, video.videoHeight);
        context.drawImage(video, 0, 0);
        const { data } = context.getImageData(0, 0, video.videoWidth, video.videoHeight);
        let binary = '';
        for (let i = 0; i < data.length; i += 0x8000) binary += String.fromCharCode(...data.subarray(i, i + 0x8000));
        frames.push(btoa(binary));
      }
      return { width: video.videoWidth, height: video.videoHeight, duration: video.duration, frames };
    },
    [bytes.toString('base64'), type, indices] as const,
  );
  return { ...seen, frames: seen.frames.map((base64) => new Uint8Array(Buffer.from(base64, 'base64'))) };
}

/** The share of pixels for which `shown`, of its RGBA bytes, and `wanted`, of its label, differ. The picture may lack a last column or row. */
function share(pixels: Uint8Array, width: number, labels: Uint8Array, shown: (rgba: readonly number[]) => boolean, wanted: (label: number) => boolean): number {
  const count = pixels.length / 4;
  let wrong = 0;
  for (let p = 0; p < count; p++) {
    const label = labels[Math.floor(p / width) * WIDTH + (p % width)]!;
    if (shown([...pixels.subarray(4 * p, 4 * p + 4)]) !== wanted(label)) wrong += 1;
  }
  return wrong / count;
}

test('a clip is saved as a video with transparency, a green screen and a matte, of the objects that are ticked', async ({ page }) => {
  const files = await clipFrames(4, WIDTH, HEIGHT);
  await openSegmented(page, files);
  const at = [0, 3];
  const found = await masksOf(page, at.toReversed()).then((masks) => masks.reverse());
  await page.getByLabel('Show Object 2').uncheck();
  const wanted = (label: number): boolean => label === 1;

  // The preview shows the frame as the video does.
  await openExport(page);
  const preview = page.locator('#clip-preview');
  await page.getByLabel('Format of the clip').selectOption({ label: 'Video, transparent' });
  await expect(preview.locator('li')).toHaveText(['f00_to_f03-transparent.webm']);
  await expect(preview.locator('figcaption')).toHaveText('Frame 0');
  expect(share(await pixelsOfPicture(preview.locator('img')), WIDTH, found[0]!, (rgba) => rgba[3] === 255, wanted)).toBe(0);

  const transparent = await savedClip(page, 'Video, transparent');
  expect(transparent.name).toBe('f00_to_f03-transparent.webm');
  const cut = await played(page, transparent.bytes, 'video/webm', at);
  expect([cut.width, cut.height]).toEqual([WIDTH, HEIGHT]);
  expect(cut.duration).toBeCloseTo(4 / 25, 2);
  for (const [i, k] of at.entries()) {
    const pixels = cut.frames[i]!;
    expect(share(pixels, WIDTH, found[i]!, (rgba) => rgba[3]! > 127, wanted)).toBeLessThan(0.005);
    // The colours are those of the frame.
    const { data } = await decodeImage(files[k]!.buffer);
    const off = [...found[i]!.keys()].filter((p) => wanted(found[i]![p]!)).map((p) => Math.abs(pixels[4 * p + 1]! - data[4 * p + 1]!));
    expect(off.reduce((sum, one) => sum + one, 0) / off.length).toBeLessThan(12);
  }

  const green = await savedClip(page, 'Video, green screen');
  expect(green.name).toMatch(/^f00_to_f03-green\.(mp4|webm)$/);
  const screen = await played(page, green.bytes, green.name.endsWith('mp4') ? 'video/mp4' : 'video/webm', at);
  expect([screen.width, screen.height]).toEqual(green.name.endsWith('mp4') ? [WIDTH - 1, HEIGHT - 1] : [WIDTH, HEIGHT]);
  for (const [i, labels] of found.entries()) {
    const isGreen = ([r, g, b]: readonly number[]): boolean => r! < 60 && g! > 200 && b! < 60;
    expect(share(screen.frames[i]!, screen.width, labels, (rgba) => !isGreen(rgba), wanted)).toBeLessThan(0.03);
  }

  const matte = await savedClip(page, 'Video, matte');
  const white = await played(page, matte.bytes, matte.name.endsWith('mp4') ? 'video/mp4' : 'video/webm', at);
  for (const [i, labels] of found.entries()) expect(share(white.frames[i]!, white.width, labels, ([r]) => r! > 127, wanted)).toBeLessThan(0.005);
  await expect(page.locator('#clip-export-status')).toHaveText('Saved: one object in 4 frames.');
});

/** The times of a video's frames and their durations as its file says them, seconds. */
async function timesIn(bytes: Buffer): Promise<{ starts: number[]; durations: number[] }> {
  using input = new Input({ formats: ALL_FORMATS, source: new BufferSource(bytes) });
  const packets = new EncodedPacketSink((await input.getPrimaryVideoTrack())!);
  const [starts, durations]: [number[], number[]] = [[], []];
  for await (const { timestamp, duration } of packets.packets()) {
    starts.push(timestamp);
    durations.push(duration);
  }
  return { starts, durations };
}

test('a video of the frames between the in point and the out point has their times', { tag: '@soak' }, async ({ page }) => {
  await openEmpty(page);
  // No two frames are shown equally long, so that their times tell which they are.
  const durations = [0.04, 0.1, 0.07, 0.13, 0.05, 0.11, 0.06, 0.08];
  const file = await video(page, durations.length, 'webm', 'vp8', durations);
  await upload(page, [file]);
  await expect(page.locator('#clip-name')).toContainText('8 frames');
  await done(page);
  const [from, to] = [page.getByRole('slider', { name: 'In point' }), page.getByRole('slider', { name: 'Out point' })];
  for (let k = 0; k < 2; k++) await from.press('ArrowRight');
  await to.press('ArrowLeft');
  await page.getByRole('button', { name: 'Segment frames 2–6' }).click();
  await clipDone(page);

  const { starts } = await timesIn(file.buffer);
  const wanted = starts.slice(2, 7).map((start) => start - starts[2]!);
  for (const format of ['Video, transparent', 'Video, green screen']) {
    const saved = await savedClip(page, format);
    const written = await timesIn(saved.bytes);
    expect(written.starts).toHaveLength(5);
    // Containers round to a millisecond or finer.
    for (const [k, start] of written.starts.entries()) expect(Math.abs(start - wanted[k]!)).toBeLessThan(0.0015);
    expect(Math.abs(written.durations[0]! - 0.07)).toBeLessThan(0.0015);
    // Nothing says how long the last frame is shown: as long as the one before.
    if (saved.name.endsWith('mp4')) expect(Math.abs(written.durations[4]! - 0.11)).toBeLessThan(0.0015);
  }
});

test('a browser without encoders does not offer videos', async ({ page }) => {
  await page.addInitScript(() => delete (window as { VideoEncoder?: unknown }).VideoEncoder);
  await openSegmented(page, await clipFrames(4));
  await openExport(page);
  const formats = page.getByLabel('Format of the clip').locator('option');
  await expect(formats.last()).toHaveText('Label Studio');
  expect((await formats.allTextContents()).filter((title) => title.startsWith('Video'))).toEqual([]);
});
