// Planes of numbers as pictures: positive values in one colour of the theme, negative ones in another, zero as the page.

import { channels } from './masks.mjs';
import { colour } from './figures/kit.mjs';

/** `values` row by row; those of `full` and beyond have the full colour. */
export function signed({ width, height }, values, full) {
  const [ground, above, below] = ['ground', 'two', 'one'].map((name) => channels(colour(name)));
  const picture = new ImageData(width, height);
  for (let p = 0; p < values.length; p++) {
    const tone = values[p] > 0 ? above : below;
    const share = Math.min(1, Math.abs(values[p]) / full);
    for (let k = 0; k < 3; k++) picture.data[4 * p + k] = ground[k] + share * (tone[k] - ground[k]);
    picture.data[4 * p + 3] = 255;
  }
  return picture;
}

/** The frame as a faint grey picture, for marks that are drawn on it. */
export function faint({ width, height, data }) {
  const [r, g, b] = channels(colour('ground'));
  const picture = new ImageData(width, height);
  for (let p = 0; p < data.length; p += 4) {
    const grey = 0.3 * data[p] + 0.59 * data[p + 1] + 0.11 * data[p + 2];
    picture.data.set([0.6 * r + 0.4 * grey, 0.6 * g + 0.4 * grey, 0.6 * b + 0.4 * grey, 255], p);
  }
  return picture;
}

/** Root of the mean square. */
export function size(values) {
  let sum = 0;
  for (const value of values) sum += value * value;
  return Math.sqrt(sum / values.length);
}

/** The magnitude that a share of the values exceeds. */
export function exceededBy(values, share) {
  const sorted = Float32Array.from(values, Math.abs).sort();
  return sorted[Math.floor((1 - share) * (sorted.length - 1))];
}
