// The paper's Figure 1, drawn while its trials are run.

import { computer } from '../compute.mjs';
import { beside, button, choice, controls, html, panel, plot, svg, written } from './kit.mjs';

const LEVELS = [0, 1, 2, 3, 4, 5];
const METHODS = [
  { key: 'factorisation', name: 'Paper, factorisation', tone: 'two' },
  { key: 'refined', name: 'Paper, refined', tone: 'four' },
  { key: 'best', name: 'Ours', tone: 'one' },
  { key: 'oracle', name: 'Yardstick: labels known', tone: 'limit' },
];
/** The paper's own figures for 5 % noise, per cent. */
const STATED = { 2: { factorisation: 6, refined: 2.1 }, 3: { refined: 8.2 }, 4: { refined: 13.3 } };
/** Errors below this are drawn at the bottom, per cent. */
const LEAST = 0.05;
/** Rounds after which the reading is updated. */
const TOLD = [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000];

export default async function mount({ stage, say }) {
  // A trial takes up to some seconds: the other figures do not wait for it.
  const ask = computer();
  const state = { motions: 2, by: 'median', running: false };
  const trials = { 2: emptied(), 3: emptied(), 4: emptied() };

  const chart = drawing(Math.max(280, Math.min(450, stage.clientWidth || 450)));
  const table = tabulated();
  const numbers = panel('', table.element);
  const show = () => {
    numbers.firstChild.textContent = `The same in numbers: ${state.by === 'mean' ? 'means' : 'medians'} in per cent`;
    chart.show(trials[state.motions], state);
    table.show(trials[state.motions], state.by);
  };
  const tell = () => say(sentence(trials[state.motions], state));

  /** One trial for each noise level, while `goesOn`. */
  async function round(motions, goesOn) {
    for (const level of LEVELS) {
      const own = trials[motions][level];
      own.push(await ask('figure1Trial', motions, level / 100, own.length + 1));
      if (!goesOn() || motions !== state.motions) return;
      show();
    }
  }

  async function run() {
    while (state.running) {
      await round(state.motions, () => state.running);
      if (state.running && TOLD.includes(roundsOf(trials[state.motions]))) tell();
    }
  }

  // Requests are worked on one after another.
  let done = Promise.resolve();
  const then = (work) => {
    done = done.then(work).catch((thrown) => {
      turn(false);
      say(`The trials ended: ${thrown.message}`);
    });
  };
  const start = button('Start', () => turn(!state.running));
  function turn(running) {
    state.running = running;
    start.textContent = running ? 'Pause' : 'Go on';
    if (running) then(run);
    show();
    tell();
  }
  document.addEventListener('visibilitychange', () => document.hidden && state.running && turn(false));

  function change(values) {
    Object.assign(state, values);
    show();
    tell();
    const { motions } = state;
    if (!state.running && roundsOf(trials[motions]) === 0) then(() => round(motions, () => true).then(tell));
  }

  await round(state.motions, () => true);
  stage.append(
    beside(panel('Error of the motions against noise', chart.element, legend()), numbers),
    controls(
      start,
      choice({ label: 'Motions', options: [2, 3, 4].map((n) => [n, String(n)]), value: 2, onInput: (motions) => change({ motions }) }),
      choice({ label: 'Show', options: [['median', 'medians'], ['mean', 'means']], value: 'median', onInput: (by) => change({ by }) }),
    ),
  );
  show();
  tell();
}

const emptied = () => LEVELS.map(() => []);
const roundsOf = (levels) => Math.min(...levels.map((own) => own.length));

/** Summaries of one method at one noise level. */
function summary(own, key) {
  const errors = own.map((trial) => trial.errors[key]).sort((a, b) => a - b);
  if (errors.length === 0) return undefined;
  const quantile = (q) => {
    const place = q * (errors.length - 1);
    const [low, high] = [errors[Math.floor(place)], errors[Math.ceil(place)]];
    return low + (place - Math.floor(place)) * (high - low || 0);
  };
  const mean = errors.reduce((sum, error) => sum + error, 0) / errors.length;
  return { mean, median: quantile(0.5), low: quantile(0.25), high: quantile(0.75) };
}

