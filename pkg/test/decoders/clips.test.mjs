// The files of `veronese convert` for clips, read by the decoders of the tools it is meant for, and compared with the labels.

import assert from 'node:assert/strict';
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, describe, test } from 'node:test';
import { random } from '../../../scripts/lib/random.mjs';
import { clipFolder, drawnClip } from '../support/clip.mjs';
import { veronese } from '../support/program.mjs';
import { decoded, fiftyone, python, skip as withoutDecoders, withoutFiftyone } from '../support/python.mjs';

const FORMATS =
  'coco,coco-polygon,youtube-vis,cvat,cvat-polygon,cvat-video,mots,label-studio,label-studio-polygon,yolo,davis,masks';
const WAYS = {
  'coco-polygon': ['coco-polygon', 'coco, read by datumaro', 'coco-polygon, read by datumaro'],
  'cvat-video': ['cvat-video, polygons', 'cvat-video, boxes'],
};
/** Names of comparisons: some formats are written in two ways or read by two tools. */
const READ = FORMATS.split(',').flatMap((name) => WAYS[name] ?? name);

/** Discs and boxes that wander, leave and come back, with holes, noise and pixels without a label; and the names of some. */
function wandering(seed) {
  const next = random(seed);
  const whole = (from, to) => from + Math.floor(next() * (to - from + 1));
  const [width, height] = [whole(1, 40), whole(1, 40)];
  const things = Array.from({ length: whole(1, 6) }, () => ({
    label: next() < 0.15 ? 254 : whole(1, 12),
    at: [next() * width, next() * height],
    by: [next() * 8 - 4, next() * 8 - 4],
    size: [1 + next() * 12, 1 + next() * 12],
    round: next() < 0.5,
    holes: next() < 0.4 ? next() : 0,
    gone: whole(0, 7),
  }));
  const frames = Array.from({ length: whole(1, 6) }, (_, frame) => {
    const labels = Uint8Array.from({ length: width * height }, () => (next() < 0.05 ? 255 : 0));
    for (const { label, at, by, size, round, holes, gone } of things) {
      if (frame === gone) continue;
      labels.forEach((_, pixel) => {
        const u = ((pixel % width) - at[0] - frame * by[0]) / size[0];
        const v = (Math.floor(pixel / width) - at[1] - frame * by[1]) / size[1];
        if ((round ? u * u + v * v < 1 : Math.max(Math.abs(u), Math.abs(v)) < 1) && next() >= holes) labels[pixel] = label;
      });
    }
    return labels;
  });
  const names = Object.fromEntries(Array.from({ length: 13 }, (_, label) => [label, next() < 0.5 ? undefined : ['car', 'a person & "bag"', 'Boot'][whole(0, 2)]]));
  return { frames, width, height, names };
}

describe('clips', () => {
  const folder = mkdtempSync(join(tmpdir(), 'veronese-clips-'));
  after(() => rmSync(folder, { recursive: true, force: true }));
  const clips = [{ frames: drawnClip(), names: { 2: 'car', 4: 'car' } }, { frames: drawnClip() }, ...Array.from({ length: 15 }, (_, seed) => wandering(seed))];

  before(async () => {
    const cases = [];
    for (const [index, clip] of clips.entries()) {
      const [name, out] = [`clip-${index}`, `out-${index}`];
      const { frames, tracks } = clipFolder(join(folder, name), clip);
      for (const [place, ...args] of [[out, '--to', FORMATS], [`${out}/boxes`, '--to', 'cvat-video', '--shapes', 'box']]) {
        const { code, stderr } = await veronese(['convert', join(folder, name), '--out', join(folder, place), '--tolerance', '0', ...args]);
        assert.equal(code, 0, stderr);
      }
      cases.push({ name, out, tracks, labels: frames.map((labels) => Buffer.from(labels).toString('base64')) });
    }
    writeFileSync(join(folder, 'cases.json'), JSON.stringify(cases));
  });

  for (const [title, skip, script, program, names] of [
    ['decoded by the tools themselves', withoutDecoders, 'decode_clips.py', python, READ],
    ['imported by FiftyOne', withoutFiftyone, 'read_fiftyone.py', fiftyone, ['coco', 'coco-polygon', 'cvat-polygon', 'cvat-video', 'yolo', 'masks']],
  ]) {
    describe(title, { skip }, () => {
      let report = {};

      test('all formats', () => {
        report = decoded(script, folder, program);
        assert.deepEqual(Object.keys(report), names);
      });

      for (const name of names) {
        test(name, () => {
          assert.deepEqual(report[name]?.mistakes, []);
          assert.equal(report[name].clips, clips.length);
          assert.ok(report[name].shapes >= 80, `${report[name].shapes} shapes`);
        });
      }
    });
  }
});
