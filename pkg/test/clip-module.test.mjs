// A clip as the WebAssembly module holds it.

import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { describe, test } from 'node:test';
import { glue } from '../build/module/glue.js';
import { frame } from './support/frames.mjs';

const SIZE = { width: 64, height: 48 };

describe('clips in the module', () => {
  const bytes = readFileSync(new URL('../wasm/veronese_bg.wasm', import.meta.url));

  test('holds clips by number, several at a time, until they end', async () => {
    await glue.instantiate(new WebAssembly.Module(bytes));
    const [one, other] = [4_000_000_001, 4_000_000_002];
    for (const clip of [one, other]) glue.beginClip(clip, false, { quality: 'fast', lookAhead: 1 });
    assert.equal(glue.pushClip(one, frame(0, SIZE)), undefined);
    assert.equal(glue.pushClip(one, frame(1, SIZE)).index, 0);
    assert.equal(glue.pushClip(other, frame(0, { width: 32, height: 32 })), undefined);
    assert.throws(() => glue.pushClip(one, frame(2, { width: 70 })), { code: 'frame-size-mismatch' });
    assert.throws(() => glue.pushClip(one, {}), { code: 'invalid-input' });
    assert.equal(glue.pushClip(one, frame(2, SIZE)).index, 1, 'the clip goes on');
    const { frames, dropped } = glue.finishClip(one);
    assert.deepEqual([frames.map(({ index }) => index), dropped], [[2], 0]);
    glue.endClip(other);
    for (const clip of [one, other]) {
      assert.equal(glue.pushClip(clip, frame(0, SIZE)), null);
      assert.equal(glue.finishClip(clip), null);
      glue.endClip(clip);
    }
  });

  test('holds a whole clip: its pairs, then its labels, each call at its time', async () => {
    await glue.instantiate(new WebAssembly.Module(bytes));
    const [clip, again] = [4_000_000_003, 4_000_000_004];
    glue.beginClip(clip, true, { quality: 'fast' });
    const pairs = [0, 1, 2].map((t) => glue.pushClip(clip, frame(t, SIZE)));
    assert.ok(pairs.every((pair) => pair instanceof Uint8Array));
    const left = new Uint8Array(64 * 48).fill(255).fill(9, 0, 999);
    const said = (frame, labels = left) => ({ masks: [], corrections: [{ frame, labels, propagate: 'none' }], prompts: [], numbers: new Uint8Array() });
    const early = () => [glue.saveClip(clip), glue.previewClip(again), glue.clipFrame(clip, 0, frame(0, SIZE)), glue.annotateClip(clip, said(0)), glue.takeAnnotations(clip, frame(0, SIZE)), glue.pushClip(again, frame(0, SIZE)), glue.concludeClip(again)];
    assert.deepEqual(early(), Array(7).fill(null));
    const summary = { length: 3, ...SIZE, dropped: 0 };
    assert.deepEqual(glue.concludeClip(clip), summary);
    assert.equal(glue.pushClip(clip, frame(3, SIZE)), null, 'it is concluded');
    assert.equal(glue.previewClip(clip), null);
    assert.equal(glue.takeAnnotations(clip, frame(0, SIZE)), null, 'nothing was said');
    const saved = glue.saveClip(clip);
    assert.throws(() => glue.clipFrame(clip, 3, frame(3, SIZE)), { code: 'invalid-option' });
    assert.throws(() => glue.annotateClip(clip, said(3)), { code: 'invalid-option' });
    assert.throws(() => glue.annotateClip(clip, said(0, left.slice(1))), { code: 'invalid-option' });
    assert.throws(() => glue.annotateClip(clip, { ...said(0), numbers: Uint8Array.of(0, 1) }), { code: 'invalid-option' });
    assert.throws(() => glue.annotateClip(clip, { ...said(0), locked: Uint8Array.of(9) }), { code: 'object-locked', message: /object 9 is locked/ });
    assert.deepEqual(glue.saveClip(clip), saved, 'nothing has changed');

    assert.deepEqual(glue.annotateClip(clip, said(1)), { changed: [], wanted: 1 });
    const { changed, changes } = glue.takeAnnotations(clip, frame(1, SIZE));
    assert.deepEqual(changed, [1], 'it changes where it is said');
    assert.ok(changes.find(({ object }) => object === 9).gained >= 999);
    glue.restoreClip(clip, saved, false);

    glue.beginClip(again, true, { quality: 'fast' });
    assert.deepEqual([0, 1, 2].map((t) => glue.pushClip(again, frame(t, SIZE), pairs[t])), Array(3).fill(undefined));
    glue.concludeClip(again);
    const state = glue.saveClip(clip);
    assert.deepEqual(glue.saveClip(again), state);
    assert.deepEqual(glue.restoreClip(again, state, false), summary);
    assert.deepEqual(glue.clipFrame(again, 1, frame(1, SIZE)), glue.clipFrame(clip, 1, frame(1, SIZE)));
    for (const one of [clip, again]) glue.endClip(one);
    assert.equal(glue.saveClip(again), null);
  });

  test('refuses options by name', async () => {
    await glue.instantiate(new WebAssembly.Module(bytes));
    for (const lookAhead of [-1, 9, 0.5, NaN, '1', 'whole', null, true, [], {}]) {
      assert.throws(() => glue.beginClip(1, true, { lookAhead }), { code: 'invalid-option', message: /'lookAhead': must be 'all' or a whole number from 0 to 8, not / });
    }
    for (const options of [{ motions: 0 }, { quality: 'good' }, { seed: 1 }, { markUnknown: 1 }, { confidence: true }, 5]) {
      assert.throws(() => glue.beginClip(1, true, options), { code: 'invalid-option' });
    }
    assert.equal(glue.finishClip(1), null, 'nothing was begun');
  });
});
