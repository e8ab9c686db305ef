// Masks over pictures, in the colours of the motions.

import { MOTIONS, colour } from './figures/kit.mjs';

const FILL = 0.42;
/** The share of white. */
const LIGHTER = 0.5;
const GROUND = 0;
const UNKNOWN = 255;

/** The colour of an object, as CSS classes. There are four, then the same ones lighter. */
export function classOf(object) {
  const name = MOTIONS[(object - 1) % MOTIONS.length];
  return object > MOTIONS.length ? `${name} lighter` : name;
}

/** A frame with the masks of its objects laid over it. Label 0 is the ground, which keeps its colours. */
export function withMasks({ width, height, data }, labels) {
  const picture = new ImageData(new Uint8ClampedArray(data), width, height);
  if (!labels) return picture;
  const plain = MOTIONS.map((name) => channels(colour(name)));
  const tones = [...plain, ...plain.map((tone) => tone.map((value) => value + LIGHTER * (255 - value)))];
  const differs = (p, label, inside, step) => inside && labels[p + step] !== label;
  for (let p = 0; p < labels.length; p++) {
    const label = labels[p];
    if (label === GROUND || label === UNKNOWN) continue;
    const x = p % width;
    const border =
      differs(p, label, x > 0, -1) || differs(p, label, x < width - 1, 1) || differs(p, label, p >= width, -width) || differs(p, label, p + width < labels.length, width);
    const share = border ? 1 : FILL;
    const tone = tones[(label - 1) % tones.length];
    for (let k = 0; k < 3; k++) picture.data[4 * p + k] += share * (tone[k] - picture.data[4 * p + k]);
  }
  return picture;
}

/** Red, green and blue of `#rrggbb`. */
export function channels(hex) {
  const value = Number.parseInt(hex.slice(1), 16);
  return [value >> 16, (value >> 8) & 255, value & 255];
}

/** How many pixels are in an object in one of two images of labels, and in both. */
export function overlap(one, other) {
  let [both, any] = [0, 0];
  for (let p = 0; p < one.length; p++) {
    const [first, second] = [one[p] !== GROUND, other[p] !== GROUND];
    both += first && second;
    any += first || second;
  }
  return { both, any };
}

/** How many pixels have another label. */
export function difference(one, other) {
  let count = 0;
  for (let p = 0; p < one.length; p++) count += one[p] !== other[p];
  return count;
}

/** Sets `label` on the pixels of a stroke. */
export function stamp(labels, { width, height }, { points, radius, label }) {
  points.forEach(([x1, y1], k) => {
    const [x0, y0] = points[Math.max(0, k - 1)];
    const steps = Math.max(1, Math.ceil((2 * Math.hypot(x1 - x0, y1 - y0)) / radius));
    for (let s = 1; s <= steps; s++) disc(x0 + ((x1 - x0) * s) / steps, y0 + ((y1 - y0) * s) / steps);
  });
  function disc(cx, cy) {
    for (let y = Math.max(0, Math.ceil(cy - radius)); y <= Math.min(height - 1, cy + radius); y++) {
      const reach = Math.sqrt(radius * radius - (y - cy) ** 2);
      for (let x = Math.max(0, Math.ceil(cx - reach)); x <= Math.min(width - 1, cx + reach); x++) labels[y * width + x] = label;
    }
  }
}
