// Annotations of a whole clip, directly and in workers: given masks, where corrections spread, locked objects, frames as they change.

import assert from 'node:assert/strict';
import { after, describe, test } from 'node:test';
import { davisPalette, segmentClip, Segmenter, SegmenterPool, VeroneseError } from 'veronese';
import { encodePng } from 'veronese/codecs';
import { davisPng } from '../build/formats/pictures.js';
import { rleOf as runs } from './support/masks.mjs';
import { checkedOptions } from '../build/calls/clip/options.js';
import { frame } from './support/frames.mjs';
import { all, failure } from './support/shapes.mjs';
import { cases } from './support/soak.mjs';

const COUNT = 7;
const SIZE = { width: 96, height: 72 };
const PIXELS = SIZE.width * SIZE.height;
const ALL = Array.from({ length: COUNT }, (_, index) => index);

const list = ALL.map((index) => frame(index / 2, SIZE));
const source = { length: COUNT, read: (index) => list[index] };

/** Where the square is in a frame, as frames.mjs draws it. */
const square = (index) => {
  const [left, top] = [24 + index, 18 + index / 2];
  return Array.from({ length: PIXELS }, (_, p) => {
    const [x, y] = [p % SIZE.width, Math.floor(p / SIZE.width)];
    return x >= left && x < left + 36 && y >= top && y < top + 36;
  });
};
const labelled = (index, inside, outside = 0) => Uint8Array.from(square(index), (isInside) => (isInside ? inside : outside));
/** A corner of the ground, in which nothing moves, unlabelled around it. */
const corner = (label, outside = 255) =>
  Uint8Array.from({ length: PIXELS }, (_, p) => (p % SIZE.width >= 78 && p >= 58 * SIZE.width ? label : outside));

/** Intersection over union of an object and the square. */
function iou({ labels, index }, id) {
  const truth = square(index);
  const both = truth.filter((isInside, p) => isInside && labels[p] === id).length;
  return both / truth.filter((isInside, p) => isInside || labels[p] === id).length;
}

const run = (segment, options, from = source) => all(segment(from, { quality: 'fast', ...options }));
const idsOf = (frames) => frames.map(({ objects }) => objects.map(({ id }) => id));
/** Pixels of an object that differ. */
const changedOf = (before, after, id) =>
  before.reduce((sum, { labels }, index) => sum + labels.filter((label, p) => (label === id) !== (after[index].labels[p] === id)).length, 0);

const clip = segmentClip(source, { quality: 'fast' });
const whole = await all(clip);
const state = await clip.state();

/** All ways to segment a clip. */
const [segmenter, pool] = [new Segmenter(), new SegmenterPool({ jobs: 2 })];
after(() => {
  segmenter.close();
  pool.close();
});
const WAYS = cases(
  [['directly', segmentClip], ['in a pool', (...args) => pool.segmentClip(...args)]],
  [['in a worker', (...args) => segmenter.segmentClip(...args)]],
);

test('the square is found by itself', () => {
  assert.deepEqual(idsOf(whole), ALL.map(() => [1]));
});

test('what is merged into a locked object is locked with it, and what into a named one is named', () => {
  const found = (options) => {
    const { locked, edits: { named } } = checkedOptions(list, options);
    return { locked: locked && [...locked], named: named && [...named] };
  };
  const merge = [[2, 5], [6, 7]];
  assert.deepEqual(found({ edits: { merge, names: { 2: 'car' } } }), { locked: undefined, named: [2, 5] });
  assert.deepEqual(found({ locked: [3], edits: { merge, locked: [6, 3] } }), { locked: [3, 6, 7], named: undefined });
  assert.deepEqual(found({ edits: { merge, locked: [2] } }), { locked: [2, 5], named: undefined });
  assert.deepEqual(found({ locked: [], edits: { names: {} } }), { locked: [], named: [] });
  assert.deepEqual(found({ edits: {} }), { locked: undefined, named: undefined });
});

