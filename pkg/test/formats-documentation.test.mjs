// The worked examples of docs/formats.md: each expression gives what stands below it.

import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { test } from 'node:test';
import * as formats from 'veronese/formats';

const page = readFileSync(new URL('../../docs/formats.md', import.meta.url), 'utf8');
const labels = Uint8Array.from([0, 0, 0, 0, 0, 0, 1, 1, 1, 0, 0, 1, 0, 1, 0, 0, 1, 1, 1, 0]);
const meta = {
  image: 'frame.png',
  names: { 0: 'ground', 1: 'ring' },
  labels: [1],
  motions: [
    { label: 0, matrix: [0, 0, 0, 0, 0, 0] },
    { label: 1, matrix: [0, 0, 2.5, 0, 0, -1] },
  ],
};
const size = { width: 5, height: 4 };
const frames = [
  { labels, ...size, image: 'a.png' },
  { labels: new Uint8Array(20), ...size, image: 'b.png' },
  { labels: Uint8Array.from([0, ...labels.subarray(0, 19)]), ...size, image: 'c.png' },
];
const clip = { clip: 'ring.mp4', names: { 0: 'ground', 1: 'ring' }, labels: [1], tracked: true, frameRate: 10 };

const examples = [...page.matchAll(/```js\n(.*)\n```\n\n```(json|text)\n([\s\S]*?)\n```/g)];

test('there is an example for every encoder', () => {
  const shown = examples.map(([, expression]) => expression).join('\n');
  for (const name of Object.keys(formats)) assert.ok(shown.includes(`${name}(`), name);
});

for (const [, expression, kind, expected] of examples) {
  test(expression, () => {
    const found = new Function('formats', 'labels', 'meta', 'frames', 'clip', `with (formats) { return ${expression} }`)(formats, labels, meta, frames, clip);
    if (kind === 'text') assert.equal(found.trimEnd(), expected);
    else assert.deepEqual(JSON.parse(JSON.stringify(found)), JSON.parse(expected));
  });
}
