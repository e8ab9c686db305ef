// When nothing is found, why: in the result of the call, in JSON and in one sentence of the program.

import assert from 'node:assert/strict';
import { describe, test } from 'node:test';
import { openClip, Segmenter, segmentPair, segmentStream } from 'veronese';
import { random } from '../../scripts/lib/random.mjs';
import { clip as framesOf, lines, tracksOf } from './support/folders.mjs';
import { frame, pair } from './support/frames.mjs';
import { veronese } from './support/program.mjs';

const SIZE = { width: 96, height: 72 };

/** A picture of grey levels by column and row. */
function picture(levelAt) {
  const data = new Uint8ClampedArray(4 * SIZE.width * SIZE.height);
  for (let p = 0; p < data.length / 4; p++) data.set([...Array(3).fill(levelAt(p % SIZE.width, Math.floor(p / SIZE.width))), 255], 4 * p);
  return { data, ...SIZE };
}

const wave = (x, y) => 128 + 50 * Math.sin(0.31 * x + 0.17 * y) + 40 * Math.cos(0.23 * x - 0.41 * y) + 20 * Math.sin(0.9 * x) * Math.cos(0.8 * y);
/** Squares of random levels. */
function scene(seed) {
  const next = random(seed);
  const levels = Array.from({ length: 16 * 12 }, () => 30 + 200 * next());
  return picture((x, y) => levels[16 * Math.floor(y / 6) + Math.floor(x / 6)]);
}

const CLIPS = {
  'no-motion': [() => picture(wave), /nothing moves between the frames: their grey levels differ by 0\.00 on average/],
  'no-contrast': [(k) => picture((x, y) => 100 + ((x + y + k) % 2)), /nearly no contrast: their grey levels differ by 0\.5 in all, in 5 of 5 pairs/],
  'one-motion': [(k) => picture((x, y) => wave(x + 1.5 * k, y)), /follows one motion, of up to 1\.\d pixels/],
  'small-steps': [(k) => frame(k * 0.008, SIZE), /between frames that are 16 apart something does: try '--every 16'/],
};

/** Frames of a clip: more than 16 where those are compared. */
const lengthOf = (code) => (code === 'small-steps' ? 17 : 9);

test('a clip in which nothing is found says why, in tracks.json and in one sentence, and again when it is finished', async (t) => {
  const [at, sentence] = CLIPS['small-steps'];
  const { frames, out } = framesOf(t, lengthOf('small-steps'), at);
  const run = () => veronese(['clip', frames, '--quality', 'fast', '--out', out]);
  const { stdout, stderr, code: exit } = await run();
  assert.equal(exit, 0, stderr);
  assert.deepEqual(lines(stdout).at(-1), { done: true, objects: 0 });
  assert.match(stderr, /^veronese: note: [^\n]+\n$/);
  assert.match(stderr, sentence);
  const { notes } = tracksOf(out);
  assert.deepEqual(notes.map((note) => [note.code, `veronese: note: ${note.message}\n`]), [['small-steps', stderr]]);
  assert.equal((await run()).stderr, stderr);
});

