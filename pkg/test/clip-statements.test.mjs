// Every annotation of a clip is about an object: which pixels it changes, and which it leaves as they are.

import assert from 'node:assert/strict';
import { after, describe, test } from 'node:test';
import { segmentClip, Segmenter } from 'veronese';
import { failure } from './support/shapes.mjs';
import { box, COUNT, frame, labelled, middle, PIXELS, SIZE } from './support/three.mjs';

const list = Array.from({ length: COUNT }, (_, index) => frame(index));
const source = { length: COUNT, read: (index) => list[index] };

async function run(options, segment = segmentClip) {
  const clip = segment(source, { quality: 'fast', ...options });
  const labels = [];
  for await (const one of clip) labels.push(one.labels);
  return { labels, tracks: clip.tracks(), state: await clip.state(), changes: await clip.changes() };
}

const found = await run({});
const segmenter = new Segmenter();
after(() => segmenter.close());

const count = (labels, id) => labels.filter((label) => label === id).length;
const said = (options) => run({ state: found.state, ...options });
/** Half of a square, from its left. */
const half = (square, index, label) => labelled(square, index, label).map((own, p) => (p % SIZE.width < middle(square, index)[0] ? own : 255));

test('the three squares are found by themselves, and nothing has changed', () => {
  for (const id of [1, 2, 3]) assert.ok(found.labels.every((labels, index) => labelled(id, index, 1, 0).filter((inside, p) => inside && labels[p] === id).length > 450), `object ${id}`);
  assert.deepEqual(found.changes, []);
});

describe('a locked object', () => {
  test('of which something is said is an error, before any pair is solved', async () => {
    const cases = [
      { corrections: [{ frame: 3, labels: half(2, 3, 2) }] },
      { corrections: [{ frame: 3, object: 2, labels: half(2, 3, 0) }] },
      { corrections: [{ frame: 3, label: 2, box: box(2, 3) }] },
      { prompts: [{ frame: 3, object: 2, clicks: [[...middle(2, 3), 1]] }] },
      { edits: { delete: [2] } },
    ];
    const { state } = await said({ locked: [2] });
    for (const { edits, ...rest } of cases) {
      for (const locks of [{ edits }, { locked: [2], edits }, { edits: { ...edits, locked: [2] } }]) {
        const stages = [];
        const onProgress = ({ stage }) => stages.push(stage);
        const error = await failure(run({ state, ...rest, ...locks, onProgress }));
        assert.deepEqual([error.code, error.message, stages], ['object-locked', 'object 2 is locked: unlock it to change it', []]);
      }
    }
    const deleted = await failure(run({ locked: [2], edits: { delete: [2] } }));
    assert.equal(deleted.code, 'object-locked');
    // A lock holds from the annotations that it is given with.
    const given = { corrections: [{ frame: 3, object: 2, labels: half(2, 3, 0) }] };
    assert.deepEqual((await said({ ...given, locked: [2] })).labels, (await said(given)).labels);
    // Annotations from before the lock may be given again.
    const corrections = [{ frame: 3, labels: half(2, 3, 2) }];
    const before = await said({ corrections, locked: [2] });
    assert.deepEqual((await run({ state: before.state, corrections })).labels, before.labels);
    const other = await failure(run({ state: before.state, corrections: [{ frame: 3, labels: half(2, 3, 2).fill(255, 0, PIXELS / 4) }] }));
    assert.equal(other.code, 'object-locked');
  });
});