function drawing(width) {
  const [bottom, top] = [Math.log10(LEAST) - 0.3, Math.log10(200)];
  const area = plot({ title: 'Error of the motions, logarithmic, against noise', x: [-0.9, 6.2], y: [bottom, top], width, height: 330 });
  const high = (error) => Math.log10(Math.min(Math.max(error, LEAST), 190));
  const grid = svg('g', { class: 'grid' });
  const series = svg('g');
  area.marks.append(grid, series);
  for (const error of [0.1, 1, 10, 100]) {
    const [, y] = area.at(0, high(error));
    grid.append(svg('line', { x1: 0, x2: width, y1: y, y2: y }), svg('text', { x: 4, y: y - 4 }, `${error} %`));
  }
  for (const level of LEVELS) {
    const [x] = area.at(level, 0);
    grid.append(svg('text', { x, y: 324, 'text-anchor': 'middle' }, level === 5 ? '5 %' : String(level)));
  }
  return {
    element: area.element,
    show(levels, { by, motions }) {
      const parts = METHODS.map(({ key, tone }, m) => {
        const points = levels.map((own, level) => {
          const found = summary(own, key);
          return found && { ...found, x: level + (m - 1.5) * 0.09 };
        });
        const drawn = points.filter(Boolean).map((point) => ({ ...point, place: area.at(point.x, high(point[by])) }));
        const whiskers = drawn.map(({ x, low, high: most, place }) => {
          const [[, y1], [, y2]] = [area.at(x, high(low)), area.at(x, high(most))];
          return svg('line', { x1: place[0], x2: place[0], y1, y2, class: 'whisker' });
        });
        const line = svg('polyline', { points: drawn.map(({ place }) => place.join()).join(' '), class: 'line' });
        const stated = STATED[motions][key];
        return svg('g', { class: `series ${tone}` }, line, ...whiskers, ...drawn.map(({ place }) => mark(key, ...place)), ...(stated ? told(area, high, stated) : []));
      });
      series.replaceChildren(...parts);
    },
  };
}

/** The paper's own figure, at the right. */
function told(area, high, stated) {
  const [x, y] = area.at(5.5, high(stated));
  return [svg('line', { x1: x - 12, x2: area.width - 4, y1: y, y2: y, class: 'stated' }), svg('text', { x: area.width - 4, y: y - 6, 'text-anchor': 'end' }, `${stated} %`)];
}

/** A shape for each method, as colours alone do not tell them apart. */
function mark(key, x, y) {
  if (key === 'best') return svg('circle', { cx: x, cy: y, r: 4.5, class: 'point' });
  if (key === 'factorisation') return svg('rect', { x: x - 4, y: y - 4, width: 8, height: 8, class: 'point' });
  if (key === 'refined') return svg('path', { d: `M${x} ${y - 5.5}l5 9h-10z`, class: 'point' });
  return svg('path', { d: `M${x - 6} ${y}h12`, class: 'line dash' });
}

function legend() {
  const sign = (key, tone) => svg('svg', { viewBox: '0 0 16 16', class: `plot sign ${tone}`, 'aria-hidden': 'true' }, svg('g', { class: `series ${tone}` }, mark(key, 8, 8)));
  return html(
    'ul',
    { class: 'legend' },
    ...METHODS.map(({ key, name, tone }) => html('li', {}, sign(key, tone), name)),
    html('li', {}, svg('svg', { viewBox: '0 0 16 16', class: 'plot sign', 'aria-hidden': 'true' }, svg('line', { x1: 0, x2: 16, y1: 8, y2: 8, class: 'stated' })), 'stated in the paper for 5 %'),
  );
}

function tabulated() {
  const body = html('tbody');
  const names = ['Noise', 'Factorised', 'Refined', 'Ours', 'Labels known', 'Number right, paper', 'Number right, ours'];
  const head = html('tr', {}, ...names.map((name) => html('th', { scope: 'col' }, name)));
  const table = html('table', { class: 'numbers trials' }, html('thead', {}, head), body);
  const element = html('div', { class: 'scroll', tabindex: 0, role: 'region', 'aria-label': 'Errors in numbers' }, table);
  return {
    element,
    show(levels, by) {
      body.replaceChildren(
        ...levels.map((own, level) => {
          const found = METHODS.map(({ key }) => summary(own, key));
          const right = (key) => (own.length > 0 ? `${own.filter((trial) => trial.countRight[key]).length}\u00a0/\u00a0${own.length}` : '–');
          const cells = [...found.map((one) => (one ? short(one[by]) : '–')), right('rule'), right('best')];
          return html('tr', {}, html('th', { scope: 'row' }, `${level} %`), ...cells.map((text) => html('td', {}, text)));
        }),
      );
    },
  };
}

function sentence(levels, { motions, by }) {
  const own = levels[5];
  const named = METHODS.map(({ key, name }) => `${name} ${short(summary(own, key)?.[by] ?? NaN)} %`).join('; ');
  const count = roundsOf(levels);
  if (count === 0) return `${motions} motions: not yet a trial for each noise level.`;
  const right = (key) => own.filter((trial) => trial.countRight[key]).length;
  return `${motions} motions, ${count} ${count === 1 ? 'trial' : 'trials'} for each noise level. ${by === 'mean' ? 'Mean' : 'Median'} errors at 5 % noise: ${named}. The number of motions is right in ${right('rule')} of ${own.length} trials by the paper’s rule, in ${right('best')} by ours.`;
}

function short(error) {
  if (!Number.isFinite(error)) return '–';
  if (error < 1e-3) return '0';
  return written(error, error < 1 ? 2 : error < 10 ? 1 : 0);
}
