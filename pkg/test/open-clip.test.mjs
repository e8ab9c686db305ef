// openClip: commands, labels, undo and journals; directly, in a worker and in a pool.

import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import { once } from 'node:events';
import { existsSync, readFileSync, rmSync, statSync, symlinkSync, writeFileSync } from 'node:fs';
import { hostname } from 'node:os';
import { join } from 'node:path';
import { describe, test } from 'node:test';
import { Worker } from 'node:worker_threads';
import { openClip, Segmenter, SegmenterPool, solvePair } from 'veronese';
import { random } from '../../scripts/lib/random.mjs';
import { frame } from './support/frames.mjs';
import { temporaryFolder } from './support/program.mjs';
import { all, failure as failureOf } from './support/shapes.mjs';

const SIZE = { width: 64, height: 48 };
const COUNT = 7;
const PIXELS = SIZE.width * SIZE.height;
const FAST = { quality: 'fast' };

/** A short clip of a square that moves over a static background. */
const FRAMES = Array.from({ length: COUNT }, (_, k) => frame(k / 2, SIZE));

/** Why a call fails. */
const failure = async (call) => failureOf((async () => call())());

/** The values of a label image: `label` in a rectangle, `rest` elsewhere. */
function rectangle([left, top, width, height], label, rest) {
  return Uint8Array.from({ length: PIXELS }, (_, p) => {
    const [x, y] = [p % SIZE.width, Math.floor(p / SIZE.width)];
    return x >= left && x < left + width && y >= top && y < top + height ? label : rest;
  });
}

/** Closed with the test. */
async function opened(t, { frames = FRAMES, place = openClip, ...options } = {}) {
  const clip = await place(frames, options);
  t.after(() => clip.close());
  return clip;
}

async function segmented(t, options) {
  const clip = await opened(t, options);
  await clip.segment(FAST);
  return clip;
}

/** The labels of all frames. */
const labelsOf = async (clip) => Promise.all(Array.from({ length: clip.length }, async (_, index) => (await clip.labels(index)).labels));

/** Workers that can be looked at, and a segmenter that ends with the test. */
function workers(t, jobs = 1) {
  const made = [];
  const posted = [];
  const worker = () => {
    const own = new Worker(new URL('../dist/worker-node.js', import.meta.url));
    const post = own.postMessage.bind(own);
    own.postMessage = (message, transfer) => {
      posted.push(message.task);
      post(message, transfer);
    };
    made.push(own);
    return own;
  };
  const segmenter = new SegmenterPool({ worker, jobs });
  t.after(() => segmenter.close());
  return { made, posted, segmenter, place: (...given) => segmenter.openClip(...given) };
}

/** Events of a clip by type, as they come. */
function eventsOf(clip) {
  const events = {};
  clip.subscribe(({ type, ...event }) => (events[type] ??= []).push(event));
  return events;
}

