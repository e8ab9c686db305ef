// Frames scaled down on request: calls, workers, files and the program; larger ones than can be processed are an error that names the option.

import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { test } from 'node:test';
import { decode } from 'fast-png';
import { openClip, Segmenter, segmentPair, segmentStream } from 'veronese';
import { decodeImage } from 'veronese/codecs';
import { frame, pair, ppm } from './support/frames.mjs';
import { temporaryFolder, veronese } from './support/program.mjs';
import { failure, timeless } from './support/shapes.mjs';

const FAST = { quality: 'fast' };

/** Each pixel is the mean of a square of four. */
function halved({ data, width, height }) {
  const [w, h] = [width / 2, height / 2];
  const half = new Uint8Array(4 * w * h).map((_, at) => {
    const [x, y] = [2 * (Math.floor(at / 4) % w), 2 * Math.floor(at / 4 / w)];
    const corners = [[0, 0], [1, 0], [0, 1], [1, 1]].map(([right, down]) => data[4 * ((y + down) * width + x + right) + (at % 4)]);
    return Math.round(corners.reduce((sum, value) => sum + value) / 4);
  });
  return { data: half, width: w, height: h };
}

/** Wider than a frame may be: smooth stripes that move. */
function wide(shift, width = 4200, height = 34) {
  const data = new Uint8Array(4 * width * height).map((_, at) => {
    const [x, y] = [Math.floor(at / 4) % width, Math.floor(at / 4 / width)];
    return at % 4 === 3 ? 255 : 128 + 90 * Math.sin((x - shift) / 60) * Math.cos(y / 9);
  });
  return { data, width, height };
}

async function clipOf(clip) {
  const all = [];
  for await (const each of clip) all.push(each);
  return all;
}

test('results are those of the scaled frames, in workers too, and say their size', async (t) => {
  const large = pair({ width: 128, height: 96, square: [6, 4] });
  const small = large.map(halved);
  const expected = timeless(await segmentPair(...small, FAST));
  assert.deepEqual([expected.width, expected.height], [64, 48]);
  const segmenter = new Segmenter();
  t.after(() => segmenter.close());
  assert.deepEqual(timeless(await segmentPair(...large, { ...FAST, maxSize: 64 })), expected);
  assert.deepEqual(timeless(await segmenter.segmentPair(...large, { ...FAST, maxSize: 64 })), expected);
  assert.deepEqual(timeless(await segmentPair(...small, { ...FAST, maxSize: 64 })), expected, 'what is not larger stays');
  const frames = Array.from({ length: 3 }, (_, k) => frame(k / 2, { width: 128, height: 96 }));
  const clipIn = async (place, given, options) => {
    const clip = await place(given, options);
    return clipOf(clip.segment(FAST));
  };
  const clip = await clipIn(openClip, frames.map(halved));
  assert.deepEqual(await clipIn(openClip, frames, { maxSize: 64 }), clip);
  assert.deepEqual(await clipIn((...given) => segmenter.openClip(...given), frames, { maxSize: 64 }), clip);
  assert.deepEqual(await clipOf(segmenter.segmentStream(frames, { ...FAST, maxSize: 64 })), await clipOf(segmentStream(frames.map(halved), FAST)));
});

test('any factor: a plane stays one, and its mean does', async () => {
  const ramp = { width: 50, height: 20, data: new Uint8Array(4 * 50 * 20).map((_, at) => (at % 4 === 3 ? 255 : 4 * (Math.floor(at / 4) % 50))) };
  const { data, width, height } = await decodeImage(ppm(ramp), { maxSize: 30 });
  assert.deepEqual([width, height], [30, 12]);
  for (let x = 0; x < width; x++) assert.ok(Math.abs(data[4 * x] - (4 * (((x + 0.5) * 50) / 30 - 0.5))) <= 0.7, `column ${x}`);
  for (let y = 1; y < height; y++) assert.deepEqual(data.subarray(4 * y * width, 4 * (y + 1) * width), data.subarray(0, 4 * width));
});

test('sides above 4096 pixels are an error that names the option, and with it they are not', async (t) => {
  const { file, path } = temporaryFolder(t);
  const frames = [wide(0), wide(6)];
  const direct = await failure(segmentPair(...frames));
  assert.deepEqual([direct.code, direct.message], ['frame-size-unsupported', "a frame of 4200×34 pixels cannot be processed: both sides must be between 16 and 4096 pixels; option 'maxSize' scales larger ones down"]);
  const found = await segmentPair(...frames, { ...FAST, maxSize: 2100 });
  assert.deepEqual([found.width, found.height], [2100, 17]);
  assert.ok(Math.abs(found.motions[0].matrix[2] - 3) < 0.5, 'pixels are those of the scaled frame');
  const flat = await failure(segmentPair(...frames, { maxSize: 1000 }));
  assert.match(flat.message, /^a frame of 4200×34 pixels .* between 16 and 4096 pixels$/, 'eight rows would be left');
  for (const maxSize of [15, 4097, 20.5, '64', null]) assert.equal((await failure(segmentPair(...frames, { maxSize }))).code, 'invalid-option');

  const [first, second] = frames.map((pixels, k) => file(`${k}.ppm`, ppm(pixels)));
  assert.match((await failure(segmentPair(first, second))).message, /0\.ppm': .*4200×34.*; option 'maxSize' scales larger ones down$/);
  assert.equal((await segmentPair(first, second, { ...FAST, maxSize: 2100 })).width, 2100);
  const refused = await veronese(['pair', first, second]);
  assert.equal(refused.code, 1);
  assert.match(refused.stderr, /^veronese: error: frame-size-unsupported: [^\n]*0\.ppm: [^\n]*; '--max-size 4096' scales it down\n$/);
  for (const [command, labels] of [['pair', 'labels.png'], ['clip', 'labels/0.png'], ['batch', '000000-0/labels.png']]) {
    const { code, stderr } = await veronese([command, first, second, '--quality', 'fast', '--max-size', '2100', '--out', path(command), '--overlay']);
    assert.equal(code, 0, stderr);
    const { width, height } = decode(readFileSync(path(command, labels)));
    assert.deepEqual([width, height], [2100, 17], command);
  }
  assert.match((await veronese(['pair', first, second, '--max-size', '5000'])).stderr, /invalid-option: option '--max-size' must be a whole number from 16 to 4096/);
});
