// Points on lines through the origin: the degree at which their monomials first become dependent is the number of lines.

import { ask, latest } from '../compute.mjs';
import { KAPPA, spectrum } from '../spectrum.mjs';
import { MOTIONS, beside, choice, controls, handle, html, panel, plot, random, segment, set, slider, svg, written } from './kit.mjs';

const POINTS = 36;
const DEGREES = [1, 2, 3, 4, 5];
const RANGE = [-1.2, 1.2];
/** Angles of the lines at the beginning, degrees. */
const START = [25, 80, 140, 172];
const RAISED = ['', '', '²', '³', '⁴', '⁵'];

export default async function mount({ stage, say }) {
  const state = { count: 2, noise: 0, angles: [...START] };
  const cast = positions();

  const area = plot({ title: 'Points on lines through the origin', x: RANGE, y: RANGE, width: 400, height: 400, names: ['x', 'y'] });
  const truth = MOTIONS.map((name) => svg('line', { class: `line thin ${name}` }));
  const found = svg('g');
  const dots = svg('g');
  area.marks.append(...truth, found, dots);
  const handles = MOTIONS.map((name, i) =>
    handle(area, {
      label: `Line ${i + 1}`,
      at: onCircle(state.angles[i]),
      step: 1,
      colour: name,
      along: { place: (degrees) => onCircle(degrees), nearest: degreesOf, min: -180, max: 180, closed: true },
      describe: (place) => `${written(degreesOf(place), 0)}°`,
      onMove(place) {
        state.angles[i] = degreesOf(place);
        void show();
      },
    }),
  );

  const rows = DEGREES.map(row);
  const list = html('ol', { class: 'degrees' }, ...rows.map(({ element }) => element));

  const show = latest(async () => {
    const { points, labels } = pointsOf(state, cast);
    const maps = await Promise.all(DEGREES.map((degree) => ask('veroneseMap', points, 2, degree)));
    const first = maps.findIndex(({ rank, columns }) => rank < columns);
    maps.forEach((map, k) => rows[k].show(map, k === first, labels));
    const lines = maps[first]?.lines ?? [];
    truth.forEach((line, i) => {
      line.toggleAttribute('hidden', i >= state.count);
      set(line, segment(area, normal(state.angles[i])));
    });
    handles.forEach(({ element }, i) => element.toggleAttribute('hidden', i >= state.count));
    found.replaceChildren(...lines.map((line) => svg('line', { class: 'line guide', ...segment(area, [...line, 0]) })));
    dots.replaceChildren(
      ...labels.map((label, j) => {
        const [cx, cy] = area.at(points[2 * j], points[2 * j + 1]);
        return svg('circle', { cx, cy, r: 3.5, class: `point ${MOTIONS[label]}` });
      }),
    );
    say(sentence(state, maps, first));
  });

  stage.append(
    beside(panel('36 points, one colour for each line', area.element), panel('Their monomials, degree by degree', list)),
    controls(
      choice({ label: 'Lines', options: [1, 2, 3, 4].map((n) => [n, String(n)]), value: state.count, onInput: (n) => void ((state.count = n), show()) }),
      slider({ label: 'Noise', min: 0, max: 6, step: 0.25, value: 0, format: (value) => `${value} %`, onInput: (value) => void ((state.noise = value / 100), show()) }),
    ),
  );
  await show();
}

/** One degree: the matrix of its monomials, its singular values, its rank. */
function row(degree) {
  const bars = spectrum({ width: 96, height: 46 });
  const strip = svg('svg', { class: 'monomials', preserveAspectRatio: 'none', 'aria-hidden': 'true' });
  const rank = html('span', { class: 'rank' });
  const name = html('span', { class: 'name' }, html('b', {}, `n = ${degree}`), ` ${monomials(degree)}`);
  const element = html('li', {}, html('div', { class: 'head' }, name, rank), strip, bars.element);
  return {
    element,
    show(map, isFirst, labels) {
      bars.show([...map.singularValues], KAPPA);
      heat(strip, map, labels);
      element.classList.toggle('first', isFirst);
      const lost = map.columns - map.rank;
      rank.textContent = `rank ${map.rank} of ${map.columns}${lost > 0 ? `: ${lost} missing` : ''}`;
    },
  };
}

/** The matrix, transposed: a column for each point, a row for each monomial, pale near zero. Below, the colours of the points' lines. */
function heat(strip, { matrix, rows, columns }, labels) {
  const foot = 0.1 * columns;
  set(strip, { viewBox: `0 0 ${rows} ${columns + 1.5 * foot}` });
  const cells = Array.from({ length: rows * columns }, (_, k) => {
    const [point, monomial] = [Math.floor(k / columns), k % columns];
    const value = matrix[k];
    return svg('rect', { x: point, y: monomial, width: 0.92, height: 0.92, class: value < 0 ? 'minus' : 'plus', 'fill-opacity': Math.min(1, Math.sqrt(Math.abs(value))).toFixed(3) });
  });
  const feet = labels.map((label, j) => svg('rect', { x: j, y: columns + foot / 2, width: 1, height: foot, class: `point ${MOTIONS[label]}` }));
  strip.replaceChildren(...cells, ...feet);
}

function monomials(degree) {
  const power = (name, k) => (k === 0 ? '' : name + RAISED[k]);
  return Array.from({ length: degree + 1 }, (_, k) => power('x', degree - k) + power('y', k)).join(', ');
}

/** Where points lie along their lines, and where noise takes them. */
function positions() {
  const draw = random(7);
  const between = () => 2 * draw() - 1;
  return Array.from({ length: POINTS }, () => ({ along: (0.25 + 0.75 * draw()) * (draw() < 0.5 ? -1 : 1), dx: between(), dy: between() }));
}

/** The points, those of one line after those of another, along it. */
function pointsOf({ count, noise, angles }, all) {
  const line = (j) => Math.floor((j * count) / POINTS);
  const cast = all.map((point, j) => ({ ...point, label: line(j) })).sort((one, other) => one.label - other.label || one.along - other.along);
  const labels = cast.map(({ label }) => label);
  const points = cast.flatMap(({ along, dx, dy }, j) => {
    const angle = radians(angles[labels[j]]);
    return [along * Math.cos(angle) + noise * dx, along * Math.sin(angle) + noise * dy];
  });
  return { points: new Float64Array(points), labels };
}

const radians = (degrees) => (degrees * Math.PI) / 180;
const degreesOf = ([x, y]) => (Math.atan2(y, x) * 180) / Math.PI;
const onCircle = (degrees) => [1.1 * Math.cos(radians(degrees)), 1.1 * Math.sin(radians(degrees))];
const normal = (degrees) => [Math.sin(radians(degrees)), -Math.cos(radians(degrees)), 0];

function sentence({ count, noise, angles }, maps, first) {
  const ranks = maps.map(({ rank, columns }, k) => `degree ${k + 1}: ${rank} of ${columns}`).join('; ');
  const at = angles.slice(0, count).map((angle) => `${written(((angle % 180) + 180) % 180, 0)}°`);
  const given = `${count} ${count === 1 ? 'line' : 'lines'} at ${at.join(', ')}, noise ${written(noise * 100)} %.`;
  if (first < 0) return `${given} Ranks by ${ranks}. No matrix loses a rank: with this noise no degree fits.`;
  const degree = first + 1;
  const answer = `The first that is not full is that of degree ${degree}`;
  return `${given} Ranks by ${ranks}. ${answer}: ${degree === count ? `${degree} ${degree === 1 ? 'line' : 'lines'}, which is right.` : `it says ${degree}, which is wrong.`}`;
}