describe('a clip', () => {
  test('is segmented, and gives its frames in order, with objects that fit the labels', async (t) => {
    const clip = await opened(t);
    assert.deepEqual([clip.length, clip.width, clip.nextObject, clip.objects, clip.frames[0].hasMasks], [COUNT, 0, 1, [], false]);
    const events = eventsOf(clip);
    const given = await all(clip.segment(FAST));
    assert.deepEqual(given.map(({ index }) => index), [0, 1, 2, 3, 4, 5, 6]);
    for (const { labels, width, height, objects } of given) {
      assert.deepEqual([labels.length, width, height], [PIXELS, 64, 48]);
      for (const { id, pixels } of objects) assert.equal(labels.filter((label) => label === id).length, pixels);
    }
    assert.deepEqual([clip.width, clip.height, clip.nextObject], [64, 48, 2]);
    assert.deepEqual(clip.objects, [{ number: 1, name: '', class: '', locked: false, annotated: false, became: 1 }]);
    assert.ok(clip.frames.every(({ hasMasks, accepted, annotated, revision }) => hasMasks && !accepted && !annotated && revision > 0));
    assert.deepEqual(events.progress.map(({ stage, frame, done, of }) => [stage, frame, done, of]), FRAMES.map((_, k) => ['pairs', k, k, COUNT]));
    assert.deepEqual(events.frames.flatMap(({ frames }) => frames), [0, 1, 2, 3, 4, 5, 6]);
    assert.deepEqual(events.settled, [{ step: 1 }]);
    const { objects, background, dropped, notes } = await clip.tracks();
    assert.deepEqual([objects.map(({ id, first, last }) => [id, first, last]), background.length, dropped, notes], [[[1, 0, 6]], 6, 0, undefined]);
  });

  test('takes each form of annotation, tells what has changed, and shows the annotated frame first', async (t) => {
    const clip = await segmented(t);
    const own = rectangle([2, 2, 8, 8], 1, 255);
    const step = clip.annotate({ frame: 3, object: 2, strokes: own });
    const shown = await step.shown;
    assert.ok(own.every((label, p) => label === 255 || shown.labels[p] === 2));
    const changes = await step;
    assert.ok(changes.some(({ frame, object, gained }) => frame === 3 && object === 2 && gained >= 64));
    assert.deepEqual((await all(step)).map(({ index }) => index), [...new Set(changes.map(({ frame }) => frame))]);
    await clip.annotate({ frame: 1, object: 3, mask: rectangle([40, 2, 6, 6], 1, 0), propagate: 'none' });
    await clip.annotate({ frame: 5, labels: rectangle([50, 30, 8, 8], 4, 255), propagate: 'exact' });
    await clip.annotate({ frame: 0, labels: rectangle([2, 36, 8, 8], 77, 255), own: true, propagate: 'none' });
    await clip.annotate({ frame: 2, object: 5, box: [16, 12, 24, 24], clicks: [[20, 20, 1], [2, 2, -1]], propagate: 'none' });
    assert.deepEqual(clip.objects.map(({ number, annotated }) => [number, annotated]), [[1, false], [2, true], [3, true], [4, true], [5, true], [77, true]]);
    assert.deepEqual(clip.frames.map(({ annotated }) => annotated), [true, true, true, true, false, true, false]);
    assert.equal((await clip.labels(1)).objects.find(({ id }) => id === 3).pixels, 36);
  });

  test('tells the annotations of a frame, which give the same labels again', async (t) => {
    const [clip, other] = [await segmented(t), await segmented(t)];
    const strokes = rectangle([2, 2, 8, 8], 1, 255);
    await clip.annotate({ frame: 3, object: 2, strokes, propagate: 'forward' });
    await clip.annotate({ frame: 3, object: 5, box: [16, 12, 24, 24], clicks: [[20, 20, 1], [2, 2, -1]] });
    const annotations = await clip.annotations(3);
    assert.deepEqual(annotations, [
      { frame: 3, propagate: 'forward', object: 2, strokes },
      { frame: 3, propagate: 'both', object: 5, clicks: [[20, 20, 1], [2, 2, -1]], box: [16, 12, 24, 24] },
    ]);
    assert.deepEqual(await clip.annotations(2), []);
    for (const annotation of annotations) await other.annotate(annotation);
    assert.deepEqual(await labelsOf(other), await labelsOf(clip));
    assert.equal((await failure(() => clip.annotations(COUNT))).code, 'invalid-option');
  });

  test('takes over a saved clip as one step', async (t) => {
    const [clip, other] = [await segmented(t), await segmented(t)];
    await other.annotate({ frame: 1, object: 3, mask: rectangle([40, 2, 6, 6], 1, 0) });
    await clip.delete(1);
    const [before, wanted, saved] = [await labelsOf(clip), await labelsOf(other), await other.save()];
    const { undo } = clip.steps;
    await clip.restore(saved);
    assert.deepEqual([await labelsOf(clip), clip.steps.undo, clip.objects], [wanted, undo + 1, other.objects]);
    await clip.undo();
    assert.deepEqual(await labelsOf(clip), before);
    for (const bad of [new Uint8Array(3), saved.subarray(0, -1), 'saved']) {
      assert.match((await failure(() => clip.restore(bad))).code, /^invalid-(option|input)$/);
    }
    assert.deepEqual([await labelsOf(clip), clip.steps.waiting], [before, 0]);
  });

  test('gives numbers of new objects one after another', async (t) => {
    const clip = await segmented(t);
    const steps = [2, 12, 22].map((left) => clip.annotate({ frame: 1, object: clip.nextObject, mask: rectangle([left, 2, 6, 6], 1, 0), propagate: 'none' }));
    assert.deepEqual([clip.nextObject, clip.steps.waiting], [5, 3]);
    for (const step of steps) await step;
    assert.deepEqual([clip.objects.map(({ number }) => number), clip.nextObject, clip.steps.waiting], [[1, 2, 3, 4], 5, 0]);
  });

  test('does what each other command says, and undoes it', async (t) => {
    const clip = await segmented(t);
    const found = await labelsOf(clip);
    const square = (frame, object, left) => ({ frame, object, mask: rectangle([left, 2, 6, 6], 1, 0), propagate: 'none' });
    await clip.annotate(square(1, 2, 2), square(2, 3, 12), square(2, 9, 50));
    await clip.clear({ frame: 1 });
    assert.deepEqual((await clip.labels(1)).labels, found[1]);
    await clip.describe(3, { name: 'car', class: 'vehicle', colour: [1, 2, 3] });
    await clip.describe(3, { name: 'cart' }, { coalesce: true });
    await clip.lock([3]);
    const car = clip.objects.find(({ number }) => number === 3);
    assert.deepEqual([car.name, car.class, car.colour, car.locked], ['cart', '', undefined, true]);
    assert.equal((await failure(() => clip.annotate(square(2, 3, 30)))).code, 'object-locked');
    await clip.lock([3], false);
    await clip.accept([4]);
    await clip.accept('all', true);
    await clip.accept([0], false);
    assert.deepEqual(clip.frames.map(({ accepted }) => accepted), [false, true, true, true, true, true, true]);
    await clip.merge(3, 9);
    assert.equal((await clip.labels(2)).objects.find(({ id }) => id === 3).pixels, 72);
    await clip.split(3, 2);
    assert.deepEqual((await clip.labels(2)).objects.filter(({ id }) => id !== 1).map(({ pixels }) => pixels), [36, 36]);
    await clip.delete(3);
    assert.equal(clip.objects.find(({ number }) => number === 3).became, 0);
    const last = await labelsOf(clip);
    await clip.replaceAnnotations({ annotations: [square(6, 7, 2)], descriptions: { 7: { name: 'box' } }, locked: [7], accepted: [3] });
    assert.deepEqual(clip.objects.filter(({ annotated }) => annotated).map(({ number, name, locked }) => [number, name, locked]), [[7, 'box', true]]);
    assert.deepEqual(clip.frames.flatMap(({ accepted }, index) => (accepted ? [index] : [])), [3]);
    assert.equal(await clip.undo(), true);
    assert.deepEqual(await labelsOf(clip), last);
    let undone = 1;
    while (await clip.undo()) undone += 1;
    assert.equal(clip.steps.undo, 0);
    assert.equal(clip.steps.redo, undone);
    assert.equal(clip.frames.some(({ hasMasks }) => hasMasks), false);
    assert.equal(await clip.redo(), true);
    assert.deepEqual(await labelsOf(clip), found);
    for (let k = 2; k < undone; k++) assert.equal(await clip.redo(), true);
    assert.deepEqual(await labelsOf(clip), last);
  });

  test('goes on from what was saved', async (t) => {
    const clip = await segmented(t);
    await clip.annotate({ frame: 3, object: 2, strokes: rectangle([2, 2, 8, 8], 1, 255) });
    const [saved, labels] = [await clip.save(), await labelsOf(clip)];
    const again = await opened(t, { saved });
    assert.deepEqual([again.objects, again.frames, again.steps.undo], [clip.objects, clip.frames, 2]);
    assert.deepEqual(await labelsOf(again), labels);
    assert.equal((await failure(() => openClip(FRAMES.slice(1), { saved }))).message, "option 'saved': it is of a clip of 7 frames, not 6");
    assert.equal((await failure(() => openClip(FRAMES, { saved: saved.slice(0, -1) }))).message, "option 'saved': it is damaged or cut off");
    assert.equal((await failure(() => openClip(FRAMES, { saved: new Uint8Array(40) }))).code, 'invalid-option');
  });

  test('segments ranges one after another; labels wait for a range that is coming, and for no other', async (t) => {
    const clip = await opened(t);
    const first = clip.segment({ ...FAST, last: 3 });
    const waiting = clip.labels(2);
    assert.equal((await failure(() => clip.labels(6))).message, "option 'frame': frame 6 has no masks: segment it first");
    assert.equal((await waiting).index, 2);
    assert.deepEqual((await all(first)).map(({ index }) => index), [0, 1, 2, 3]);
    assert.deepEqual((await all(clip.segment({ ...FAST, first: 4 }))).map(({ index }) => index), [4, 5, 6]);
    assert.deepEqual((await clip.tracks()).objects.map(({ id, first, last }) => [id, first, last]), [[1, 0, 6]]);
  });

  test('segments a range in the middle again, with the frames beside it', async (t) => {
    const clip = await segmented(t);
    const labels = await labelsOf(clip);
    const events = eventsOf(clip);
    await clip.segment({ ...FAST, first: 2, last: 4 });
    const outside = (all) => all.filter((_, index) => index < 2 || index > 4);
    assert.deepEqual(outside(await labelsOf(clip)), outside(labels));
    assert.deepEqual((await clip.tracks()).objects.map(({ id, first, last }) => [id, first, last]), [[1, 0, 6]]);
    assert.deepEqual(events.progress.map(({ frame, done, of }) => [frame, done, of]), [[2, 0, 3], [3, 1, 3], [4, 2, 3]]);
  });

  test('a frame of another size ends the range, and spoils nothing', async (t) => {
    const frames = FRAMES.map((given, k) => (k === 0 ? frame(0, { width: 80, height: 48 }) : given));
    const clip = await opened(t, { frames });
    assert.match((await failure(() => clip.segment(FAST))).message, /^frame 1: .*80×48/);
    await clip.segment({ ...FAST, first: 1 });
    assert.deepEqual([clip.width, clip.frames.filter(({ hasMasks }) => hasMasks).length], [64, 6]);
  });

  test('a frame that never comes holds up nothing else', async (t) => {
    let isSilent = false;
    const read = (index) => (isSilent && index === 3 ? new Promise(() => {}) : FRAMES[index]);
    const first = await segmented(t, { frames: { length: COUNT, read } });
    const clip = await opened(t, { frames: { length: COUNT, read }, saved: await first.save() });
    isSilent = true;
    const stroke = clip.annotate({ frame: 3, object: 2, strokes: rectangle([2, 2, 8, 8], 1, 255) });
    assert.equal((await clip.labels(5)).index, 5);
    stroke.cancel();
    assert.equal((await failure(() => stroke)).code, 'cancelled');
    await clip.annotate({ frame: 1, object: 2, strokes: rectangle([2, 2, 8, 8], 1, 255), propagate: 'none' });
  });

  test('drafts come while a range is segmented, where they are asked for', async (t) => {
    const clip = await opened(t);
    const events = eventsOf(clip);
    await clip.segment({ ...FAST, drafts: true });
    assert.deepEqual(events.draft.map(({ frame }) => [frame.index, frame.labels.length, frame.width]), [0, 1, 2, 3, 4].map((index) => [index, PIXELS, 64]));
  });

  test('is cancelled by a signal, a step and as a whole; what was solved is used again', async (t) => {
    const clip = await opened(t);
    const controller = new AbortController();
    const events = eventsOf(clip);
    const step = clip.segment({ ...FAST, signal: controller.signal });
    clip.subscribe(({ type, frame }) => type === 'progress' && frame === 4 && controller.abort());
    assert.equal((await failure(() => step)).code, 'cancelled');
    assert.equal(clip.frames.some(({ hasMasks }) => hasMasks), false);
    await clip.segment(FAST);
    assert.ok(events.progress.length > COUNT);
    const labels = await labelsOf(clip);
    const stroke = clip.annotate({ frame: 3, object: 2, strokes: rectangle([2, 2, 8, 8], 1, 255) });
    stroke.cancel();
    assert.equal((await failure(() => stroke)).code, 'cancelled');
    const [one, other] = [2, 3].map((object) => clip.annotate({ frame: 3, object, strokes: rectangle([2, 2, 8, 8], 1, 255) }));
    clip.cancel();
    for (const each of [one, other]) assert.equal((await failure(() => each)).code, 'cancelled');
    assert.deepEqual(await labelsOf(clip), labels);
    assert.equal((await failure(() => clip.labels(0, { signal: AbortSignal.abort() }))).code, 'cancelled');
  });

  test('ends a range before a frame that cannot be read, or on request', async (t) => {
    const read = (index) => {
      if (index === 4) throw new Error('mine');
      return FRAMES[index];
    };
    const clip = await opened(t, { frames: { length: COUNT, read } });
    const given = [];
    const error = await failure(async () => {
      for await (const { index } of clip.segment(FAST)) given.push(index);
    });
    assert.deepEqual([error.message, given], ['mine', [0, 1, 2, 3]]);
    const finished = await opened(t);
    finished.subscribe(({ type, frame }) => type === 'progress' && frame === 3 && finished.finish());
    assert.deepEqual((await all(finished.segment(FAST))).length < COUNT, true);
  });

  test('takes a step back if a frame is not there any more, and refuses other frames than before', async (t) => {
    let now = FRAMES;
    const clip = await segmented(t, { frames: { length: COUNT, read: (index) => now[index] ?? Promise.reject(new Error('gone')) } });
    const saved = await clip.save();
    const labels = await labelsOf(clip);
    const again = await opened(t, { saved, frames: { length: COUNT, read: (index) => now[index] ?? Promise.reject(new Error('gone')) } });
    now = [];
    assert.equal((await failure(() => again.annotate({ frame: 3, object: 2, strokes: rectangle([2, 2, 8, 8], 1, 255) }))).message, 'gone');
    now = FRAMES.toReversed();
    assert.match((await failure(() => again.annotate({ frame: 2, object: 2, strokes: rectangle([2, 2, 8, 8], 1, 255) }))).message, /frame 2/);
    now = FRAMES;
    assert.deepEqual(await labelsOf(again), labels);
    assert.equal(again.steps.undo, 1);
  });

  test('uses pairs that were solved elsewhere, and solves those that do not fit', async (t) => {
    const labels = await labelsOf(await segmented(t));
    const pairs = await Promise.all(FRAMES.slice(1).map((second, k) => solvePair(FRAMES[k], second, FAST)));
    const asked = [];
    const clip = await opened(t);
    const given = (index) => {
      asked.push(index);
      return index === 2 ? pairs[4] : index === 3 ? undefined : pairs[index - 1];
    };
    await clip.segment({ ...FAST, pairs: given });
    assert.deepEqual(asked, [1, 2, 3, 4, 5, 6]);
    assert.deepEqual(await labelsOf(clip), labels);
  });

  test('says why it has no object', async (t) => {
    const clip = await opened(t, { frames: FRAMES.map(() => FRAMES[0]) });
    await clip.segment(FAST);
    assert.deepEqual((await clip.tracks()).notes.map(({ code }) => code), ['no-motion']);
  });

  test('does nothing more when it is closed', async (t) => {
    const clip = await segmented(t);
    const step = clip.annotate({ frame: 3, object: 2, strokes: rectangle([2, 2, 8, 8], 1, 255) });
    const labels = clip.labels(5);
    clip[Symbol.dispose]();
    for (const call of [() => step, () => labels, () => clip.labels(0), () => clip.save(), () => clip.undo(), () => clip.lock([1])]) assert.equal((await failure(call)).code, 'clip-closed');
  });
});

