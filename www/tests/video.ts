//! Makes videos with a number in every frame.

import { readFile } from 'node:fs/promises';

import { type Page } from '@playwright/test';

import type { Upload } from './support.js';

export const WIDTH = 192;
export const HEIGHT = 128;
/** Duration of a frame, seconds: that of NTSC, which no time base of a container represents exactly. */
const FRAME = 1001 / 30_000;
export const BITS = 6;
/** Side of the square that shows one bit, pixels. */
export const BIT = 24;

/**
 * A video of `count` frames, encoded by the browser, each with its number as black and white squares over moving texture. `duration`: of a
 * frame, or of each, seconds.
 */
export async function video(page: Page, count: number, kind: 'webm' | 'mp4', codec: string, duration: number | readonly number[] = FRAME): Promise<Upload> {
  const key = JSON.stringify([count, kind, codec, duration]);
  if (!made.has(key)) made.set(key, await encoded(page, count, kind, codec, duration));
  return made.get(key)!;
}

/** Those that tests of this process have asked for. */
const made = new Map<string, Upload>();

async function encoded(page: Page, count: number, kind: 'webm' | 'mp4', codec: string, duration: number | readonly number[]): Promise<Upload> {
  const durations = typeof duration === 'number' ? Array<number>(count).fill(duration) : duration;
  const starts = durations.map((_, k) => durations.slice(0, k).reduce((sum, one) => sum + one, 0));
  const bundle = await readFile(new URL('../../node_modules/mediabunny/dist/bundles/mediabunny.mjs', import.meta.url));
  await page.route('**/maker/mediabunny.mjs', (route) => route.fulfill({ body: bundle, contentType: 'text/javascript' }));
  const base64 = await page.evaluate(
    async ([url, kind, codec, width, height, starts, durations, bits, bit]) => {
      const { BufferTarget, CanvasSource, Mp4OutputFormat, Output, WebMOutputFormat } = (await import(url)) as typeof import('mediabunny');
      const canvas = new OffscreenCanvas(width, height);
      const context = canvas.getContext('2d')!;
      const target = new BufferTarget();
      const output = new Output({ format: kind === 'webm' ? new WebMOutputFormat() : new Mp4OutputFormat(), target });
      const source = new CanvasSource(canvas, { codec: codec as 'vp8', bitrate: 2e6, keyFrameInterval: 0.5 });
      output.addVideoTrack(source);
      await output.start();
      for (const [k, start] of starts.entries()) {
        for (let y = 0; y < height; y += 8) {
          for (let x = 0; x < width; x += 8) {
            const grey = 128 + 70 * Math.sin(0.31 * (x + 2 * k) + 0.17 * y) + 40 * Math.cos(0.23 * y - 0.11 * x);
            context.fillStyle = `rgb(${grey} ${grey} ${grey})`;
            context.fillRect(x, y, 8, 8);
          }
        }
        for (let b = 0; b < bits; b++) {
          context.fillStyle = (k >> b) & 1 ? 'white' : 'black';
          context.fillRect(8 + b * bit, 8, bit, bit);
        }
        await source.add(start, durations[k]);
      }
      await output.finalize();
      let binary = '';
      for (const byte of new Uint8Array(target.buffer!)) binary += String.fromCharCode(byte);
      return btoa(binary);
    },
    [new URL('maker/mediabunny.mjs', page.url()).href, kind, codec, WIDTH, HEIGHT, starts, durations, BITS, BIT] as const,
  );
  return { name: `clip.${kind}`, mimeType: `video/${kind}`, buffer: Buffer.from(base64, 'base64') };
}
