// The pictures of the stages of a pair. Each function gives what draws one, of the pair and the name of the stage.

import { arrow, canvas, colour, covered, plot, svg } from './figures/kit.mjs';
import { channels, withMasks } from './masks.mjs';

/** The share of the pixels of a plane that have the full colour. */
export const FULL_COLOUR = 0.01;
/** Arrows along the longer side. */
const ARROWS = 24;
const LARGEST_DOT = 10;
/** The colours of candidates by where they come from. */
export const SOURCES = { constraint: 'one', window: 'two', hypothesis: 'four' };

/** The flow of a motion at a place. */
export const flowAt = ([a11, a12, a13, a21, a22, a23], [x, y]) => [a11 * x + a12 * y + a13, a21 * x + a22 * y + a23];
const imageOf = ({ width, height, data }) => new ImageData(new Uint8ClampedArray(data), width, height);

function drawn({ width, height }, image, name) {
  const one = canvas({ width, height, label: `Picture of the stage: ${name.toLowerCase()}` });
  one.getContext('2d').putImageData(image, 0, 0);
  return one;
}

/** A plane of numbers: positive in one colour of the theme, negative in another, zero as the page. */
export function plane({ width, height }, values, full = exceededBy(values, FULL_COLOUR)) {
  return (_, name) => drawn({ width, height }, signed({ width, height }, values, full), name);
}

/** One of the frames. */
export const framed =
  (which) =>
  ({ frames }, name) =>
    drawn(frames[which], imageOf(frames[which]), name);

/** The first frame with full-size labels over it. */
export const masked = (labelsOf) => (pair, name) => drawn(pair.frames[0], withMasks(pair.frames[0], labelsOf(pair)), name);

/** Labels of some level over the first frame at that size. */
export function labelled({ width, height, labels }) {
  return ({ frames: [first] }, name) => {
    const small = new OffscreenCanvas(width, height).getContext('2d');
    const full = new OffscreenCanvas(first.width, first.height);
    full.getContext('2d').putImageData(imageOf(first), 0, 0);
    small.drawImage(full, 0, 0, width, height);
    return drawn({ width, height }, withMasks(small.getImageData(0, 0, width, height), labels), name);
  };
}

/** Each measurement on the first frame, as dark as its weight. */
export function measured({ frames: [first], taken: { measurements, base } }, name) {
  const one = drawn(first, faint(first), name);
  const context = one.getContext('2d');
  context.fillStyle = colour('ink');
  const { places, weights } = measurements ?? { places: [], weights: [] };
  weights.forEach((weight, k) => {
    context.globalAlpha = weight;
    context.fillRect(places[2 * k] - base.scale / 2, places[2 * k + 1] - base.scale / 2, base.scale, base.scale);
  });
  return one;
}

/** Arrows of the local flow relative to the dominant motion, where it is not small. */
export function localFlow({ frames: [first], taken: { base, localFlow: { u, v } } }, name) {
  const { width, height } = first;
  const area = plot({ title: 'Arrows of the local flow', x: [0, width], y: [0, height], width, height, flipped: true });
  const step = Math.max(1, Math.round(Math.max(base.width, base.height) / ARROWS));
  for (let y = step >> 1; y < base.height; y += step) {
    for (let x = step >> 1; x < base.width; x += step) {
      const [from, p] = [[x * base.scale, y * base.scale], y * base.width + x];
      area.marks.append(svg('path', { class: 'arrow', d: arrow(from, [from[0] + u[p], from[1] + v[p]], 0.4 * step * base.scale) }));
    }
  }
  return covered(drawn(first, faint(first), name), area);
}

/** The plane of flows with the candidates. */
export function flows({ frames: [{ width, height }], taken: { candidates, dominant } }) {
  const middle = [width / 2, height / 2];
  const ends = candidates.map(({ matrix: one }) => flowAt(one, middle));
  const reach = 1.1 * Math.max(1, ...ends.flat().map(Math.abs));
  const most = Math.max(1, ...candidates.map(({ gain }) => gain));
  const area = plot({ title: 'The plane of flows with the candidates', x: [-reach, reach], y: [-reach, reach], width: 400, height: 400, names: ['u', 'v'], flipped: true });
  candidates.forEach(({ gain, source }, k) => {
    const [cx, cy] = area.at(...ends[k]);
    area.marks.append(svg('circle', { class: `candidate ${SOURCES[source]}`, cx, cy, r: 2 + LARGEST_DOT * Math.sqrt(Math.max(0, gain) / most) }));
  });
  const [x, y] = area.at(...flowAt(dominant, middle));
  area.marks.append(svg('path', { class: 'line', d: `M${x - 8} ${y - 8}L${x + 8} ${y + 8}M${x - 8} ${y + 8}L${x + 8} ${y - 8}` }));
  return area.element;
}

/** `values` row by row; those of `full` and beyond have the full colour. */
function signed({ width, height }, values, full) {
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
function faint({ width, height, data }) {
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
