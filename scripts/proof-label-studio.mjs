// npm run proof:label-studio: runs Label Studio with our backend, and checks the masks and boxes that it stores and shows.

import assert from 'node:assert/strict';
import { mkdirSync, readFileSync, rmSync } from 'node:fs';
import { createServer } from 'node:net';
import { join, relative } from 'node:path';

import { buildPackage } from './lib/builds.mjs';
import { decodedByStudio, picture, predictions, prepareLabelStudio, serveFiles, startLabelStudio, videoPredictions } from './lib/label-studio.mjs';
import { SERVERS, prepareNpmPackages } from './lib/npm-packages.mjs';
import { prepare } from './lib/prepare.mjs';
import { root } from './lib/project.mjs';
import { Stop, command, must } from './lib/run.mjs';

const OUT = join(root, 'out', 'proof', 'label-studio');
const FRAMES = ['first.png', 'second.png'].map((name) => join(root, 'www/public/samples/intel-two-cars', name));
const CLIP = join(root, 'www/public/samples/passing-cars/frames/%02d.webp');
/** Of the clip the first frame, which has both cars, how many there are, and how many in a second. */
const [START, LENGTH, RATE] = [20, 24, 25];

await command(async () => {
  const { chromium } = await prepare({ browser: true });
  if (chromium.problem) throw new Stop(chromium.problem);
  await buildPackage();
  await prepareNpmPackages(SERVERS);
  await prepareLabelStudio();
  rmSync(OUT, { recursive: true, force: true });
  const video = await madeVideo();
  console.log('Starting Label Studio with a new database (a minute or more) …');
  const studio = await startLabelStudio(join(OUT, 'data'), await freePort());
  process.once('exit', studio.stop);
  const { startBackend } = await import('../examples/hosts/label-studio.mjs');
  const files = await serveFiles([...FRAMES, video]);
  const [address, frames] = [files.addresses[2], files.addresses.slice(0, 2)];
  // Label Studio sends the token for uploaded files.
  const backend = await startBackend({ jobs: 1, studio: studio.address, allow: [files.origin] });
  try {
    const held = await predictions(studio, backend.address, frames, FRAMES);
    await checkMasks(held.found);
    const file = join(OUT, 'task.png');
    const { text } = await picture(studio, held, chromium.path, file);
    for (const label of ['moving-1', 'moving-2']) assert.ok(text.includes(label), `the page does not show ${label}`);
    console.log(`Label Studio shows them: ${relative(root, file)}`);

    const boxes = await videoPredictions(studio, backend.address, address, RATE);
    const size = await checkBoxes(boxes.found[0], video);
    const screen = join(OUT, 'video.png');
    const { rectangles } = await picture(studio, boxes, chromium.path, screen);
    checkShown(rectangles, boxes.found[0], size);
    console.log(`Label Studio shows them where they are: ${relative(root, screen)}`);
  } finally {
    backend.close();
    files.close();
    studio.stop();
  }
});

/** Checks pixel by pixel that the stored masks, read by Label Studio's own decoder, equal those of a direct call. */
async function checkMasks(found) {
  const { segmentPair } = await import('../pkg/dist/node.js');
  const { decodeImage } = await import('../pkg/dist/codecs.js');
  const [first, second] = await Promise.all(FRAMES.map((path) => decodeImage(readFileSync(path))));
  const { labels, count, width, height } = await segmentPair(first, second);
  assert.deepEqual(found.map(({ length }) => length), [1, 1], 'one prediction for each task');
  for (const [{ result, score, model_version: version }] of found) {
    assert.equal(result.length, Math.min(count - 1, 3));
    for (const [index, { value, original_width: w, original_height: h }] of result.entries()) {
      assert.deepEqual([w, h], [width, height]);
      const pixels = await decodedByStudio(value.rle);
      assert.deepEqual(pixels, Array.from(labels, (label) => (label === index + 1 ? 255 : 0)), `mask ${index + 1}`);
    }
    console.log(`Label Studio holds ${result.length} masks of ${version}, score ${score.toFixed(3)}. Every pixel equals that of a direct call.`);
  }
}

/** Frames of the page's sample, as browsers play them. */
async function madeVideo() {
  mkdirSync(OUT, { recursive: true });
  const file = join(OUT, 'street.webm');
  const input = ['-v', 'error', '-framerate', String(RATE), '-start_number', String(START), '-i', CLIP, '-frames:v', String(LENGTH)];
  const sentence = 'The video could not be made: that takes the program ffmpeg with VP9.';
  await must(sentence, 'ffmpeg', [...input, '-c:v', 'libvpx-vp9', '-b:v', '4M', '-g', '1', '-pix_fmt', 'yuv420p', file]);
  return file;
}

/** Checks that the stored boxes are around the objects that `veronese clip` finds in the same file; returns the size of its frames. */
async function checkBoxes([{ result, score, model_version: version }], video) {
  const out = join(OUT, 'clip');
  const program = join(root, 'pkg/bin/veronese.js');
  await must('The video could not be segmented.', process.execPath, [program, 'clip', video, '--out', out, '--quality', 'fast'], { output: 'collect' });
  const { width, height, objects } = JSON.parse(readFileSync(join(out, 'tracks.json'), 'utf8'));
  assert.ok(objects.length > 0, 'nothing moves in the clip');
  const near = (value) => Math.round(value * 1e6) / 1e6;
  const stored = result.map(({ value }) => value.sequence.map(({ frame, x, y, width, height }) => [frame, ...[x, y, width, height].map(near)]));
  const expected = objects.map(({ frames }) =>
    frames.map(({ frame, bbox: [x, y, w, h] }) => [frame + 1, ...[x / width, y / height, w / width, h / height].map((share) => near(100 * share))]),
  );
  assert.deepEqual(stored, expected);
  assert.ok(result.every(({ type, value }) => type === 'videorectangle' && value.framesCount === LENGTH));
  console.log(`Label Studio holds boxes of ${result.length} objects of ${version}, score ${score.toFixed(3)}: those of the labels, in every frame.`);
  return { width, height };
}

/** Checks that the rectangles that the page draws over the first frame, in pixels of the video, are the stored boxes. */
function checkShown(rectangles, [{ result }], { width, height }) {
  const stored = result.map(({ value }) => value.sequence[0]).filter(({ frame }) => frame === 1);
  assert.ok(stored.length > 1, 'both cars are in the first frame');
  const rounded = (boxes) => boxes.map((sides) => sides.map(Math.round)).sort((one, other) => one[0] - other[0]);
  const expected = stored.map((box) => [box.x * width, box.y * height, box.width * width, box.height * height].map((share) => share / 100));
  assert.deepEqual(rounded(rectangles), rounded(expected));
}

function freePort() {
  return new Promise((resolve) => {
    const server = createServer().listen(0, '127.0.0.1', () => {
      const { port } = server.address();
      server.close(() => resolve(port));
    });
  });
}