for (const [way, segment] of WAYS) {
  describe(`what is said of a clip ${way}`, () => {
    test('a given mask keeps its number and its pixels, and the object is followed', async () => {
      const frames = await run(segment, { masks: [{ frame: 1, labels: labelled(1, 7) }] });
      assert.deepEqual(frames[1].labels, labelled(1, 7));
      for (const one of frames) {
        assert.deepEqual(one.objects.map(({ id }) => id), [7], `frame ${one.index}: it took over what was found`);
        assert.ok(iou(one, 7) > 0.85, `frame ${one.index}: ${iou(one, 7)}`);
      }
      // From a state it is the same, and given again it changes nothing.
      const again = segment(source, { state, masks: [{ frame: 1, labels: labelled(1, 7) }] });
      assert.deepEqual(await all(again), frames);
      assert.deepEqual(await run(segment, { state: await again.state(), masks: [{ frame: 1, labels: labelled(1, 7) }] }), frames);
    });

    test('the arrays of masks stay the caller\'s', async () => {
      const mask = labelled(3, 7);
      const clip = segment(source, { state, masks: [{ frame: 3, labels: mask }] });
      const first = clip.next();
      mask.fill(0);
      assert.deepEqual([(await first).value, ...(await all(clip))], await run(segment, { state, masks: [{ frame: 3, labels: labelled(3, 7) }] }));
    });

    test('onChange tells of frames as they change, the one that is spoken of first', async () => {
      const told = [];
      let late;
      const onChange = async (index, segmented) => {
        const frame = await segmented();
        assert.equal(frame.index, index);
        told.push({ index, frame, given: given.length });
        late = segmented;
      };
      const given = [];
      const options = { state, corrections: [{ frame: 3, labels: labelled(3, 9) }], changesOnly: true };
      for await (const frame of segment(source, { ...options, onChange })) given.push(frame);
      const indices = told.map(({ index }) => index);
      assert.equal(indices[0], 3);
      assert.deepEqual(told[0].frame.labels, labelled(3, 9), 'it is exact at once');
      assert.deepEqual([...indices].sort((a, b) => a - b), given.map(({ index }) => index), 'each once, and the clip in order');
      assert.ok(told.every(({ given }) => given === 0), 'before the first frame is returned');
      const after = indices.filter((index) => index > 3);
      const before = indices.filter((index) => index < 3);
      assert.deepEqual([after, before], [[4, 5, 6], [2, 1, 0]], 'nearest first on either side');
      assert.deepEqual(given, await run(segment, options), 'it changes nothing');
      assert.equal((await failure(late())).code, 'invalid-input');

      const removed = [];
      await run(segment, { state, edits: { delete: [1] }, onChange: (index) => void removed.push(index) });
      assert.deepEqual(removed, ALL, 'edits change frames too');
      const mine = new Error('mine');
      const throwing = [() => { throw mine; }, async () => { throw mine; }];
      for (const onChange of throwing) assert.equal(await failure(run(segment, { ...options, onChange })), mine);
    });

    test('is cancelled while a correction spreads; what was given is as it was', async () => {
      const kept = state.slice();
      const options = { state, masks: [{ frame: 1, labels: labelled(1, 7) }], corrections: [{ frame: 3, labels: labelled(3, 9) }] };
      const expected = await run(segment, options);
      for (const wait of [() => undefined, () => new Promise(() => {})]) {
        const controller = new AbortController();
        const told = [];
        const onChange = (index) => {
          told.push(index);
          if (told.length === 2) controller.abort();
          return told.length === 2 ? wait() : undefined;
        };
        const error = await failure(run(segment, { ...options, onChange, signal: controller.signal }));
        assert.deepEqual([error.code, told.length], ['cancelled', 2]);
        assert.deepEqual(state, kept);
        assert.deepEqual(await run(segment, options), expected, 'its worker is free');
      }
    });
  });
}