describe('the call for clips gives the same notes', () => {
  const framesAt = (at, length = 9) => Array.from({ length }, (_, k) => at(k));
  const options = { quality: 'fast' };
  const notesOf = async (frames, { place = openClip, ...more } = {}) => {
    const clip = await place(frames);
    await clip.segment({ ...options, ...more });
    const { notes } = await clip.tracks();
    return { clip, notes };
  };
  const ofStream = async (frames, more) => {
    const stream = segmentStream(frames, { ...options, ...more });
    while (!(await stream.next()).done);
    return stream.tracks().notes;
  };
  for (const [code, [at, sentence]] of Object.entries(CLIPS)) {
    test(code, async () => {
      const { notes } = await notesOf(framesAt(at, lengthOf(code)));
      assert.deepEqual(notes.map((note) => note.code), [code]);
      const { message, step } = notes[0];
      assert.match(step ? `${message}: try '--every ${step}'` : message, sentence);
    });
  }

  test('in a worker', async () => {
    const frames = framesAt(CLIPS['small-steps'][0], lengthOf('small-steps'));
    const segmenter = new Segmenter();
    const { notes } = await notesOf(frames, { place: (given) => segmenter.openClip(given) });
    assert.deepEqual(notes, (await notesOf(frames)).notes);
    segmenter.close();
  });

  test('frames that are gone tell it by a pair that was kept, but no step', async () => {
    for (const [code, transfer] of [['one-motion', false], ['small-steps', true]]) {
      const [kept] = await ofStream(framesAt(CLIPS[code][0]), { transfer });
      assert.ok([code, 'no-motion'].includes(kept.code), kept.code);
      assert.equal(kept.step, undefined);
    }
  });

  test('what was asked for, what a person said, and a single live frame have none', async () => {
    const still = CLIPS['no-motion'][0];
    assert.equal((await notesOf(framesAt(still), { motions: 1 })).notes, undefined);
    const { clip, notes } = await notesOf(framesAt(still));
    assert.equal(notes.length, 1);
    await clip.annotate({ frame: 0, object: 1, box: [4, 4, 20, 20] });
    assert.equal((await clip.tracks()).notes, undefined);
    assert.equal(await ofStream([still(0)], { lookAhead: 0 }), undefined);
    assert.equal((await notesOf(framesAt((k) => frame(2 * k, SIZE)))).notes, undefined);
  });
});

test('a pair with one motion says why, in a worker too; what was asked for says nothing', async () => {
  const pairs = {
    'no-motion': [picture(wave), picture(wave)],
    'no-contrast': [picture(() => 90), picture(() => 91)],
    'one-motion': [picture(wave), picture((x, y) => wave(x + 2, y))],
    cut: [scene(1), scene(2)],
  };
  const segmenter = new Segmenter();
  for (const [code, [first, second]] of Object.entries(pairs)) {
    const options = code === 'cut' ? { quality: 'fast' } : undefined;
    const { notes, count } = await segmentPair(first, second, options);
    if (count > 1) assert.equal(code, 'cut');
    else assert.equal(notes[0].code, code);
    assert.deepEqual((await segmenter.segmentPair(first, second, options)).notes, notes);
  }
  segmenter.close();
  assert.equal((await segmentPair(...pairs['no-motion'], { motions: 1 })).notes, undefined);
  assert.equal((await segmentPair(...pair())).notes, undefined);
});

test('an object that is likely to be the ground is named', async (t) => {
  // The middle keeps still, all around it moves.
  const still = (x, y) => Math.abs(x - 48) < 14 && Math.abs(y - 36) < 12;
  const { frames, out } = framesOf(t, 6, (k) => picture((x, y) => (still(x, y) ? wave(3 * x, y) : wave(x + 3 * k, y))));
  const { stderr } = await veronese(['clip', frames, '--quality', 'fast', '--out', out]);
  const { notes = [], objects } = tracksOf(out);
  const large = objects.filter((object) => object.frames.every(({ pixels }) => pixels > 0.5 * SIZE.width * SIZE.height));
  assert.deepEqual(notes.map(({ code }) => code), large.map(() => 'object-is-ground'));
  assert.equal(stderr.split('\n').length - 1, notes.length);
});

test('so is one that is smaller and has all of the border', async () => {
  const still = (x, y) => Math.abs(x - 48) < 40 && Math.abs(y - 36) < 30;
  const read = (k) => picture((x, y) => (still(x, y) ? wave(3 * x, y) : wave(x + 3 * k, y + 2 * k)));
  const clip = await openClip({ length: 6, read });
  for await (const { objects } of clip.segment({ quality: 'fast' })) assert.ok(objects.every(({ pixels }) => pixels < 0.4 * SIZE.width * SIZE.height));
  assert.deepEqual((await clip.tracks()).notes.map(({ code }) => code), ['object-is-ground']);
});
