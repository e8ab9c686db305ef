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
    for (const clip of [one, other]) glue.beginClip(clip, { quality: 'fast', lookAhead: 1 });
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

  test('refuses options by name', async () => {
    await glue.instantiate(new WebAssembly.Module(bytes));
    for (const lookAhead of [-1, 9, 0.5, NaN, '1', 'whole', null, true, [], {}]) {
      assert.throws(() => glue.beginClip(1, { lookAhead }), { code: 'invalid-option', message: /'lookAhead': must be 'all' or a whole number from 0 to 8, not / });
    }
    for (const options of [{ motions: 0 }, { quality: 'good' }, { seed: -1 }, { markUnknown: true }, 5]) {
      assert.throws(() => glue.beginClip(1, options), { code: 'invalid-option' });
    }
    assert.equal(glue.finishClip(1), null, 'nothing was begun');
  });
});