describe('arguments', () => {
  test('of commands are checked before anything is done', async (t) => {
    const clip = await segmented(t);
    const label = new Uint8Array(PIXELS);
    const cases = [
      [() => clip.segment({ last: 7 }), /'last': must be a frame from 1 to 6/],
      [() => clip.segment({ first: 5, last: 5 }), /'first': must be a frame before the last, 5/],
      [() => clip.segment({ quality: 'good' }), /'quality': must be 'fast' or 'best'/],
      [() => clip.segment({ lookAhead: 2 }), /no option 'lookAhead'/],
      [() => clip.annotate(3), /must be annotations of frames/],
      [() => clip.annotate({ frame: 7, object: 1, mask: label }), /number 0: 'frame' must be a whole number from 0 to 6/],
      [() => clip.annotate({ frame: 0, object: 0, mask: label }), /'object' must be a number from 1 to 254/],
      [() => clip.annotate({ frame: 0, object: 1 }), /needs one of/],
      [() => clip.annotate({ frame: 0, object: 1, mask: label, box: [0, 0, 2, 2] }), /needs one of/],
      [() => clip.annotate({ frame: 0, object: 1, mask: new Uint8Array(5) }), /'mask' has 5 labels, a frame has 64×48 pixels/],
      [() => clip.annotate({ frame: 0, object: 1, mask: [...label] }), /must be a Uint8Array/],
      [() => clip.annotate({ frame: 0, object: 1, strokes: label.map(() => 2) }), /must be 1 where the object is/],
      [() => clip.annotate({ frame: 0, object: 1, labels: label }), /a mask of one object is 'mask'/],
      [() => clip.annotate({ frame: 0, object: 1, box: [60, 0, 5, 5] }), /'box' must be/],
      [() => clip.annotate({ frame: 0, object: 1, clicks: [[64, 0, 1]] }), /'clicks' must be/],
      [() => clip.annotate({ frame: 0, object: 1, clicks: [[4, 0, 2]] }), /'clicks' must be/],
      [() => clip.annotate({ frame: 0, object: 1, mask: label, propagate: 'all' }), /'propagate' must be one of/],
      [() => clip.annotate({ frame: 0, object: 1, masque: label }), /there is no 'masque'/],
      [() => clip.clear({ frame: 9 }), /there is no frame 9 in a clip of 7 frames/],
      [() => clip.accept([0.5]), /there is no frame 0.5/],
      [() => clip.accept('some'), /must be a list of frames/],
      [() => clip.lock([255]), /must be a number from 1 to 254/],
      [() => clip.lock(1), /must be a list of objects/],
      [() => clip.lock([1], 'yes'), /'on': must be true or false/],
      [() => clip.describe(1, { name: 5 }), /'name': must be a text/],
      [() => clip.describe(1, { colour: [1, 2] }), /'colour': must be/],
      [() => clip.describe(1, { title: 'x' }), /there is no 'title'/],
      [() => clip.merge(1, 200), /there is no object 200/],
      [() => clip.merge(1), /nothing to merge/],
      [() => clip.delete(99), /there is no object 99/],
      [() => clip.split(99, 1), /there is no object 99/],
      [() => clip.replaceAnnotations({ merged: [1, 2] }), /'merged': must be lists/],
      [() => clip.labels(7), /there is no frame 7/],
    ];
    for (const [call, message] of cases) {
      const { name, code, message: found } = await failure(call);
      assert.deepEqual([name, code], ['VeroneseError', 'invalid-option'], found);
      assert.match(found, message);
    }
    assert.deepEqual(clip.steps, { undo: 1, redo: 0, waiting: 0 });
  });

  test('of openClip are checked', async () => {
    for (const [given, options, code] of [
      [5, {}, 'invalid-input'],
      [{ length: -1, read() {} }, {}, 'invalid-input'],
      [FRAMES, { journal: 5 }, 'invalid-option'],
      [FRAMES, { journal: {} }, 'invalid-option'],
      [FRAMES, { saved: 'text' }, 'invalid-input'],
      [FRAMES, { markUnknown: 1 }, 'invalid-option'],
      [FRAMES, { maxSize: 5 }, 'invalid-option'],
      [FRAMES, { quality: 'fast' }, 'invalid-option'],
    ]) assert.equal((await failure(() => openClip(given, options))).code, code);
    const one = await openClip(FRAMES.slice(0, 1));
    assert.equal((await failure(() => one.segment())).code, 'too-few-frames');
    await one.close();
  });

  test('are the caller\'s again when the call returns', async (t) => {
    const clip = await segmented(t);
    const strokes = rectangle([2, 2, 8, 8], 1, 255);
    const expected = strokes.slice();
    const step = clip.annotate({ frame: 3, object: 2, strokes });
    strokes.fill(0);
    await step;
    const { labels } = await clip.labels(3);
    assert.ok(expected.every((label, p) => label === 255 || labels[p] === 2));
    assert.equal(strokes.length, PIXELS);
  });
});

