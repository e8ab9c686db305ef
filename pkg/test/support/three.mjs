// Six frames in which three textured squares move over a textured ground, each its own way; they are found as objects 1, 2 and 3.

export const SIZE = { width: 96, height: 72 };
export const COUNT = 6;
export const PIXELS = SIZE.width * SIZE.height;

const SIDE = 24;
/** First column, first row, and pixels per frame; by the number under which each is found. */
const SQUARES = { 1: [8, 6, 1.5, 1], 2: [64, 8, -1.5, 1], 3: [34, 42, 1, -1.5] };

const texture = (x, y, phase) =>
  128 + 50 * (Math.sin(0.55 * x + phase) * Math.cos(0.37 * y - phase) + 0.6 * Math.sin(0.21 * x + 0.43 * y) + 0.4 * Math.cos(0.9 * y - 0.3 * x + phase));

const at = (square, index) => {
  const [x, y, u, v] = SQUARES[square];
  return [x + index * u, y + index * v];
};

/** Whether a square is at a pixel of a frame. */
function isIn(square, index, p) {
  const [left, top] = at(square, index);
  const [x, y] = [p % SIZE.width, Math.floor(p / SIZE.width)];
  return x >= left && x < left + SIDE && y >= top && y < top + SIDE;
}

export function frame(index) {
  const data = new Uint8ClampedArray(4 * PIXELS);
  for (let p = 0; p < PIXELS; p++) {
    const [x, y] = [p % SIZE.width, Math.floor(p / SIZE.width)];
    let value = texture(x, y, 0);
    for (const square of [1, 2, 3]) {
      const [, , u, v] = SQUARES[square];
      if (isIn(square, index, p)) value = texture(x - index * u, y - index * v, 2 + 1.7 * square);
    }
    data.set([value, value, value, 255], 4 * p);
  }
  return { data, ...SIZE };
}

/** Labels in a frame: one where a square is, another elsewhere. */
export const labelled = (square, index, inside, outside = 255) => Uint8Array.from({ length: PIXELS }, (_, p) => (isIn(square, index, p) ? inside : outside));

/** A box a pixel wider than a square, and its middle. */
export function box(square, index) {
  const [left, top] = at(square, index).map((side) => Math.floor(side) - 1);
  return [left, top, SIDE + 3, SIDE + 3];
}
export const middle = (square, index) => at(square, index).map((side) => Math.floor(side) + SIDE / 2);