describe('an accepted frame', () => {
  const corrections = [{ frame: 4, labels: half(2, 4, 9) }, { frame: 4, object: 3, labels: half(3, 4, 0) }];

  test('stays as it is to the bit while what is said of others spreads', async () => {
    const free = await said({ corrections });
    assert.notDeepEqual(free.labels[2], found.labels[2]);
    const accepted = await said({ corrections, accepted: [2] });
    assert.deepEqual(accepted.labels[2], found.labels[2]);
    assert.notDeepEqual(accepted.labels[4], found.labels[4]);
    // A state keeps it, until it is no longer accepted.
    const later = await run({ state: accepted.state, corrections: [{ frame: 0, labels: half(1, 0, 8) }] });
    assert.deepEqual(later.labels[2], found.labels[2]);
    const more = await run({ state: accepted.state, corrections: [{ frame: 0, labels: half(1, 0, 8) }], accepted: [2, 4] });
    assert.deepEqual([more.labels[2], more.labels[4]], [found.labels[2], accepted.labels[4]]);
    const open = await run({ state: accepted.state, corrections: [{ frame: 1, labels: half(2, 1, 8) }], accepted: [] });
    assert.notDeepEqual(open.labels[2], found.labels[2]);
  });

  test('may come with the labels that were seen', async () => {
    const seen = found.labels[2].map((label, p) => (p < 500 ? 7 : label === 3 ? 0 : label));
    const { labels, changes } = await said({ corrections, accepted: [{ frame: 2, labels: seen }, { frame: 1 }] });
    assert.deepEqual([labels[2], labels[1]], [seen, found.labels[1]]);
    assert.deepEqual(changes.find(({ frame, object }) => frame === 2 && object === 3), { frame: 2, object: 3, gained: 0, lost: count(found.labels[2], 3) });
    const again = await said({ corrections, accepted: [{ frame: 2, labels: seen }, { frame: 1 }] });
    assert.deepEqual(again.labels, labels);
  });

  test('without labels has those of the masks', async () => {
    const masks = [{ frame: 0, labels: labelled(2, 0, 7, 0) }];
    const given = await said({ masks });
    for (const rest of [{}, { corrections }]) {
      const { labels } = await said({ masks, accepted: [3], ...rest });
      assert.deepEqual(labels[3], given.labels[3], Object.keys(rest).join());
    }
  });
});

describe('prompts', () => {
  const at = middle(2, 3);

  test('of one click or a box are the short forms among the corrections', async () => {
    for (const [prompt, short] of [[{ box: box(2, 3) }, { box: box(2, 3) }], [{ clicks: [[...at, 1]] }, { click: at }]]) {
      const one = await said({ prompts: [{ frame: 3, object: 9, ...prompt }] });
      for (const corrections of [[{ frame: 3, label: 9, ...short }], [{ frame: 3, object: 9, ...prompt }]]) assert.deepEqual((await said({ corrections })).labels, one.labels);
      assert.ok(one.labels.every((labels) => count(labels, 9) > 400), 'it is followed');
      const worker = await run({ state: found.state, prompts: [{ frame: 3, object: 9, ...prompt }] }, (...args) => segmenter.segmentClip(...args));
      assert.deepEqual(worker, one, 'in a worker');
    }
  });
});

test('changes() tells what objects have gained and lost, in the frames that have changed', async () => {
  const masks = [{ frame: 2, labels: labelled(1, 2, 1, 255), propagate: 'none' }];
  for (const options of [{ prompts: [{ frame: 3, object: 9, box: box(2, 3) }] }, { corrections: [{ frame: 1, labels: half(2, 1, 0) }] }]) {
    const { labels, changes } = await said(options);
    const expected = labels.flatMap((own, index) =>
      [0, 1, 2, 3, 9].flatMap((object) => {
        const gained = own.filter((label, p) => label === object && found.labels[index][p] !== object).length;
        const lost = own.filter((label, p) => label !== object && found.labels[index][p] === object).length;
        return gained + lost > 0 ? [{ frame: index, object, gained, lost }] : [];
      }));
    assert.ok(expected.length > 0);
    assert.deepEqual(changes, expected);
  }
  assert.deepEqual((await said({ edits: { delete: [1] } })).changes, [], 'edits are not counted');
  assert.equal((await said({ masks })).changes.every(({ frame }) => frame === 2), true);
  const clip = segmentClip(source, { state: found.state });
  assert.deepEqual(await clip.changes(), []);
  const stream = segmentClip(list.values(), { quality: 'fast', lookAhead: 1 });
  await stream.next();
  assert.deepEqual(await stream.changes(), []);
  await stream.return();
});

