// From two frames to masks, stage by stage: what the product's own pipeline notes on its way.

import { asker } from '../compute.mjs';
import { withMasks } from '../masks.mjs';
import { exceededBy, faint, signed, size } from '../planes.mjs';
import { arrow, beside, button, canvas, choice, colour, controls, covered, formula, html, pixels, plot, svg, written } from './kit.mjs';

const SAMPLES = { cars: 'intel-two-cars', parallax: 'parallax' };
/** The share of the pixels whose values have the full colour, and more. */
const FULL_COLOUR = 0.01;
/** Arrows along the longer side. */
const ARROWS = 24;
const LARGEST_DOT = 14;
const BEST = 5;
const SOURCES = { constraint: 'one', window: 'two', hypothesis: 'four' };

const address = (sample, name) => new URL(`../../samples/${sample}/${name}.png`, import.meta.url);
/** Its own worker: a pair takes seconds. */
const ask = asker();

export default async function mount({ stage, say }) {
  let pair;
  let at = 0;
  /** The picture that is chosen, of stages that have several. */
  const chosen = {};

  const picture = html('div', { class: 'picture' });
  const heading = html('h4');
  const thought = html('p');
  const numbers = html('tbody');
  const which = html('div');
  const news = html('p', { class: 'news', role: 'status' });
  const steps = html('div', { class: 'steps' });
  const back = button('Back', () => go(at - 1));
  const on = button('Next stage', () => go(at + 1));
  const files = html('input', { type: 'file', accept: 'image/*', multiple: '', 'aria-label': 'Two frames of your own' });
  files.addEventListener('change', () => own([...files.files]));
  const source = choice({ label: 'Frames', options: [['cars', 'two cars'], ['parallax', 'parallax']], value: 'cars', onInput: sample });

  stage.append(
    controls(source, html('label', { class: 'own' }, html('span', {}, 'or two of your own: '), files)),
    steps,
    beside(html('div', { class: 'panel' }, picture, which), html('div', { class: 'panel' }, heading, thought, html('div', { class: 'scroll' }, html('table', { class: 'numbers' }, numbers)))),
    controls(back, on),
    news,
  );
  stage.children[2].classList.add('clip-parts');
  stage.addEventListener('dragover', (event) => event.preventDefault());
  stage.addEventListener('drop', (event) => {
    event.preventDefault();
    void own([...event.dataTransfer.files]);
  });
  matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => pair && show());

  function sample(name) {
    return take(['first', 'second'].map((one) => pixels(address(SAMPLES[name], one))));
  }
  async function own(list) {
    if (list.length !== 2) return void (news.textContent = `Two pictures are needed, not ${list.length}. Choose both at once.`);
    const urls = list.sort((one, other) => one.name.localeCompare(other.name, 'en', { numeric: true })).map((file) => URL.createObjectURL(file));
    source.querySelectorAll('input').forEach((input) => (input.checked = false));
    await take(urls.map(pixels));
    urls.forEach((url) => URL.revokeObjectURL(url));
  }
  let newest;
  async function take(loading) {
    const mine = (newest = loading);
    news.textContent = 'The pair goes through all stages.';
    stage.classList.add('busy');
    try {
      const frames = await Promise.all(loading);
      const [plain, found] = await Promise.all([ask('derivativesOf', ...frames), ask('segmentPairStages', ...frames)]);
      if (newest !== mine) return;
      pair = { frames, plain, ...found, taken: found.hypotheses[found.chosen] };
      news.textContent = '';
      go(at);
    } catch (thrown) {
      if (newest === mine) news.textContent = thrown.message;
      if (!pair) throw thrown;
    } finally {
      if (newest === mine) stage.classList.remove('busy');
    }
  }

  function go(to) {
    at = Math.min(Math.max(0, to), STAGES.length - 1);
    const radios = choice({ label: 'Stage', options: STAGES.map(({ name }, k) => [k, `${k + 1} ${name}`]), value: at, onInput: go });
    const had = steps.contains(document.activeElement);
    steps.replaceChildren(radios);
    if (had) radios.querySelector(':checked').focus();
    back.disabled = at === 0;
    on.disabled = at === STAGES.length - 1;
    show();
  }

  function show() {
    const { name, views, what } = STAGES[at];
    const options = views(pair);
    const view = options.find(([key]) => key === chosen[at]) ?? options[0];
    heading.textContent = `${at + 1} ${name}`;
    which.replaceChildren(...(options.length > 1 ? [choice({ label: 'Picture', options: options.map(([key, text]) => [key, text]), value: view[0], onInput: pick })] : []));
    picture.replaceChildren(view[2](pair, name));
    const { text, table, reading } = what(pair);
    thought.textContent = text;
    numbers.replaceChildren(...table.map(([label, ...values]) => html('tr', {}, html('th', { scope: 'row' }, label), ...values.map((value) => html('td', {}, value)))));
    say(`Stage ${at + 1} of ${STAGES.length}, ${name.toLowerCase()}. ${reading}`);
  }
  function pick(key) {
    chosen[at] = key;
    show();
    which.querySelector(':checked')?.focus();
  }

  await sample('cars');
}

