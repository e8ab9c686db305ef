// The multibody motion of two motions taken apart in two ways: by roots of its columns and rows, and by its derivatives at a pixel.

import { ask, latest } from '../compute.mjs';
import { MOTIONS, arrow, button, controls, handle, html, panel, plot, set, slider, svg, written } from './kit.mjs';

const COUNT = 600;
/** With this noise step 5 guesses wrong where it cannot know. With other noise it may be right by luck. */
const SEED = 17;
const FIRST = [0, -0.05, 0.45, -0.25, 0.15, 0.4];
const SHARES = new Float64Array([1, 1]);
const LINEAR = [-0.2, -0.6, -0.35, -0.55];
/** From the third column of the first motion to that of the second, at distance 1. */
const APART = [-0.85, -0.9];
/** Pixels of the magnifier per unit. */
const MAGNIFIED = 1400;

export default async function mount({ stage, say }) {
  const state = { seed: SEED, distance: 1, noise: 0.003, pixel: [0.6, -0.6], angle: (52 * Math.PI) / 180 };
  // Third columns are flows at the origin, which the method moves to the centre of the measurements.
  let centre = [0, 0];

  const columns = columnsPlot();
  const image = imagePlot(state, () => void show());
  const curve = curvePlot();
  const results = ['Roots', 'Derivatives at this pixel', 'Derivatives, best of 60 pixels'].map(result);

  const pairs = html('p', { class: 'verdict' });

  const show = latest(async () => {
    const truth = [FIRST, second(state.distance, centre)];
    const { positions, derivatives } = await ask('motionMeasurements', new Float64Array(truth.flat()), SHARES, COUNT, state.noise, state.seed);
    const [stages, here] = await Promise.all([
      ask('paperStages', positions, derivatives, 2),
      ask('motionsAtPixel', positions, derivatives, 2, ...state.pixel, state.angle),
    ]);
    const isPaired = columns.show(stages, truth, centre);
    pairs.textContent = isPaired ? 'Each row is with its own motion.' : 'Rows of two motions are together.';
    pairs.classList.toggle('wrong', !isPaired);
    image.show(truth, state);
    curve.show(here, truth, state);
    const errors = [stages.factorisation, here.motions, stages.differentiation].map((found) => errorOf(truth, found));
    results.forEach((one, k) => one.show(errors[k]));
    say(sentence(state, stages, isPaired, errors));
  });

  const change = (values) => {
    Object.assign(state, values);
    void show();
  };
  const apart = slider({ label: 'Distance', min: 0, max: 1, step: 0.01, value: 1, format: (value) => written(value), onInput: (distance) => change({ distance }) });
  const direction = slider({ label: 'Gradient', min: 0, max: 180, step: 1, value: 52, format: (value) => `${value}°`, onInput: (value) => change({ angle: (value * Math.PI) / 180 }) });
  const noise = slider({ label: 'Noise', min: 0, max: 1, step: 0.1, value: 0.3, format: (value) => `${value} %`, onInput: (value) => change({ noise: value / 100 }) });
  stage.append(
    html(
      'div',
      { class: 'beside thirds' },
      panel('By roots', columns.element, apart, pairs),
      panel('By derivatives, at a pixel', image.element, noise),
      panel('The polynomial at that pixel', curve.element, direction),
    ),
    controls(button('Other noise', () => change({ seed: state.seed + 1 }))),
    html('ul', { class: 'results' }, ...results.map(({ element }) => element)),
  );
  const { positions, derivatives } = await ask('motionMeasurements', new Float64Array([...FIRST, ...second(1, centre)]), SHARES, COUNT, 0, SEED);
  ({ centre } = (await ask('paperStages', positions, derivatives, 2)).normalisation);
  await show();
}

/** The second motion: its flow at the centre lies `distance` · APART from that of the first. */
function second(distance, centre) {
  const [a, b, c, d] = LINEAR;
  const [u, v] = flow(FIRST, centre).map((value, k) => value + distance * APART[k]);
  return [a, b, u - a * centre[0] - b * centre[1], c, d, v - c * centre[0] - d * centre[1]];
}

