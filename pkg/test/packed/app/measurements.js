// Measurements of two motions, a translation each, for fitMotions.

const MOTIONS = [[1, -0.5], [-2, 1.5]];
const COUNT = 60;

export const measurements = { positions: new Float64Array(2 * COUNT), derivatives: new Float64Array(3 * COUNT) };
for (let j = 0; j < COUNT; j++) {
  const [u, v] = MOTIONS[j % 2];
  const [a, b] = [((7 * j) % 11) - 5, ((5 * j) % 13) - 6];
  measurements.positions.set([(37 * j) % 320, (53 * j) % 240], 2 * j);
  measurements.derivatives.set([a, b, -(a * u + b * v)], 3 * j);
}