test('refuses what it cannot use before any pair is solved', async () => {
  const prompt = (rest) => ({ prompts: [{ frame: 3, object: 9, ...rest }] });
  const cases = [
    [{ prompts: {} }, /'prompts': must be a list of \{ frame, object, clicks, box \}/],
    [{ prompts: [{ frame: COUNT, object: 9, box: [1, 2, 3, 4] }] }, /'prompts': number 0 must have a frame from 0 to 5/],
    [{ prompts: [{ frame: 3, box: [1, 2, 3, 4] }] }, /'prompts': number 0 must have an object, numbers from 1 to 254/],
    [prompt({ clicks: [[1, 2]] }), /number 0 must have clicks, a list of \[x, y, 1\]/],
    [prompt({ clicks: [[1, 2, 0]] }), /number 0 must have clicks/],
    [prompt({ clicks: [[1, 2, -1]] }), /number 0 must have a box or a click that belongs to object 9/],
    [prompt({ clicks: [[1, 2, 1]], box: [10, 10, 5, 5] }), /number 0 has a click at 1, 2 that belongs to object 9 and is not in its box/],
    [prompt({ box: [1, 2, 3] }), /number 0 must have a box, the whole numbers/],
    [prompt({ box: [90, 2, 30, 4] }), /'prompts': what points to object 9 in frame 3 is not within 96×72 pixels/],
    [prompt({ clicks: [[1, 72, 1]] }), /'prompts': what points to object 9 in frame 3 is not within 96×72 pixels/],
    [prompt({ clicks: [[1, 2, 1], [96, 1, -1]] }), /'prompts': what points to object 9 in frame 3 is not within/],
    [prompt({ box: [1, 2, 3, 4], propagate: 'up' }), /number 0 must propagate/],
    [{ prompts: [{ frame: 3, object: 9 }, { frame: 3, object: 9 }] }, /'prompts': number 1 points to object 9 in frame 3, as one before does/],
    [{ corrections: [{ frame: 3, label: 9, click: [1, 2] }], ...prompt({ box: [1, 2, 3, 4] }) }, /'prompts': number 0 points to object 9 in frame 3, as one before does/],
    [{ corrections: [{ frame: 3, object: 0, labels: found.labels[3] }] }, /'corrections': number 0 must have an object, numbers from 1 to 254, or none/],
    [{ corrections: [{ frame: 3, object: 2, labels: found.labels[3] }] }, /'corrections': number 0 must have the labels 0, 2 and 255: it is about object 2 alone/],
    [{ corrections: [1, 2].map(() => ({ frame: 3, object: 2, labels: new Uint8Array(PIXELS) })) }, /'corrections': number 1 is of object 2 in frame 3, as one before is/],
    [{ accepted: 3 }, /'accepted': must be a list of frames or \{ frame, labels \}, not 3/],
    [{ accepted: [0.5] }, /'accepted': number 0 must have a frame from 0 to 5/],
    [{ accepted: [1, { frame: 1 }] }, /'accepted': number 1 is frame 1, as one before is/],
    [{ accepted: [{ frame: 1, labels: new Uint8Array(12) }] }, /'accepted': that of frame 1 has 12 labels, a frame has 96×72 pixels/],
  ];
  for (const [options, message] of cases) {
    const stages = [];
    const error = await failure(run({ ...options, onProgress: ({ stage }) => stages.push(stage) }));
    assert.match(error.message, message);
    assert.deepEqual([error.code, stages], ['invalid-option', []], error.message);
  }
  for (const options of [{ prompts: [] }, { accepted: [] }]) {
    const error = await failure(segmentClip(list.values(), options).next());
    assert.match(error.message, /needs frames that can be read again/);
  }
});
