// Theorem 1: the matrix of the embedded measurements first loses exactly one rank at the number of motions. Noise, and what we do instead.

import { ask, latest } from '../compute.mjs';
import { KAPPA, rankAt, spectrum } from '../spectrum.mjs';
import { beside, button, choice, controls, html, panel, random, set, slider, svg, written } from './kit.mjs';

const COUNT = 600;
/** Most motions that the rule is tried for. */
const MOST = 5;
/** How long the input rests before our own estimate begins, which takes longer than the ranks, milliseconds. */
const REST = 250;

export default async function mount({ stage, say }) {
  const state = { motions: 2, noise: 0, kappa: KAPPA, seed: 1 };
  let values;
  let fit;

  const rows = Array.from({ length: MOST }, (_, k) => row(k + 1));
  const paper = html('p', { class: 'verdict' });
  const bars = scores();
  const ours = html('p', { class: 'verdict' });

  /** Reads the ranks off the bars. */
  const read = () => {
    const ranks = values.map((own) => rankAt(own, state.kappa));
    const columns = values.map((own) => own.length);
    const first = ranks.findIndex((rank, k) => rank < columns[k]);
    const fires = first >= 0 && ranks[first] === columns[first] - 1;
    values.forEach((own, k) => rows[k].show(own, state.kappa, ranks[k], k === first));
    judge(paper, ruling(first, fires, columns[first] - ranks[first]), first + 1 === state.motions);
    bars.show(fit?.evidence.candidates);
    judge(ours, fit && `The lowest score is that of ${counted(fit.count)}`, fit?.count === state.motions);
    const text = ranks.map((rank, k) => `n = ${k + 1}: rank ${rank} of ${columns[k]}`).join('; ');
    const mine = fit ? ` Our scores: ${ours.textContent}` : '';
    say(`${counted(state.motions)} in truth, noise ${written(state.noise * 100, 1)} %, threshold ${small(state.kappa)}. ${text}. ${paper.textContent}${mine}`);
  };

  let resting;
  const show = latest(async () => {
    const { positions, derivatives } = await measured(state);
    const spectra = await ask('embeddedSpectra', positions, derivatives, MOST);
    values = spectra.map(({ singularValues }) => singularValues);
    fit = undefined;
    read();
    clearTimeout(resting);
    resting = setTimeout(() => void estimate(positions, derivatives), REST);
  });

  let newest = 0;
  async function estimate(positions, derivatives) {
    const own = ++newest;
    const found = await ask('fitMotions', positions, derivatives, {});
    if (own !== newest) return;
    fit = found;
    read();
  }
  const change = (values) => {
    Object.assign(state, values);
    clearTimeout(resting);
    newest++;
    void show();
  };

  stage.append(
    beside(
      panel('The paper: the singular values of each matrix', html('ol', { class: 'degrees' }, ...rows.map(({ element }) => element)), paper),
      panel('Ours: a score for each number', bars.element, ours),
    ),
    controls(
      choice({ label: 'True motions', options: [1, 2, 3, 4].map((n) => [n, String(n)]), value: state.motions, onInput: (motions) => change({ motions }) }),
      slider({ label: 'Noise', min: 0, max: 5, step: 0.5, value: 0, format: (value) => `${value} %`, onInput: (value) => change({ noise: value / 100 }) }),
      slider({
        label: 'Threshold κ',
        min: -4,
        max: -1,
        step: 0.05,
        value: Math.log10(KAPPA),
        format: (value) => small(10 ** value),
        onInput(value) {
          state.kappa = 10 ** value;
          if (values) read();
        },
      }),
      button('Other motions', () => change({ seed: state.seed + 1 })),
    ),
  );
  await show();
}

/** Measurements of random motions, drawn as the paper's experiment does. */
function measured({ motions, noise, seed }) {
  const draw = random(seed);
  const entries = Float64Array.from({ length: 6 * motions }, () => 2 * draw() - 1);
  return ask('motionMeasurements', entries, new Float64Array(motions).fill(1), COUNT, noise, seed);
}

/** One number of motions: the singular values of its matrix and its rank. */
function row(degree) {
  const bars = spectrum({ width: 300, height: 46 });
  const rank = html('span', { class: 'rank' });
  const element = html('li', {}, html('div', { class: 'head' }, html('b', {}, `n = ${degree}`), rank), bars.element);
  return {
    element,
    show(values, kappa, found, isFirst) {
      bars.show(values, kappa);
      element.classList.toggle('first', isFirst);
      const lost = values.length - found;
      rank.textContent = `rank ${found} of ${values.length}${lost > 0 ? `: ${lost} missing` : ''}`;
    },
  };
}

/** The scores as bars above the lowest. */
function scores() {
  const element = html('ol', { class: 'scores' });
  return {
    element,
    show(candidates = []) {
      element.classList.toggle('waits', candidates.length === 0);
      if (candidates.length === 0) return;
      const lowest = Math.min(...candidates.map(({ score }) => score));
      const highest = Math.max(...candidates.map(({ score }) => score), lowest + 1);
      element.replaceChildren(
        ...candidates.map(({ motions, score }) => {
          const bar = svg('svg', { viewBox: '0 0 200 12', preserveAspectRatio: 'none', 'aria-hidden': 'true' }, svg('rect', { height: 12, class: 'kept' }));
          set(bar.firstChild, { width: Math.max(1.5, ((score - lowest) / (highest - lowest)) * 200) });
          const item = html('li', {}, html('b', {}, `n = ${motions}`), bar, html('span', {}, score === lowest ? 'lowest' : `+ ${written(score - lowest, 0)}`));
          item.classList.toggle('first', score === lowest);
          return item;
        }),
      );
    },
  };
}

/** The answer of the rule (12). Where it holds for no number, the first matrix that is not full is an upper bound. */
function ruling(first, fires, lost) {
  if (first < 0) return 'Every matrix has full rank: no answer';
  if (fires) return `The first that is not full lacks exactly one: ${counted(first + 1)}`;
  return `The first that is not full lacks ${lost}, not one: at most ${counted(first + 1)}`;
}

function judge(element, text, isRight) {
  element.textContent = text ? `${text}. ${isRight ? '✓\u00a0Right.' : '✗\u00a0Wrong.'}` : 'Being computed …';
  element.classList.toggle('wrong', Boolean(text) && !isRight);
}

const counted = (n) => `${n} ${n === 1 ? 'motion' : 'motions'}`;
const small = (value) => value.toFixed(4).replace(/0+$/, '');
