// The pixels of two motions, without labels: as lines in the plane of motions, and as points on one conic.

import { ask, latest } from '../compute.mjs';
import { MOTIONS, beside, controls, formula, handle, html, panel, plot, random, segment, set, slider, svg, toggle, written } from './kit.mjs';

const MOST_PIXELS = 40;
/** Gradients are within this angle of the horizontal: the second plot divides by I_x, and all pixels shall be in it. */
const STEEPEST = 1.05;
const REACH = 1.85;
/** The largest motion. */
const MOST = 1.4;
const TERMS = [
  ['I_x^2', 'u_1 u_2'],
  ['I_x I_y', 'u_1 v_2 + v_1 u_2'],
  ['I_x I_t', 'u_1 + u_2'],
  ['I_y^2', 'v_1 v_2'],
  ['I_y I_t', 'v_1 + v_2'],
  ['I_t^2', '1'],
];
/** A singular value below this share of the largest, or a product below it, is rounding. */
const ROUNDING = 1e-9;

export default async function mount({ stage, say }) {
  const motions = [
    [0.8, 0.6],
    [-0.7, -0.5],
  ];
  const pixels = gradients();
  let count = MOST_PIXELS;
  let seen = 0;

  const plane = plot({ title: 'The plane of motions', x: [-1.8, 1.8], y: [-1.8, 1.8], width: 360, height: 360, names: ['u', 'v'], flipped: true });
  const dual = plot({ title: 'The pixels as points', x: [-REACH, REACH], y: [-3.2, 3.2], width: 360, height: 360, names: ['p', 'q'] });
  const between = svg('path', { class: 'fill' });
  const conic = svg('path', { class: 'line guide' });
  const lines = pixels.map(() => svg('line'));
  const points = pixels.map(() => svg('circle'));
  const names = MOTIONS.slice(0, 2).map((tone, body) => svg('text', { class: tone, 'text-anchor': 'middle' }, String(body + 1)));
  plane.marks.append(...lines, ...names);
  dual.marks.append(between, conic, ...points);
  const numbers = TERMS.map(() => html('dd', { class: 'value' }));
  const terms = TERMS.map(([monomial, meaning], k) => html('div', {}, html('dt', {}, formula(monomial)), numbers[k], html('dd', {}, formula(`= ${meaning}`))));

  let coloured = false;
  const paint = () => {
    for (const [k, { body }] of pixels.entries()) {
      const tone = coloured ? MOTIONS[body] : '';
      const state = k === seen ? 'seen' : 'thin';
      set(lines[k], { class: `line ${tone} ${state}`, visibility: k < count ? 'visible' : 'hidden' });
      set(points[k], { class: `point ${tone}`, r: k === seen ? 7 : 4, visibility: k < count ? 'visible' : 'hidden' });
    }
  };

  const show = latest(async () => {
    const measured = pixels.slice(0, count).map(({ ix, iy, body }) => [ix, iy, -ix * motions[body][0] - iy * motions[body][1]]);
    const { coefficients, singularValues } = await ask('multibodyFlow', Float64Array.from(measured.flat()), 2);
    for (const [k, y] of measured.entries()) {
      set(lines[k], segment(plane, y) ?? { x1: 0, y1: 0, x2: 0, y2: 0 });
      const [cx, cy] = dual.at(y[1] / y[0], -y[2] / y[0]);
      set(points[k], { cx, cy });
    }
    for (const [body, name] of names.entries()) {
      const [x, y] = plane.at(...motions[body]);
      set(name, { x: x + 16, y: y - 10 });
    }
    paint();
    const isOne = singularValues[4] > ROUNDING * singularValues[0];
    const [upper, lower] = isOne ? branches(coefficients).map((branch) => branch.map((point) => dual.at(...point).join(' '))) : [[], []];
    set(conic, { d: isOne ? `M${upper.join('L')}M${lower.join('L')}` : '' });
    set(between, { d: isOne ? `M${[...upper, ...lower.toReversed()].join('L')}Z` : '' });
    for (const [k, value] of numbers.entries()) value.textContent = isOne ? written(coefficients[k], 3) : '?';
    if (!isOne) return say(`More than one conic goes through the ${count} pixels: the two motions are the same.`);
    const largest = Math.max(...measured.map((y) => Math.abs(product(coefficients, y))));
    const [ix, iy, it] = measured[seen];
    const [first, second] = motions.map(([u, v]) => written(ix * u + iy * v + it, 3));
    return say(
      `One conic goes through all ${count} pixels. Its coefficients are ${coefficients.map((value) => written(value)).join('; ')}. ` +
        `The product is ${largest < ROUNDING ? '0' : `at most ${written(largest, 4)}`} at every pixel. ` +
        `At pixel ${seen + 1} the first factor is ${first} and the second is ${second}.`,
    );
  });

  for (const [body, tone] of MOTIONS.slice(0, 2).entries()) {
    handle(plane, {
      label: `Motion ${body + 1} in pixels per frame`,
      at: motions[body],
      step: 0.05,
      colour: tone,
      describe: ([u, v]) => `u ${written(u)}, v ${written(v)}`,
      onMove(to) {
        const length = Math.hypot(...to);
        motions[body] = length > MOST ? to.map((part) => (part * MOST) / length) : to;
        void show();
        return motions[body];
      },
    });
  }

  const look = slider({
    label: 'Look at',
    min: 1,
    max: MOST_PIXELS,
    step: 1,
    value: seen + 1,
    format: (now) => `pixel ${now}`,
    onInput(now) {
      seen = Math.min(now, count) - 1;
      void show();
    },
  });
  const use = slider({
    label: 'Pixels',
    min: 5,
    max: MOST_PIXELS,
    step: 1,
    value: count,
    onInput(now) {
      count = now;
      seen = Math.min(seen, count - 1);
      void show();
    },
  });
  const truth = toggle({
    label: 'Colour by truth',
    onInput(on) {
      coloured = on;
      paint();
    },
  });
  const number = look.querySelector('input');
  points.forEach((point, k) =>
    point.addEventListener('click', () => {
      number.value = k + 1;
      number.dispatchEvent(new Event('input'));
    }),
  );
  stage.append(
    beside(panel('The motions that each pixel allows', plane.element), panel('The pixels as points of a conic', dual.element)),
    html('dl', { class: 'terms', 'aria-label': 'The coefficients of the conic' }, ...terms),
    controls(use, look, truth),
  );
  await show();
}

/** Gradients of pixels on two bodies in turn. */
function gradients() {
  const draw = random(11);
  return Array.from({ length: MOST_PIXELS }, (_, k) => {
    const [angle, length] = [STEEPEST * (2 * draw() - 1), 0.4 + 0.6 * draw()];
    return { ix: length * Math.cos(angle), iy: length * Math.sin(angle), body: k % 2 };
  });
}

/** The value of the conic at a pixel. */
const product = ([a, b, c, d, e, f], [ix, iy, it]) => a * ix * ix + b * ix * iy + c * ix * it + d * iy * iy + e * iy * it + f * it * it;

/** The conic as two curves: the q that solve it for each p, where I_x = 1, I_y = p and I_t = −q. */
function branches([a, b, c, d, e, f]) {
  const at = Array.from({ length: 121 }, (_, k) => -REACH + (k * 2 * REACH) / 120);
  return [1, -1].map((sign) =>
    at.map((p) => {
      const [linear, constant] = [c + e * p, a + b * p + d * p * p];
      return [p, (linear + sign * Math.sqrt(Math.max(0, linear * linear - 4 * f * constant))) / (2 * f)];
    }),
  );
}
