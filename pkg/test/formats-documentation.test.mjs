// The worked examples of docs/formats.md: each expression gives what stands below it.

import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { test } from 'node:test';
import * as formats from 'veronese/formats';
import { FORMATS } from '../build/formats/encode.js';

const page = readFileSync(new URL('../../docs/formats.md', import.meta.url), 'utf8');
const size = { width: 5, height: 4 };
const labels = Uint8Array.from([0, 0, 0, 0, 0, 0, 1, 1, 1, 0, 0, 1, 0, 1, 0, 0, 1, 1, 1, 0]);
const motions = [{ label: 0, matrix: [0, 0, 0, 0, 0, 0] }, { label: 1, matrix: [0, 0, 2.5, 0, 0, -1] }];
const given = {
  frame: { labels, ...size, image: 'frame.png', motions },
  metadata: { names: { 1: 'ring' } },
  frames: [
    { labels, ...size, image: 'a.png' },
    { labels: new Uint8Array(20), ...size, image: 'b.png' },
    { labels: Uint8Array.from([0, ...labels.subarray(0, 19)]), ...size, image: 'c.png' },
  ],
  clip: { clip: 'ring.mp4', names: { 1: 'ring' }, frameRate: 10 },
};
const AsyncFunction = (async () => {}).constructor;

const examples = [...page.matchAll(/```js\n(.*)\n```\n\n```(json|text)\n([\s\S]*?)\n```/g)];

test('every format is there, and an example of every call', () => {
  for (const format of Object.keys(FORMATS)) assert.ok(page.includes(`\`${format}\``), format);
  for (const name of Object.keys(formats)) assert.ok(examples.some(([, expression]) => expression.includes(`${name}(`)), name);
});

for (const [, expression, kind, expected] of examples) {
  test(expression, async () => {
    const all = { ...formats, ...given };
    const found = await new AsyncFunction(...Object.keys(all), `return ${expression}`)(...Object.values(all));
    if (kind === 'text') assert.equal(found.trimEnd(), expected);
    else assert.deepEqual(JSON.parse(JSON.stringify(found)), JSON.parse(expected));
  });
}