/**
 * Each stage: its pictures, as key, text and what draws it; and what is said of it: a sentence, a table and a reading for those who do not
 * see the picture.
 */
const STAGES = [
  {
    name: 'Derivatives',
    views: ({ plain: { horizontal, vertical, temporal, ...grid } }) => [
      ['t', formula('I_t'), plane(grid, temporal)],
      ['x', formula('I_x'), plane(grid, horizontal)],
      ['y', formula('I_y'), plane(grid, vertical)],
      ['first', 'first frame', ({ frames }, name) => drawn(frames[0], imageOf(frames[0]), name)],
      ['second', 'second frame', ({ frames }, name) => drawn(frames[1], imageOf(frames[1]), name)],
    ],
    what: ({ plain, taken: { derivatives } }) => {
      const sizes = ['horizontal', 'vertical', 'temporal'].map((one) => written(size(plain[one])));
      const landed = written(size(derivatives.temporal));
      return {
        text: 'Orange is positive, blue negative. Where a thing moves by more than an edge is wide, the three do not fit together: the paper stops here.',
        table: [['Size of the frames', `${plain.width} × ${plain.height}`], ...['I_x', 'I_y', 'I_t'].map((symbol, k) => [formula(symbol), `${sizes[k]} grey levels`]), [html('span', {}, formula('I_t'), ' where the local flow lands'), `${landed} grey levels`]],
        reading: `Root mean squares: I x ${sizes[0]}, I y ${sizes[1]}, I t ${sizes[2]} grey levels; where the local flow lands I t has ${landed}.`,
      };
    },
  },
  {
    name: 'Dominant motion',
    views: ({ plain, taken: { base, residual } }) => [
      ['residual', 'residual', plane(base, residual, exceededBy(plain.temporal, FULL_COLOUR))],
      ['difference', 'difference of the frames', plane(plain, plain.temporal)],
    ],
    what: ({ hypotheses, taken: { dominant, atRest, noise, residual } }) => {
      const left = written(size(residual));
      const tried = hypotheses.length > 1 ? 'Rest and the most common motion are both solved to the end; what describes the frames in fewer nats is kept.' : 'Only one hypothesis was worth solving.';
      return {
        text: `The second frame along the dominant motion minus the first. ${tried}`,
        table: [['Background', atRest ? 'at rest' : 'moves'], [formula('A_1'), matrix(dominant)], ['Noise', `${written(noise)} grey levels`], ['Residual', `${left} grey levels`]],
        reading: `The background ${atRest ? 'is at rest' : `has the motion ${matrix(dominant)}`}. Noise ${written(noise)}, residual ${left} grey levels. ${tried}`,
      };
    },
  },
  {
    name: 'Measurements',
    views: () => [
      ['places', 'on the frame', measured],
      ['flow', 'rough local flow', localFlow],
    ],
    what: ({ taken: { measurements, base, derivatives } }) => {
      const count = measurements?.weights.length ?? 0;
      const mean = count ? measurements.weights.reduce((sum, weight) => sum + weight, 0) / count : 0;
      return {
        text: 'The pixels that are given to the multibody constraint. The darker, the worse the dominant motion explains them, and the more they count.',
        table: [['Measurements', `${count}`], ['of pixels', `${base.width * base.height}`], ['Mean weight', written(mean)], [html('span', {}, formula('I_t'), ', recentred'), `${written(size(derivatives.temporal))} grey levels`]],
        reading: `${count} of ${base.width * base.height} pixels of the level are measured, with a mean weight of ${written(mean)}.`,
      };
    },
  },
  {
    name: 'Candidates',
    views: () => [['flow', 'flows', flows]],
    what: ({ plain, taken: { candidates, price } }) => {
      const from = (source) => candidates.filter((one) => one.source === source).length;
      const best = candidates.toSorted((one, other) => other.gain - one.gain).slice(0, BEST);
      return {
        text: 'Each dot is a motion, at its flow in the middle of the frame. Blue is read off the constraint, orange comes from windows. The larger, the more it would save beside the dominant motion, the cross.',
        table: [['From the constraint', `${from('constraint')}`], ['From windows', `${from('window')}`], ...best.map((one) => [origin(one), flowText(flowAt(one.matrix, [plain.width / 2, plain.height / 2])), `saves ${written(one.gain, 0)}`])],
        reading: `${from('constraint')} candidates from the multibody constraint, ${from('window')} from windows. The price of a motion is ${written(price, 0)}. ${best.length ? `The best candidate, from the ${origin(best[0])}, would save ${written(best[0].gain, 0)}.` : ''}`,
      };
    },
  },
  {
    name: 'Selection',
    views: ({ taken: { selection } }) => [['cheapest', 'best motion of each pixel', labelled(selection)]],
    what: ({ taken: { selected, price } }) => ({
      text: `The motion that saves most is taken, then the one that saves most of what is left, while one is worth its price of ${written(price, 0)}. Colours: the motion that explains each pixel best. No pixel asks its neighbours yet.`,
      table: motions(selected),
      reading: `${selected.length} motions are kept. ${supports(selected)}`,
    }),
  },
  {
    name: 'Refinement',
    views: ({ taken: { refinement, selection } }) => [
      ['after', 'after', labelled(refinement)],
      ['before', 'before', labelled(selection)],
    ],
    what: ({ taken: { refined, selected } }) => ({
      text: `Each motion on its own pixels, on the brightness, from coarse to fine. At finer sizes, motions may be added and dropped: ${selected.length} were selected, ${refined.length} are left.`,
      table: motions(refined),
      reading: `${selected.length} motions before, ${refined.length} after. ${supports(refined)} ${refined.map((one, k) => `A ${k + 1} is ${matrix(one.matrix)}`).join('; ')}.`,
    }),
  },
  {
    name: 'Labels',
    views: ({ taken: { draft, labelling, refinement } }) => [
      ['labels', 'working size', labelled(labelling)],
      ['draft', 'draft', labelled(draft)],
      ['alone', 'no pixel asks its neighbours', labelled(refinement)],
    ],
    what: ({ taken: { draft, labelling } }) => ({
      text: 'The labels of the least sum: first a coarse draft, in which motions are dropped, split and joined, then the working size. Compare with what the pixels say alone.',
      table: [['Draft', `${draft.width} × ${draft.height}`, `${draft.motions.length} motions`], ['Working size', `${labelling.width} × ${labelling.height}`, `${labelling.motions.length} motions`], ...shares(labelling.labels, labelling.motions.length).map((share, k) => [named(k), percent(share)])],
      reading: shares(labelling.labels, labelling.motions.length).map((share, k) => `${named(k)} has ${percent(share)}`).join(', '),
    }),
  },
  {
    name: 'Masks',
    views: () => [
      ['groups', 'things', ({ frames, result, groups }, name) => drawn(frames[0], withMasks(frames[0], grouped(result.labels, groups)), name)],
      ['motions', 'motions', ({ frames, result }, name) => drawn(frames[0], withMasks(frames[0], result.labels), name)],
    ],
    what: ({ result, groups }) => ({
      text: 'The borders at full size, along the edges of the picture. Motions that fit together along their border are one thing.',
      table: [['Motions', `${result.count}`], ['Things', `${groups.length}`], ...result.motions.map((one) => [`Motion ${one.label + 1}`, percent(one.share), matrix(one.matrix)])],
      reading: `${result.count} motions, ${groups.length} things: ${groups.map((labels, k) => `${k ? `thing ${k}` : 'the background'} has ${percent(labels.reduce((sum, label) => sum + result.motions[label].share, 0))}`).join(', ')}.`,
    }),
  },
];