const flow = (a, [x, y]) => [a[0] * x + a[1] * y + a[2], a[3] * x + a[4] * y + a[5]];
const distance = (one, other) => Math.hypot(...one.map((value, k) => value - other[k]));
/** Of two found things, whether the first is the second true one. */
const swapped = ([f, g], [s, t]) => distance(f, t) + distance(g, s) < distance(f, s) + distance(g, t);

/** The mean relative error of the motions (20), per cent; undefined where two were not found. */
function errorOf(truth, found) {
  if (found.length !== 2) return undefined;
  const ordered = swapped(found, truth) ? [found[1], found[0]] : found;
  const relative = truth.map((a, i) => distance(a, ordered[i]) / Math.hypot(...a, 1));
  return 50 * (relative[0] + relative[1]);
}

/**
 * The third columns as rings; each pair of rows that step 5 makes as a cross. The colours say to which true motion each part belongs. Where
 * all is close together, a magnifier shows it.
 */
function columnsPlot() {
  const area = plot({ title: 'Third columns, and the third entries of rows', x: [-0.75, 0.75], y: [-0.75, 0.75], width: 300, height: 300, flipped: true, names: ['a₁₃', 'a₂₃'] });
  const parts = svg('g');
  const closer = svg('svg', { x: 8, y: 150, width: 126, height: 126, viewBox: '-63 -63 126 126' });
  area.marks.append(parts, closer);
  return {
    element: area.element,
    show({ thirdColumns, factorisation }, truth, centre) {
      const rows = [0, 3].map((first) => {
        const entries = (a) => a.slice(first, first + 3);
        const isSwapped = swapped(factorisation.map(entries), truth.map(entries));
        return factorisation.map((_, i) => MOTIONS[isSwapped ? 1 - i : i]);
      });
      const isSwapped = swapped(thirdColumns, truth.map((a) => flow(a, centre)));
      const columns = thirdColumns.map((_, i) => MOTIONS[isSwapped ? 1 - i : i]);
      const drawn = (at) =>
        factorisation.flatMap((a, i) => {
          const [x, y] = at(...flow(a, centre));
          const [cx, cy] = at(...thirdColumns[i]);
          return [
            svg('line', { x1: x, x2: x, y1: -300, y2: 600, class: `line thin ${rows[0][i]}` }),
            svg('line', { x1: -300, x2: 600, y1: y, y2: y, class: `line thin ${rows[1][i]}` }),
            svg('line', { x1: x, x2: x, y1: y - 14, y2: y + 14, class: `line bold ${rows[0][i]}` }),
            svg('line', { x1: x - 14, x2: x + 14, y1: y, y2: y, class: `line bold ${rows[1][i]}` }),
            svg('circle', { cx, cy, r: 8, class: `line bold ${columns[i]}` }),
          ];
        });
      parts.replaceChildren(...drawn(area.at));
      const middle = [0, 1].map((k) => (thirdColumns[0][k] + thirdColumns[1][k]) / 2);
      const isClose = distance(...thirdColumns) < 0.08;
      closer.toggleAttribute('hidden', !isClose);
      const magnified = (u, v) => [u - middle[0], v - middle[1]].map((value) => MAGNIFIED * value);
      if (isClose) closer.replaceChildren(svg('rect', { x: -63, y: -63, width: 126, height: 126, class: 'lens' }), ...drawn(magnified));
      return rows[0].every((owner, i) => owner === rows[1][i]);
    },
  };
}

/** The pixel, and where the two motions take it. */
function imagePlot(state, change) {
  const area = plot({ title: 'The pixel at which the polynomial is differentiated', x: [-1, 1], y: [-1, 1], width: 300, height: 300, flipped: true, names: ['x', 'y'] });
  const arrows = MOTIONS.slice(0, 2).map((name) => svg('path', { class: `arrow ${name}` }));
  const gradient = svg('line', { class: 'line guide' });
  area.marks.append(gradient, ...arrows);
  handle(area, {
    label: 'Pixel',
    at: state.pixel,
    step: 0.02,
    onMove(place) {
      state.pixel = place;
      change();
    },
  });
  return {
    element: area.element,
    show(truth, { pixel, angle }) {
      const [x, y] = area.at(...pixel);
      const [dx, dy] = [45 * Math.cos(angle), 45 * Math.sin(angle)];
      set(gradient, { x1: x - dx, y1: y - dy, x2: x + dx, y2: y + dy });
      truth.forEach((a, i) => {
        const [u, v] = flow(a, pixel);
        set(arrows[i], { d: arrow([x, y], area.at(pixel[0] + u / 2, pixel[1] + v / 2)) });
      });
    },
  };
}

