// The colours of objects in pictures to look at: bright, and told apart by all eyes.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { objectColour } from 'veronese/colours';
import { overlay } from '../build/cli/overlay.js';

/** Linear colours as usual eyes see them, and without one kind of cone: protanopia, deuteranopia (Machado et al. 2009). */
const EYES = {
  usual: [[1, 0, 0], [0, 1, 0], [0, 0, 1]],
  protanopia: [[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]],
  deuteranopia: [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.01182, 0.04294, 0.968881]],
};

/** A colour in Oklab, in which equal distances look equal. */
function seenBy(colour, eyes) {
  const linear = colour.map((value) => (value <= 10 ? value / 255 / 12.92 : ((value / 255 + 0.055) / 1.055) ** 2.4));
  const [r, g, b] = eyes.map((row) => Math.max(0, row.reduce((sum, entry, k) => sum + entry * linear[k], 0)));
  const l = Math.cbrt(0.4122214708 * r + 0.5363325363 * g + 0.0514459929 * b);
  const m = Math.cbrt(0.2119034982 * r + 0.6806995451 * g + 0.1073969566 * b);
  const s = Math.cbrt(0.0883024619 * r + 0.2817188376 * g + 0.6299787005 * b);
  return [0.2104542553 * l + 0.793617785 * m - 0.0040720468 * s, 1.9779984951 * l - 2.428592205 * m + 0.4505937099 * s, 0.0259040371 * l + 0.7827717662 * m - 0.808675766 * s];
}

const COLOURS = Array.from({ length: 254 }, (_, k) => objectColour(k + 1));
const distance = (one, other) => Math.hypot(...one.map((value, axis) => value - other[axis]));

test('254 colours, each of its own and none dark', () => {
  assert.equal(new Set(COLOURS.map(String)).size, 254);
  for (const colour of COLOURS) assert.ok(seenBy(colour, EYES.usual)[0] > 0.44, String(colour));
});

for (const [name, eyes] of Object.entries(EYES)) {
  test(`${name}: numbers near each other are told apart, on the page and half and half over black`, () => {
    const dark = overlay(new Uint8Array(4 * 254), Uint8Array.from({ length: 254 }, (_, k) => k + 1));
    const tinted = COLOURS.map((_, k) => [...dark.subarray(3 * k, 3 * k + 3)]);
    for (const [colours, scale] of [[COLOURS, 1], [tinted, 0.55]]) {
      const seen = colours.map((colour) => seenBy(colour, eyes));
      for (let k = 1; k < 254; k++) {
        for (let other = Math.max(0, k - 8); other < k; other++) {
          const [next, near] = name === 'usual' ? [0.16, 0.09] : [0.068, 0.058];
          const apart = distance(seen[k], seen[other]);
          assert.ok(apart >= scale * (k - other === 1 ? next : near), `${k + 1} and ${other + 1}: ${apart}`);
        }
      }
    }
  });
}
