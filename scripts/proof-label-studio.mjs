// npm run proof:label-studio: runs Label Studio with our backend, and checks the masks that it stores and shows.

import assert from 'node:assert/strict';
import { readFileSync, rmSync } from 'node:fs';
import { createServer } from 'node:net';
import { join, relative } from 'node:path';

import { buildModules, buildPackage } from './lib/builds.mjs';
import { decodedByStudio, picture, predictions, prepareLabelStudio, serveFrames, startLabelStudio } from './lib/label-studio.mjs';
import { SERVERS, prepareNpmPackages } from './lib/npm-packages.mjs';
import { prepare } from './lib/prepare.mjs';
import { root } from './lib/project.mjs';
import { Stop, command } from './lib/run.mjs';

const OUT = join(root, 'out', 'proof', 'label-studio');
const FRAMES = ['first.png', 'second.png'].map((name) => join(root, 'www/public/samples/intel-two-cars', name));

await command(async () => {
  const { chromium } = await prepare({ browser: true });
  if (chromium.problem) throw new Stop(chromium.problem);
  await buildModules();
  await buildPackage();
  await prepareNpmPackages(SERVERS);
  await prepareLabelStudio();
  rmSync(OUT, { recursive: true, force: true });
  console.log('Starting Label Studio with a new database (a minute or more) …');
  const studio = await startLabelStudio(join(OUT, 'data'), await freePort());
  process.once('exit', studio.stop);
  const { startBackend } = await import('../examples/hosts/label-studio.mjs');
  const frames = await serveFrames(FRAMES);
  // Label Studio sends the token for uploaded files.
  const backend = await startBackend({ jobs: 1, studio: studio.address, allow: [frames.origin] });
  try {
    const held = await predictions(studio, backend.address, frames.addresses, FRAMES);
    await checkMasks(held.found);
    const file = join(OUT, 'task.png');
    const text = await picture(studio, held, chromium.path, file);
    for (const label of ['moving-1', 'moving-2']) assert.ok(text.includes(label), `the page does not show ${label}`);
    console.log(`Label Studio shows them: ${relative(root, file)}`);
  } finally {
    backend.close();
    frames.close();
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

function freePort() {
  return new Promise((resolve) => {
    const server = createServer().listen(0, '127.0.0.1', () => {
      const { port } = server.address();
      server.close(() => resolve(port));
    });
  });
}