/** The polynomial in I_t at the pixel, for a gradient of length 1 in the chosen direction. */
function curvePlot() {
  const area = plot({ title: 'The polynomial in the temporal derivative', x: [-1.6, 1.6], y: [-1.15, 1.35], width: 300, height: 300, names: ['Iₜ', 'p'] });
  const line = svg('polyline', { class: 'line' });
  const tangents = svg('g');
  const dots = svg('g');
  area.marks.append(line, tangents, dots);
  return {
    element: area.element,
    show({ coefficients, roots }, truth, { pixel, angle }) {
      const value = (t) => coefficients.reduceRight((sum, c) => sum * t + c, 0);
      const slope = (t) => coefficients.reduceRight((sum, c, k) => (k === 0 ? sum : sum * t + k * c), 0);
      const samples = Array.from({ length: 81 }, (_, k) => area.x[0] + (k / 80) * (area.x[1] - area.x[0]));
      set(line, { points: samples.map((t) => area.at(t, value(t)).join()).join(' ') });
      // Each root is named by the true motion whose prediction, by brightness constancy, is nearest.
      const expected = truth.map((a) => {
        const [u, v] = flow(a, pixel);
        return [-(Math.cos(angle) * u + Math.sin(angle) * v)];
      });
      const real = roots.map(([t]) => t);
      const isSwapped = real.length === 2 && swapped(real.map((t) => [t]), expected);
      const named = real.map((t, i) => ({ t, name: MOTIONS[isSwapped ? 1 - i : i], at: area.at(t, 0) }));
      tangents.replaceChildren(
        ...named.map(({ t, name }) => {
          const [[x1, y1], [x2, y2]] = [-0.22, 0.22].map((step) => area.at(t + step, step * slope(t)));
          return svg('line', { x1, y1, x2, y2, class: `line ${name}` });
        }),
      );
      dots.replaceChildren(...named.map(({ name, at: [cx, cy] }) => svg('circle', { cx, cy, r: 6, class: `point ${name}` })));
    },
  };
}

/** One method: its error as a bar on a logarithmic scale from 0.001 to 100 %. */
function result(name) {
  const bar = svg('rect', { height: 12, class: 'kept' });
  const output = html('output');
  const element = html('li', {}, html('span', {}, name), svg('svg', { viewBox: '0 0 200 12', preserveAspectRatio: 'none', 'aria-hidden': 'true' }, bar), output);
  return {
    element,
    show(error) {
      const share = error === undefined ? 1 : Math.min(1, Math.max(0.01, (Math.log10(error) + 3) / 5));
      set(bar, { width: 200 * share });
      element.classList.toggle('bad', error === undefined || error > 10);
      output.textContent = percent(error);
    },
  };
}

function percent(error) {
  if (error === undefined) return 'nothing found';
  if (error >= 0.01) return `${written(error, error < 1 ? 2 : 1)} %`;
  return `about 10${[...String(Math.round(Math.log10(error)))].map((sign) => '⁰¹²³⁴⁵⁶⁷⁸⁹'[sign] ?? '⁻').join('')} %`;
}

function sentence({ distance: apart, noise, pixel, angle }, { ambiguous }, isPaired, [roots, here, best]) {
  const pairs = isPaired ? 'each row is given to its motion' : 'rows of different motions are put together';
  const doubt = ambiguous ? ' The third columns cannot tell which row belongs to which motion.' : '';
  return `Third columns at distance ${written(apart)}, noise ${written(noise * 100, 1)} %. By roots, ${pairs}: error ${percent(roots)}.${doubt} By derivatives at the pixel ${written(pixel[0])}, ${written(pixel[1])} along ${written((angle * 180) / Math.PI, 0)}°: error ${percent(here)}; at the best of 60 pixels: ${percent(best)}.`;
}