describe('in workers', () => {
  test('labels are the same to the bit with any number of workers, and the loop of one clip may wait for another', async (t) => {
    const expected = await labelsOf(await segmented(t));
    for (const jobs of [1, 3]) {
      const { segmenter, place } = workers(t, jobs);
      const clip = await opened(t, { place });
      const given = [];
      for await (const { labels } of clip.segment(FAST)) {
        given.push(labels);
        if (given.length > 1) continue;
        const other = await segmented(t, { place });
        assert.deepEqual(await labelsOf(other), expected);
      }
      assert.deepEqual(given, expected);
      const events = eventsOf(clip);
      segmenter.close();
      assert.equal((await failure(() => clip.labels(0))).code, 'cancelled');
      assert.equal(events.closed[0].reason.code, 'cancelled');
    }
  });

  test('a stroke moves no state, and no frame twice', async (t) => {
    const { posted, place } = workers(t);
    const clip = await segmented(t, { place });
    posted.length = 0;
    const step = clip.annotate({ frame: 3, object: 2, strokes: rectangle([2, 2, 8, 8], 1, 255) });
    await step.shown;
    await step;
    assert.equal(posted.filter(({ frame }) => frame).length, 0);
    const bytes = JSON.stringify(posted.map((task) => ({ ...task, command: undefined }))).length;
    assert.ok(bytes < 10_000, `${bytes} bytes beside the stroke itself`);
    assert.ok(posted.every(({ state, saved }) => !state && !saved));
  });

  test('a clip goes on when its worker dies at any time, with the same labels', async (t) => {
    const strokes = [3, 1, 5].map((at, k) => ({ frame: at, object: 2 + k, strokes: rectangle([2 + 12 * k, 2, 8, 8], 1, 255) }));
    const straight = await segmented(t);
    for (const stroke of strokes) await straight.annotate(stroke);
    await straight.lock([2]);
    await straight.undo();
    const expected = await labelsOf(straight);
    for (let seed = 0; seed < 6; seed++) {
      const { made, place } = workers(t);
      const next = random(seed);
      const clip = await opened(t, { place });
      const events = eventsOf(clip);
      let deaths = 0;
      clip.subscribe(({ type }) => {
        if (!['progress', 'frames', 'kept'].includes(type) || next() > 0.15 || deaths >= 4) return;
        deaths += 1;
        void made.at(-1).terminate();
      });
      const steps = [clip.segment(FAST), ...strokes.map((stroke) => clip.annotate(stroke)), clip.lock([2])];
      for (const step of steps) await step;
      await clip.undo();
      assert.deepEqual(await labelsOf(clip), expected, `seed ${seed}`);
      assert.deepEqual(clip.objects, straight.objects);
      if (deaths > 0) assert.ok(events.revived.length > 0 && events.revived.every(({ reason }) => reason.code === 'worker-failed'));
    }
  });

  test('what kills every worker is given up, and nothing else is lost', async (t) => {
    const made = [];
    const worker = () => {
      const own = new Worker(new URL('../dist/worker-node.js', import.meta.url));
      const post = own.postMessage.bind(own);
      own.postMessage = (message, transfer) => (message.task.call === 'applyClip' && message.task.command.type === 'merge' ? void own.terminate() : post(message, transfer));
      made.push(own);
      return own;
    };
    const segmenter = new Segmenter(undefined, { worker });
    t.after(() => segmenter.close());
    const clip = await segmented(t, { place: (...given) => segmenter.openClip(...given) });
    const labels = await labelsOf(clip);
    assert.equal((await failure(() => clip.merge(1, 2))).code, 'worker-failed');
    assert.deepEqual(await labelsOf(clip), labels);
    assert.equal(made.length, 3);
  });
});

