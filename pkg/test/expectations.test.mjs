// What must hold of real frames, in WebAssembly: the scenes of tests/expectations, whose README.md says what their fields mean. The crate's
// tests ask the same of native code, and golden.test.mjs that the module gives the same bits: so this is for npm run soak.

import assert from 'node:assert/strict';
import { readFileSync, readdirSync } from 'node:fs';
import { describe, test } from 'node:test';
import { segmentClip, segmentPair } from 'veronese';
import { decodeImage } from 'veronese/codecs';
import { soaking } from './support/soak.mjs';

/** IoU of a mask with the outline of its object, unless the scene says otherwise. */
const OVERLAP = 0.85;
/** Share of the pixels in an outline of a clip that have the object's number. */
const COVERED = 0.97;
/** Pixels outside the outline of a clip that have the object's number, as a share of those inside: cars have shadows right below them. */
const OUTSIDE = 0.4;
/** Largest displacement of a background at rest, pixels. */
const REST = 0.1;

const root = new URL('../../', import.meta.url);
const fileAt = (path) => readFileSync(new URL(path, root));
const pictureAt = (path) => decodeImage(fileAt(path));

/** Whether a pixel's centre is inside an outline, by the even-odd rule. */
function contains(outline, pixel, width) {
  const [x, y] = [(pixel % width) + 0.5, Math.floor(pixel / width) + 0.5];
  const crossed = outline.filter(([ax, ay], k) => {
    const [bx, by] = outline.at(k - 1);
    return ay > y !== by > y && x < ax + ((y - ay) * (bx - ax)) / (by - ay);
  });
  return crossed.length % 2 === 1;
}

/** The group of a mask that overlaps most with an object, and their IoU. Group 0 does not count. */
function bestGroup({ outline, shadow = [] }, groups, width) {
  const counts = new Map();
  let pixels = 0;
  groups.forEach((group, p) => {
    const inside = contains(outline, p, width);
    if (!inside && contains(shadow, p, width)) return;
    const [all, common] = counts.get(group) ?? [0, 0];
    counts.set(group, [all + 1, common + Number(inside)]);
    pixels += Number(inside);
  });
  return [...counts].filter(([group]) => group !== 0).map(([group, [all, common]]) => [group, common / (pixels + all - common)])
    .reduce((best, one) => (one[1] > best[1] ? one : best), [0, 0]);
}

/** Largest displacement by a motion in a frame, pixels. */
function displacement([a, b, c, d, e, f], width, height) {
  const corners = [[0, 0], [width - 1, 0], [0, height - 1], [width - 1, height - 1]];
  return Math.max(...corners.map(([x, y]) => Math.hypot(a * x + b * y + c, d * x + e * y + f)));
}

async function checkPair({ frames, background, objects }, quality) {
  const [first, second] = await Promise.all(frames.map(pictureAt));
  const { width, height } = first;
  const { motions, labels } = await segmentPair(first, second, { quality });
  const moved = displacement(motions[0].matrix, width, height);
  assert.equal(moved < REST, background === 'at rest', `the background moves by ${moved.toFixed(2)} pixels`);
  const still = motions[0].group;
  const inParts = objects.some(({ parts }) => parts);
  const others = new Set(motions.map(({ group }) => group).filter((group) => group !== still));
  if (!inParts) assert.equal(others.size, objects.length);
  const groupOf = motions.map(({ group }) => (group === still ? 0 : inParts ? 1 : group + 1));
  const groups = Array.from(labels, (label) => groupOf[label]);
  const taken = new Set();
  for (const object of objects) {
    const [group, overlap] = bestGroup(object, groups, width);
    assert.ok(overlap >= (object.overlap ?? OVERLAP), `overlap of ${object.name}: ${overlap.toFixed(3)}`);
    assert.ok(!taken.has(group), `${object.name} is one with another object`);
    taken.add(group);
  }
}

async function checkClip({ folder, objects }, quality) {
  const paths = readdirSync(new URL(`${folder}/`, root)).sort().map((name) => `${folder}/${name}`);
  const seen = new Map();
  const clip = segmentClip({ length: paths.length, read: (index) => pictureAt(paths[index]) }, { quality });
  for await (const { index, labels, objects: found } of clip) {
    for (const { id } of found) seen.set(id, [...(seen.get(id) ?? []), index]);
    for (const [k, { name, outlines }] of objects.entries()) {
      const outline = outlines[index];
      if (outline === undefined) continue;
      const { width } = await pictureAt(paths[index]);
      const pixels = [...labels.keys()].filter((p) => contains(outline, p, width));
      const covered = pixels.filter((p) => labels[p] === k + 1).length / pixels.length;
      assert.ok(covered >= COVERED, `${covered.toFixed(3)} of ${name} in frame ${index}`);
      const all = labels.filter((label) => label === k + 1).length;
      const outside = all / pixels.length - covered;
      assert.ok(outside <= OUTSIDE, `${outside.toFixed(3)} around ${name} in frame ${index}`);
    }
  }
  assert.deepEqual([...seen.keys()].sort(), objects.map((_, k) => k + 1));
  for (const [k, { name, from }] of objects.entries()) {
    const frames = seen.get(k + 1);
    assert.ok(frames[0] <= from, `${name} is found from frame ${frames[0]} on`);
    assert.deepEqual(frames, Array.from({ length: paths.length - frames[0] }, (_, step) => frames[0] + step), name);
  }
}

for (const file of readdirSync(new URL('tests/expectations/', root)).filter((name) => name.endsWith('.json'))) {
  const expected = JSON.parse(fileAt(`tests/expectations/${file}`));
  describe(expected.scene, { skip: !soaking && 'npm run soak' }, () => {
    // The page's tests have the clip with *best*, and the crate's tests both.
    for (const quality of expected.folder ? ['fast'] : ['fast', 'best']) test(quality, () => (expected.folder ? checkClip : checkPair)(expected, quality));
  });
}
