import assert from 'node:assert/strict';
import { mkdirSync, readdirSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { describe, test } from 'node:test';
import { decode } from 'fast-png';
import { groupLabels } from 'veronese';
import { encode } from 'veronese/formats';
import { FORMATS } from '../build/formats/encode.js';
import { pair, png } from './support/frames.mjs';
import { converted, entries, notConverted, temporaryFolder, veronese } from './support/program.mjs';

const EVERY = Object.keys(FORMATS).join(',');

/** A folder as `pair --out` leaves it. */
async function segmented(t, ...options) {
  const folder = temporaryFolder(t);
  const [first, second] = pair().map((frame, k) => folder.file(`${k}.png`, png(frame)));
  const out = folder.path('out');
  const { code, stderr } = await veronese(['pair', first, second, '--out', out, ...options]);
  assert.equal(code, 0, stderr);
  const result = JSON.parse(readFileSync(join(out, 'result.json'), 'utf8'));
  const labels = Uint8Array.from(decode(readFileSync(join(out, 'labels.png'))).data);
  return { folder, out, result, labels };
}

describe('veronese convert', () => {
  test('writes what the encoders give, beside the result, and leaves the rest alone', async (t) => {
    const { out, result, labels } = await segmented(t);
    const before = readdirSync(out);
    const { version, folder, files } = await converted(out, '--to', 'coco,cvat,davis', '--image', 'a.png');
    assert.deepEqual({ version, folder, files }, { version: 1, folder: out, files: ['coco.json', 'cvat.xml', 'davis.png'] });
    assert.deepEqual(readdirSync(out).sort(), [...before, ...files].sort());
    const { width, height, motions } = result;
    const objects = motions.map(({ label }) => label).filter((label) => label > 0);
    assert.ok(objects.length > 0);
    for (const [k, format] of ['coco', 'cvat', 'davis'].entries()) {
      const [{ name, content }] = await encode(format, { labels, width, height, motions, image: 'a.png' }, { labels: objects });
      assert.equal(name, files[k]);
      assert.deepEqual(readFileSync(join(out, name)), Buffer.from(content));
    }
  });

  test('the background is an annotation only with --background', async (t) => {
    const { out, result } = await segmented(t);
    const found = async (...args) => {
      await converted(out, '--to', 'coco,coco-polygon,yolo', ...args);
      const read = (name) => readFileSync(join(out, name), 'utf8');
      const ids = ['coco.json', 'coco-polygon.json'].map((name) => JSON.parse(read(name)).annotations.map(({ category_id }) => category_id - 1));
      assert.deepEqual(ids[0], ids[1]);
      assert.equal(read('yolo.txt').trim().split('\n').length, ids[0].length);
      return ids[0];
    };
    const all = result.motions.map(({ label }) => label);
    assert.deepEqual(await found(), all.filter((label) => label > 0));
    assert.deepEqual(await found('--background'), all);
  });

  test('--grouped converts groups, also where labels.png shows them already', async (t) => {
    const { folder, out, result, labels } = await segmented(t);
    const groups = groupLabels({ labels, motions: result.motions });
    const again = await segmented(t, '--grouped');
    for (const [source, name] of [[out, 'a'], [again.out, 'b']]) {
      await converted(source, '--to', 'davis,coco', '--grouped', '--background', '--out', folder.path(name));
      assert.deepEqual(Uint8Array.from(decode(readFileSync(folder.path(name, 'davis.png'))).data), groups);
      const { categories, annotations } = JSON.parse(readFileSync(folder.path(name, 'coco.json'), 'utf8'));
      assert.equal(categories[0].name, 'group-0');
      for (const { category_id, area } of annotations) assert.equal(area, groups.filter((group) => group === category_id - 1).length);
    }
  });

  test('knows every format, writes one twice named only once', async (t) => {
    const { folder, out } = await segmented(t, '--mark-unknown');
    const { files } = await converted(out, '--to', `${EVERY},coco`, '--out', folder.path('all'));
    assert.equal(new Set(files).size, files.length);
    assert.equal(files.length, EVERY.split(',').length + 1, 'YOLO has two files');
    assert.deepEqual(entries(folder.path('all')), files.map((name) => name.replace('/', '')).sort());
  });

  test('says what is wrong and writes nothing', async (t) => {
    const { folder, out, result } = await segmented(t);
    const refused = (args, code, sentence) => notConverted(folder.path(), args, code, sentence, ['usage', 'wrong-usage', 'invalid-option'].includes(code) ? 2 : 1);
    await refused([out], 'usage', /needs '--to FORMATS'/);
    await refused(['--to', 'coco'], 'usage', /takes one folder/);
    await refused([out, '--to', 'coco', '--overlay'], 'wrong-usage', /has no option '--overlay'/);
    await refused([out, '--to', 'coco,xyz'], 'invalid-option', /there is no format 'xyz'/);
    await refused([out, '--to', 'toString'], 'invalid-option', /toString/);
    await refused([folder.path(), '--to', 'coco'], 'file-not-found', /labels\.png/);
    await refused([out, '--to', 'coco', '--out', join(out, 'result.json')], 'write-failed', /it is a file/);
    const bad = (name, content) => {
      const path = folder.path(name.replace(/\W/g, '-'));
      mkdirSync(path);
      writeFileSync(join(path, 'labels.png'), readFileSync(join(out, 'labels.png')));
      writeFileSync(join(path, 'result.json'), content);
      return path;
    };
    await refused([bad('text', 'no'), '--to', 'coco'], 'invalid-json', /is not JSON/);
    await refused([bad('null', 'null'), '--to', 'coco'], 'invalid-input', /not a result/);
    await refused([bad('other', '{"width": 3}'), '--to', 'coco'], 'invalid-input', /not a result/);
    await refused([bad('size', JSON.stringify({ ...result, width: 65 })), '--to', 'coco'], 'frame-size-mismatch', /64×48 and 65×48/);
    for (const changed of [{ bbox: undefined }, { bbox: [0, 0, 1] }, { group: 300 }, { label: 256 }, { share: null }, { residual: 'x' }]) {
      const [first, ...rest] = result.motions;
      const damaged = bad(JSON.stringify(changed), JSON.stringify({ ...result, motions: [{ ...first, ...changed }, ...rest.map((motion) => ({ ...motion, group: 0 }))] }));
      await refused([damaged, '--to', 'coco', '--grouped'], 'invalid-input', /not a result/);
    }
    const motions = result.motions.map((motion) => ({ ...motion, pixels: motion.pixels + 1 }));
    await refused([bad('foreign', JSON.stringify({ ...result, motions })), '--to', 'coco'], 'invalid-input', /not of the same result/);
    const photo = bad('photo', JSON.stringify(result));
    writeFileSync(join(photo, 'labels.png'), png(pair()[0]));
    await refused([photo, '--to', 'coco'], 'invalid-input', /no labels: it is not an 8-bit indexed PNG/);
  });
});