const percent = (share) => `${written(100 * share, 1)} %`;
const named = (label) => (label ? `Motion ${label + 1}` : 'Background');
const matrix = (entries) => `(${entries.map((value, k) => written(value, k % 3 === 2 ? 2 : 4)).join(', ')})`;
const origin = ({ source, degree }) => (source === 'constraint' ? `constraint, degree ${degree}` : source === 'window' ? 'window' : 'other hypothesis');
const motions = (all) => all.map((one, k) => [formula(`A_${k + 1}`), percent(one.support), matrix(one.matrix)]);
const supports = (all) => `${all.map(({ support }, k) => `A ${k + 1} explains ${percent(support)} best`).join(', ')}.`;
const flowAt = ([a11, a12, a13, a21, a22, a23], [x, y]) => [a11 * x + a12 * y + a13, a21 * x + a22 * y + a23];
const flowText = ([u, v]) => `(${written(u, 1)}, ${written(v, 1)})`;
const grouped = (labels, groups) => {
  const of = new Uint8Array(256);
  groups.forEach((group, k) => group.forEach((label) => (of[label] = k)));
  return labels.map((label) => of[label]);
};
const imageOf = ({ width, height, data }) => new ImageData(new Uint8ClampedArray(data), width, height);

function drawn({ width, height }, image, name) {
  const one = canvas({ width, height, label: `Picture of the stage: ${name.toLowerCase()}` });
  one.getContext('2d').putImageData(image, 0, 0);
  return one;
}

function plane({ width, height }, values, full = exceededBy(values, FULL_COLOUR)) {
  return (_, name) => drawn({ width, height }, signed({ width, height }, values, full), name);
}

/** Labels of some level over the first frame at that size. */
function labelled({ width, height, labels }) {
  return ({ frames: [first] }, name) => {
    const small = new OffscreenCanvas(width, height).getContext('2d');
    const full = new OffscreenCanvas(first.width, first.height);
    full.getContext('2d').putImageData(imageOf(first), 0, 0);
    small.drawImage(full, 0, 0, width, height);
    return drawn({ width, height }, withMasks(small.getImageData(0, 0, width, height), labels), name);
  };
}

/** Each measurement on the first frame, as dark as its weight. */
function measured({ frames: [first], taken: { measurements, base } }, name) {
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
function localFlow({ frames: [first], taken: { base, localFlow: { u, v } } }, name) {
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
function flows({ frames: [{ width, height }], taken: { candidates, dominant } }) {
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

/** The share of each label. */
function shares(labels, count) {
  const counts = Array.from({ length: count }, () => 0);
  for (const label of labels) if (label < count) counts[label]++;
  return counts.map((found) => found / labels.length);
}
