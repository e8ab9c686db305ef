//! Clips: videos with a number in every frame, read back exactly; how fast they are played; those that cannot be read.

import { type Page } from '@playwright/test';

import { BufferTarget, EncodedPacket, EncodedVideoPacketSource, Mp4OutputFormat, Output } from 'mediabunny';

import { BIT, BITS, WIDTH, video } from './video.js';
import { type Upload, clipFrames, done, expect, goTo, holdBack, openClip, openEmpty, opened, pixelsOf, test, upload } from './support.js';

/** The number in the frame on screen. */
async function numberShown(page: Page, canvas = '#frame'): Promise<number> {
  const { data, width } = await pixelsOf(page, canvas);
  expect(width).toBe(WIDTH);
  const bits = Array.from({ length: BITS }, (_, b) => {
    const grey = data[4 * ((8 + BIT / 2) * width + 8 + b * BIT + BIT / 2)]!;
    if (grey > 90 && grey < 160) throw new Error(`bit ${b} is neither black nor white: ${grey}`);
    return grey > 128 ? 1 << b : 0;
  });
  return bits.reduce((sum, bit) => sum + bit, 0);
}

test('videos give exactly the requested frames', async ({ page }) => {
  await openEmpty(page);
  await upload(page, [await video(page, 20, 'webm', 'vp8')]);
  await opened(page, 'clip.webm, 20 frames, 192 × 128');
  expect(await numberShown(page)).toBe(0);
  for (const index of [7, 19, 5, 18]) {
    await goTo(page, index);
    expect(await numberShown(page)).toBe(index);
  }
  // At its end the clip stays where it is, and the frame beside is the one before.
  await page.keyboard.press('s');
  for (const [at, beside] of [[18, 19], [19, 18], [19, 18]] as const) {
    await expect(page.locator('#caption')).toHaveText(`Frame ${at} | Frame ${beside}`);
    expect([await numberShown(page), await numberShown(page, '#other')]).toEqual([at, beside]);
    await page.keyboard.press('.');
  }
  await expect(page.getByRole('slider', { name: 'Current frame' })).toHaveAttribute('aria-valuetext', 'Frame 19 of 0–19, 0.63 s');
  await page.keyboard.press('s');
  await page.getByRole('button', { name: 'Step back' }).click();
  await expect(page.locator('#caption')).toHaveText('Frame 18');
  expect(await numberShown(page)).toBe(18);

  // The strip shows thumbnails.
  const strip = await pixelsOf(page, '#strip');
  const greys = new Set(strip.data.filter((_, i) => i % 4 === 0));
  expect(greys.size).toBeGreaterThan(50);

  // An MP4 video, in a codec that every build of Chromium can encode.
  const other = await video(page, 12, 'mp4', 'vp9');
  await upload(page, [{ ...other, name: 'clip.mov', mimeType: 'video/quicktime' }]);
  await opened(page, 'clip.mov, 12 frames, 192 × 128');
  await goTo(page, 7);
  expect(await numberShown(page)).toBe(7);
});

test('keys and a button change how fast a clip is played, which opens nothing', async ({ page }) => {
  await openClip(page, await clipFrames(6, 96, 64));
  const speed = page.getByRole('button', { name: 'Speed' });
  await expect(speed).toHaveText('1×');
  for (let k = 0; k < 3; k++) await page.keyboard.press('j'); // there is none below
  await expect(speed).toHaveText('¼×');
  for (let k = 0; k < 3; k++) await page.keyboard.press('Shift+J');
  await expect(speed).toHaveText('2×');
  await speed.click();
  await expect(speed).toHaveAccessibleName('Speed ¼×');
  const said = await page.evaluateHandle(() => {
    const texts: string[] = [];
    const status = document.querySelector('#status')!;
    new MutationObserver(() => {
      if (document.querySelector('#play')?.getAttribute('aria-label') === 'Pause') texts.push(status.textContent);
    }).observe(status, { childList: true, characterData: true, subtree: true });
    return texts;
  });
  const release = await holdBack(page, 'f03.png');
  await page.getByRole('button', { name: 'Play', exact: true }).click();
  await expect(page.getByRole('slider', { name: 'Current frame' })).toHaveAttribute('aria-valuenow', '2');
  // Longer than a step may take until it is said to be under way.
  await page.evaluate(() => new Promise((resolve) => setTimeout(resolve, 200)));
  await release();
  await expect(page.locator('#caption')).toHaveText('Frame 5');
  await expect(page.getByRole('button', { name: 'Play', exact: true })).toBeVisible();
  expect(await said.jsonValue()).not.toContain('Opening…');
});

/** An MP4 that declares HEVC, as phones record it, without anything to decode. */
async function hevc(name: string): Promise<Upload> {
  const target = new BufferTarget();
  const output = new Output({ format: new Mp4OutputFormat(), target });
  const source = new EncodedVideoPacketSource('hevc');
  output.addVideoTrack(source);
  await output.start();
  // HEVCDecoderConfigurationRecord of the Main profile, level 3.1, without parameter sets.
  const description = Uint8Array.from([1, 1, 0x60, 0, 0, 0, 0x90, 0, 0, 0, 0, 0, 93, 0xf0, 0, 0xfc, 0xfd, 0xf8, 0xf8, 0, 0, 0x0f, 0]);
  const decoderConfig = { codec: 'hvc1.1.6.L93.90', codedWidth: 640, codedHeight: 360, description };
  for (let k = 0; k < 3; k++) await source.add(new EncodedPacket(new Uint8Array([0, 0, 0, 2, 0x26, 1]), 'key', k / 30, 1 / 30), { decoderConfig });
  await output.finalize();
  return { name, mimeType: 'video/mp4', buffer: Buffer.from(target.buffer!) };
}

test('a broken video and one that the browser cannot decode are rejected, and the clip stays', async ({ page }) => {
  await openClip(page, await clipFrames(2, 96, 64));
  await upload(page, [{ name: 'broken.mp4', mimeType: 'video/mp4', buffer: Buffer.from('no video at all') }]);
  await expect(page.locator('#notice-code')).toHaveText('unreadable-video');
  await upload(page, [await hevc("my 'clip'.mov")]);
  await expect(page.locator('#notice-code')).toHaveText('unsupported-codec');
  const notice = page.getByRole('alert');
  await expect(notice).toContainText("“my 'clip'.mov” is HEVC (H.265), which this browser cannot decode.");
  await expect(notice).toContainText("ffmpeg -i 'my '\\''clip'\\''.mov' -c:v libx264 -pix_fmt yuv420p 'my '\\''clip'\\''-h264.mp4'");
  await page.evaluate(() => Reflect.deleteProperty(globalThis, 'VideoDecoder'));
  await upload(page, [await video(page, 4, 'webm', 'vp8')]);
  await expect(notice).toContainText('“clip.webm” is VP8, which this browser cannot decode.');
  await expect(page.locator('#clip-name')).toHaveText('f00 and f01, 2 frames, 96 × 64');
  await expect(page.locator('#caption')).toHaveText('Frame 0');
  await done(page);
});