// Of this the way changes nothing.
for (const [way, segment] of cases(WAYS.slice(0, 1), WAYS.slice(1))) {
  describe(`what is said of a clip ${way}`, () => {
    test('masks have many forms', async () => {
      const labels = labelled(3, 7);
      const { width, height } = SIZE;
      const picture = (colourOf) => ({ ...SIZE, data: Uint8ClampedArray.from([...labels].flatMap((label) => [...colourOf(label), 255])) });
      // What they say of their own frame.
      const alone = { state, changesOnly: true };
      const own = { frame: 3, propagate: 'none' };
      const said = (mask) => run(segment, { ...alone, masks: [{ ...own, ...mask }] });
      const expected = await said({ labels });
      assert.deepEqual(expected.map(({ index }) => index), [3]);
      assert.deepEqual(await said({ labels: picture((label) => [label, label, label]) }), expected, 'grey');
      const coloured = labelled(3, 5);
      const davis = { ...SIZE, data: Uint8ClampedArray.from([...coloured].flatMap((label) => [...davisPalette()[label], 255])) };
      assert.deepEqual(await said({ labels: davis }), await said({ labels: coloured }), 'in colours');
      const mask = labels.map(Number);
      assert.deepEqual(await said({ id: 7, rle: runs(mask, width, height) }), expected, 'compressed run lengths');
      assert.deepEqual(await said({ id: 7, rle: runs(mask, width, height, { compressed: false }) }), expected, 'run lengths');
      assert.deepEqual(await said({ png: davisPng(labels, width, height) }), expected, 'an indexed PNG');
      assert.deepEqual(await said({ png: await encodePng(width, height, labels) }), expected, 'a grey PNG');
      // Where a picture is transparent, it is unlabelled.
      const open = { ...SIZE, data: Uint8ClampedArray.from([...labels].flatMap((label) => (label ? [7, 7, 7, 255] : [1, 2, 3, 0]))) };
      assert.deepEqual(await said({ labels: open }), await said({ labels: labelled(3, 7, 255) }), 'transparent');
      // Two objects of one frame.
      const halves = labels.map((label, p) => (label > 0 && p % width < 45 ? 9 : label));
      const rleOf = (id) => runs(halves.map((label) => Number(label === id)), width, height);
      const expectedHalves = await said({ labels: halves });
      const masks = [{ ...own, id: 7, rle: rleOf(7) }, { ...own, id: 9, rle: rleOf(9) }];
      assert.deepEqual(await run(segment, { ...alone, masks }), expectedHalves);
      const over = [{ ...own, labels }, { ...own, id: 9, rle: rleOf(9) }];
      assert.deepEqual(await run(segment, { ...alone, masks: over }), expectedHalves, 'one over the other');
    });

    test('locked and named objects do not change by a pixel when another is corrected', async () => {
      // A stroke across half of the square.
      const stroke = labelled(3, 1).map((label, p) => (label > 0 && p % SIZE.width < 45 ? 9 : 255));
      const corrections = [{ frame: 3, labels: stroke }];
      const loose = await run(segment, { state, corrections });
      assert.ok(changedOf(whole, loose, 1) > 0, 'it changes otherwise');
      const edits = [{ locked: [1] }, { names: { 1: 'square' } }];
      for (const options of [{ locked: [1] }, ...edits.map((edits) => ({ edits }))]) {
        const locking = segment(source, { state, corrections, ...options });
        const frames = await all(locking);
        assert.equal(changedOf(whole, frames, 1), 0, JSON.stringify(options));
        // A state keeps it.
        const later = await run(segment, { state: await locking.state(), corrections: [{ frame: 4, labels: stroke }] });
        assert.equal(changedOf(whole, later, 1), 0);
      }
      // An annotated object needs no lock.
      const said = segment(source, { state, masks: [{ frame: 1, labels: labelled(1, 7) }] });
      const before = await all(said);
      const after = await run(segment, { state: await said.state(), corrections: [{ frame: 3, labels: corner(9) }] });
      assert.equal(changedOf(before, after, 7), 0);
    });

    test('refuses what it cannot use before any pair is solved', async () => {
      const mask = (rest) => ({ masks: [{ frame: 0, ...rest }] });
      const colours = await encodePng(4, 3, new Uint8Array(36));
      const soft = Uint8Array.from({ length: PIXELS }, (_, p) => Math.min(255, Math.max(0, 40 * (30 - Math.hypot((p % 96) - 48, Math.floor(p / 96) - 36)))));
      const rle = { size: [72, 96], counts: [PIXELS] };
      const pixel = (...rgba) => ({ ...SIZE, data: new Uint8ClampedArray(4 * PIXELS).fill(255).map((value, at) => (at < 4 ? rgba[at] : value)) });
      const cases = [
        [{ masks: {} }, /'masks': must be a list of \{ frame, labels \}, \{ frame, png \} or \{ frame, id, rle \}/],
        [mask({ frame: COUNT, labels: labelled(0, 1) }), /'masks': number 0 must have a frame from 0 to 6/],
        [mask({}), /'masks': number 0 must have labels, a Uint8Array/],
        [mask({ labels: new Uint8Array(12) }), /'masks': that of frame 0 has 12 labels, a frame has 96×72 pixels/],
        [mask({ labels: { data: new Uint8Array(4 * PIXELS), width: 72, height: 96 } }), /'masks': that of frame 0 has 6912 labels, a frame has 96×72 pixels/],
        [mask({ labels: { data: new Uint8Array(8), ...SIZE } }), /number 0 must have RGBA pixels that fill its width and height/],
        [mask({ labels: pixel(1, 2, 3, 255) }), /number 0 has a pixel of a colour that is neither grey nor of the DAVIS palette, at 0, 0/],
        [mask({ labels: labelled(0, 1), propagate: 'left' }), /number 0 must propagate 'both', 'forward', 'backward' or 'none'/],
        [{ masks: [{ frame: 0, labels: labelled(0, 1) }, { frame: 0, labels: labelled(0, 1) }] }, /number 1 is of frame 0, as one before is/],
        [mask({ png: new Uint8Array(99) }), /number 0 has a png that is not a PNG/],
        [mask({ png: davisPng(new Uint8Array(12), 4, 3) }), /'masks': that of frame 0 has 12 labels/],
        [mask({ png: colours }), /number 0 has a png that has no labels: it is not an indexed or grey PNG/],
        [mask({ png: await encodePng(SIZE.width, SIZE.height, soft) }), /number 0 has a png that has \d+ levels only between others, as smoothed edges/],
        [mask({ labels: { ...SIZE, data: Uint8ClampedArray.from([...soft].flatMap((level) => [level, level, level, 255])) } }), /number 0 has \d+ levels only between others/],
        [mask({ rle }), /number 0 must have an id, numbers from 1 to 254/],
        [mask({ id: 1, rle: { size: [96], counts: [] } }), /number 0 must have an rle with a size/],
        [mask({ id: 1, rle: { size: [72, 96] } }), /number 0 must have an rle with counts/],
        [mask({ id: 1, rle: { ...rle, counts: [PIXELS - 1] } }), /number 0 has run lengths that do not fill its size/],
        [mask({ id: 1, rle: { ...rle, counts: [PIXELS, 1] } }), /number 0 has run lengths that do not fill its size/],
        [mask({ id: 1, rle: { ...rle, counts: [-1, PIXELS] } }), /number 0 has run lengths that do not fill its size/],
        [mask({ id: 1, rle: { ...rle, counts: '~~' } }), /number 0 has an rle that cannot be read/],
        [mask({ id: 1, rle: { size: [36, 192], counts: [PIXELS] } }), /'masks': that of frame 0 has 6912 labels, a frame has 96×72 pixels/],
        [{ masks: [{ frame: 0, id: 1, rle }, { frame: 0, id: 2, rle: { size: [36, 192], counts: [PIXELS] } }] }, /number 1 has another size than the mask of frame 0 before it/],
        [{ corrections: [{ frame: 0, labels: labelled(0, 1), propagate: null }] }, /'corrections': number 0 must propagate 'both', 'forward', 'backward' or 'none'/],
        [{ locked: 1 }, /'locked': must be a list of objects, numbers from 1 to 254, not 1/],
        [{ locked: [0] }, /'locked': must be a list of objects/],
        [{ edits: { locked: [255] } }, /'edits': 'locked' must be a list of objects, numbers from 1 to 254/],
      ];
      for (const [options, message] of cases) {
        const stages = [];
        const error = await failure(run(segment, { ...options, onProgress: ({ stage }) => stages.push(stage) }));
        assert.ok(error instanceof VeroneseError, String(error));
        assert.match(error.message, message);
        assert.deepEqual([error.code, stages], ['invalid-option', []], error.message);
      }
      assert.equal((await failure(run(segment, { masks: [() => {}] }))).code, 'invalid-input');
      for (const options of [{ masks: [] }, { locked: [] }, { onChange() {} }]) {
        const once = (function* () { yield* list; })();
        assert.match((await failure(run(segment, options, once))).message, /needs frames that can be read again/);
      }
    });
  });
}