describe('a journal', () => {
  test('in a file keeps everything from one process to the next', async (t) => {
    const { path } = temporaryFolder(t);
    const journal = path('clip.log');
    const clip = await segmented(t, { journal });
    await clip.annotate({ frame: 3, object: 2, strokes: rectangle([2, 2, 8, 8], 1, 255) });
    assert.match((await failure(() => openClip(FRAMES, { journal }))).message, /another clip has '.*' open/);
    const [labels, { objects, steps }] = [await labelsOf(clip), clip];
    await clip.close();
    const again = await opened(t, { journal });
    assert.deepEqual([again.objects, again.steps, again.isDamaged], [objects, steps, false]);
    assert.deepEqual(await labelsOf(again), labels);
    assert.equal(await again.undo(), true);
    await again.close();
    assert.equal((await failure(() => openClip(FRAMES, { journal, saved: new Uint8Array(8) }))).message, "option 'saved': the journal has a clip already: give one of the two");
    assert.equal((await failure(() => openClip(FRAMES, { journal: path('none', 'clip.log') }))).code, 'file-not-found');
  });

  test('whose end was not written completely goes on before it; one that is damaged is kept beside', async (t) => {
    const { path } = temporaryFolder(t);
    const journal = path('clip.log');
    const clip = await segmented(t, { journal });
    const before = await labelsOf(clip);
    const length = statSync(journal).size;
    await clip.annotate({ frame: 3, object: 2, strokes: rectangle([2, 2, 8, 8], 1, 255) });
    await clip.close();
    const content = readFileSync(journal);
    writeFileSync(journal, content.subarray(0, length + 5));
    const cut = await opened(t, { journal });
    assert.deepEqual([await labelsOf(cut), cut.isDamaged, statSync(journal).size], [before, false, length]);
    await cut.close();
    const wrong = Buffer.from(content);
    wrong[length + 20] ^= 1;
    writeFileSync(journal, wrong);
    const damaged = await opened(t, { journal });
    assert.deepEqual([await labelsOf(damaged), damaged.isDamaged], [before, true]);
    assert.deepEqual(readFileSync(`${journal}.damaged`), wrong);
  });

  test('has the commands that were given before the clip was closed, and is locked by its one place', async (t) => {
    const { path } = temporaryFolder(t);
    const [journal, link] = [path('clip.log'), path('link')];
    symlinkSync(path('.'), link);
    const clip = await segmented(t, { journal, place: workers(t).place });
    const step = clip.annotate({ frame: 3, object: 2, strokes: rectangle([2, 2, 8, 8], 1, 255) });
    const described = clip.describe(1, { name: 'square' });
    const elsewhere = join(link, 'clip.log');
    assert.match((await failure(() => openClip(FRAMES, { journal: elsewhere }))).message, /another clip has/);
    await clip.close();
    for (const each of [step, described]) assert.ok(['clip-closed', undefined].includes((await each.then(() => ({}), (error) => error)).code));
    const again = await opened(t, { journal: elsewhere });
    await again.lock([1], false);
    assert.deepEqual(again.objects.map(({ number, name }) => [number, name]), [[1, 'square'], [2, '']]);
    await again.close();
    // A process that is no more, another machine, and what is no lock.
    const lock = `${journal}.veronese-lock`;
    const cases = [[`4194303 ${hostname()}\n`, true], [`${process.pid} elsewhere\n`, false], ['text', false]];
    for (const [content, isFree] of cases) {
      writeFileSync(lock, content);
      const outcome = await openClip(FRAMES, { journal }).then((clip) => clip.close().then(() => true), () => false);
      assert.equal(outcome, isFree, content);
      assert.equal(existsSync(lock), !isFree);
      if (!isFree) rmSync(lock);
    }
  });

  test('of the caller keeps its own bytes', async (t) => {
    const clip = await segmented(t);
    const saved = Buffer.from(await clip.save());
    const bytes = saved.length;
    const kept = { read: async () => saved, append: async () => {}, replace: async () => {} };
    const again = await opened(t, { journal: kept, place: workers(t).place });
    assert.deepEqual([again.frames[0].hasMasks, saved.length], [true, bytes]);
  });

  test('that fails is tried again, and the clip goes on', async (t) => {
    const kept = [];
    let isFull = false;
    const write = async (bytes) => {
      if (isFull) throw new Error('full');
      kept.push(bytes.slice());
    };
    const journal = { read: async () => undefined, append: write, replace: (bytes) => ((kept.length = 0), write(bytes)) };
    const clip = await segmented(t, { journal });
    const events = eventsOf(clip);
    isFull = true;
    await clip.lock([1]);
    assert.deepEqual([events.unkept.map(({ error }) => error.message), events.kept], [['the journal cannot be written: full'], undefined]);
    isFull = false;
    await clip.lock([1], false);
    assert.equal(events.kept.length, 1);
    const again = await opened(t, { saved: new Uint8Array(Buffer.concat(kept)) });
    assert.deepEqual([again.steps, again.objects], [clip.steps, clip.objects]);
  });

  test('has all that a process was told as settled when it was killed', async (t) => {
    const { path } = temporaryFolder(t);
    const journal = path('clip.log');
    const program = `
      import { openClip } from ${JSON.stringify(new URL('../dist/node.js', import.meta.url))};
      import { frame } from ${JSON.stringify(new URL('./support/moving.mjs', import.meta.url))};
      const frames = Array.from({ length: 7 }, (_, k) => frame(k / 2, { width: 64, height: 48 }));
      const clip = await openClip(frames, { journal: process.argv[1] });
      if (!clip.frames[0].hasMasks) await clip.segment({ quality: 'fast' });
      console.log('begun', clip.steps.undo);
      for (let k = clip.steps.undo; k < 12; k++) {
        const strokes = new Uint8Array(64 * 48).fill(255);
        for (let y = 2; y < 8; y++) strokes.fill(1, y * 64 + 4 * k, y * 64 + 4 * k + 4);
        await clip.annotate({ frame: k % 7, object: 1 + k, strokes });
        console.log('settled', clip.steps.undo);
      }
      process.exit();`;
    const next = random(5);
    let settled = 0;
    for (let run = 0; settled < 12 && run < 20; run++) {
      const child = spawn(process.execPath, ['--input-type=module', '-e', program, journal], { stdio: ['ignore', 'pipe', 'inherit'] });
      const lines = [];
      const wait = 1 + Math.floor(4 * next());
      for await (const piece of child.stdout) {
        lines.push(...String(piece).trim().split('\n'));
        if (lines.length > wait) child.kill('SIGKILL');
      }
      if (child.exitCode === null && child.signalCode === null) await once(child, 'exit');
      const [begun] = lines.map((line) => Number(line.split(' ')[1]));
      assert.ok(begun >= settled && begun <= settled + 1, `${settled} steps were settled, ${begun} are there`);
      settled = Math.max(begun, ...lines.map((line) => Number(line.split(' ')[1])));
    }
    assert.equal(settled, 12);
    assert.ok(existsSync(journal));
    const clip = await opened(t, { journal });
    const straight = await opened(t);
    await straight.segment(FAST);
    for (let k = 1; k < 12; k++) await straight.annotate({ frame: k % 7, object: 1 + k, strokes: rectangle([4 * k, 2, 4, 6], 1, 255) });
    assert.deepEqual(await labelsOf(clip), await labelsOf(straight));
  });
});
