// Two frames in which something moves; plain JavaScript, for any surroundings.

/** Smooth texture without symmetry, in grey levels; (x, y) may be fractional. */
function texture(x, y, phase) {
  const value =
    Math.sin(0.55 * x + phase) * Math.cos(0.37 * y - phase) + 0.6 * Math.sin(0.21 * x + 0.43 * y) + 0.4 * Math.cos(0.9 * y - 0.3 * x);
  return 128 + 50 * value;
}

/**
 * A textured background and, over it, a textured square of a quarter of the frame. Between the first frame (t = 0) and the
 * second (t = 1) the background moves by `background` pixels, the square by `square`.
 */
export function frame(t, { width = 64, height = 48, background = [0, 0], square = [2, 1] } = {}) {
  const data = new Uint8ClampedArray(width * height * 4);
  const side = Math.floor(Math.min(width, height) / 2);
  const [left, top] = [Math.floor(width / 4) + t * square[0], Math.floor(height / 4) + t * square[1]];
  for (let y = 0; y < height; y++) {
    for (let x = 0; x < width; x++) {
      const inside = x >= left && x < left + side && y >= top && y < top + side;
      const [u, v] = inside ? square : background;
      const value = texture(x - t * u, y - t * v, inside ? 2 : 0);
      data.set([value, value, value, 255], 4 * (y * width + x));
    }
  }
  return { data, width, height };
}

/** First and second frame. */
export function pair(options) {
  return [frame(0, options), frame(1, options)];
}
