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
  yolo: ['yolo', 'yolo, read by ultralytics'],
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

/** The drawn clip with squares for pixels, and each object of its own class. */
function large() {
  const side = 16;
  const [width, height] = [37 * side, 23 * side];
  const frames = drawnClip().map((labels) => Uint8Array.from({ length: width * height }, (_, at) => labels[Math.floor(at / width / side) * 37 + Math.floor((at % width) / side)]));
  return { frames, width, height, names: { 1: 'ring', 2: 'car', 4: 'Boot' } };
}

describe('clips', () => {
  const folder = mkdtempSync(join(tmpdir(), 'veronese-clips-'));
  after(() => rmSync(folder, { recursive: true, force: true }));
  const clips = [{ frames: drawnClip(), names: { 2: 'car', 4: 'car' } }, { frames: drawnClip() }, large(), ...Array.from({ length: 14 }, (_, seed) => wandering(seed))];

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
          const [count, shapes] = name.endsWith('ultralytics') ? [1, 17] : [clips.length, 80];
          assert.equal(report[name].clips, count);
          assert.ok(report[name].shapes >= shapes, `${report[name].shapes} shapes`);
        });
      }
    });
  }
});
