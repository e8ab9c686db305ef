// The stages of a pair: their pictures, texts and tables.

import { html, svg, written } from './figures/kit.mjs';
import { classOf } from './masks.mjs';
import { FULL_COLOUR, SOURCES, exceededBy, flowAt, flows, framed, labelled, localFlow, masked, measured, plane, size } from './pair-pictures.mjs';

/** Of a table of motions. */
const HEAD = ['motion', 'explains best', 'its two rows'];
const NAMES = { constraint: 'the constraint', window: 'windows', hypothesis: 'the other hypothesis' };

/**
 * Each stage: its pictures, as key, text and what draws it; and, while the picture of a key is shown, a sentence, a table
 * and a reading for those who do not see the picture.
 */
export const STAGES = [
  {
    name: 'Derivatives',
    views: ({ plain: { horizontal, vertical, temporal, ...grid } }) => [
      ['t', symbol('I', 't'), plane(grid, temporal)],
      ['x', symbol('I', 'x'), plane(grid, horizontal)],
      ['y', symbol('I', 'y'), plane(grid, vertical)],
      ['first', 'first frame', framed(0)],
      ['second', 'second frame', framed(1)],
    ],
    what: ({ plain }) => {
      const [x, y, t] = [plain.horizontal, plain.vertical, plain.temporal].map(size);
      const ratio = written(t / Math.hypot(x, y), 1);
      return {
        text: `Orange is positive, blue negative. On average, the brightness changes ${ratio} times as much from frame to frame as from pixel to pixel. Where that is more than about 1, things jump over their own edges, and the three no longer belong together.`,
        table: [['Frames', `${plain.width} × ${plain.height} pixels`], [symbol('I', 'x'), `${written(x)} grey levels per pixel`], [symbol('I', 'y'), `${written(y)} grey levels per pixel`], [symbol('I', 't'), `${written(t)} grey levels per frame`]],
        reading: `Root mean squares: I x ${written(x)}, I y ${written(y)} grey levels per pixel, I t ${written(t)} grey levels per frame, ${ratio} times the gradient.`,
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
        table: [['Background', atRest ? 'at rest' : 'moves'], [symbol('A', 1), rows(dominant)], ['Noise', `${written(noise)} grey levels`], ['Residual', `${left} grey levels`]],
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
    what: ({ taken: { measurements, base } }) => {
      const count = measurements?.weights.length ?? 0;
      const mean = count ? measurements.weights.reduce((sum, weight) => sum + weight, 0) / count : 0;
      return {
        text: 'The pixels that are given to the multibody constraint. The darker, the worse the dominant motion explains them, and the more they count.',
        table: [['Measurements', `${count}`], ['of pixels', `${base.width * base.height}`], ['Mean weight', written(mean)]],
        reading: `${count} of ${base.width * base.height} pixels of the level are measured, with a mean weight of ${written(mean)}.`,
      };
    },
  },
  {
    name: 'Candidates',
    views: () => [['flow', 'flows', flows]],
    what: ({ plain, taken: { candidates, price } }) => {
      const rows = Object.keys(SOURCES).map((source) => {
        const own = candidates.filter((one) => one.source === source).toSorted((one, other) => other.gain - one.gain);
        return { source, count: own.length, best: own[0] };
      });
      const middle = [plain.width / 2, plain.height / 2];
      const said = rows.filter(({ count }) => count).map(({ source, count, best }) => `${count} from ${NAMES[source]}, the best with flow ${flowText(flowAt(best.matrix, middle))} would save ${written(best.gain, 0)}`);
      return {
        text: `Each dot is a motion, at its flow in the middle of the frame. Blue: read off the constraint. Orange: from windows. Purple: known from the other hypothesis about the ground. The larger, the more it would save beside the dominant motion, the cross. The price of a motion is ${written(price, 0)}.`,
        head: ['from', 'how many', 'flow of the best', 'saves'],
        table: rows.map(({ source, count, best }) => [NAMES[source], `${count}`, ...(best ? [`${flowText(flowAt(best.matrix, middle))}${best.degree ? `, degree ${best.degree}` : ''}`, written(best.gain, 0)] : ['–', '–'])]),
        reading: `Candidates: ${said.join('; ')}. The price of a motion is ${written(price, 0)}.`,
      };
    },
  },
  {
    name: 'Selection',
    views: ({ taken: { selection } }) => [['cheapest', 'best motion of each pixel', labelled(selection)]],
    what: ({ taken: { selected, price } }) => ({
      text: `The motion that saves most is taken, then the one that saves most of what is left, while one is worth its price of ${written(price, 0)}. Colours: the motion that explains each pixel best. No pixel asks its neighbours yet.`,
      head: HEAD,
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
      head: HEAD,
      table: motions(refined),
      reading: `${selected.length} motions before, ${refined.length} after. ${supports(refined)}`,
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
      table: [['Draft', `${draft.width} × ${draft.height}`, `${draft.motions.length} motions`], ['Working size', `${labelling.width} × ${labelling.height}`, `${labelling.motions.length} motions`], ...shares(labelling.labels, labelling.motions.length).map((share, k) => [key(k), percent(share)])],
      reading: `${labelling.motions.length} motions are left: ${shares(labelling.labels, labelling.motions.length).map((share, k) => `${named(k)} has ${percent(share)}`).join(', ')}.`,
    }),
  },
  {
    name: 'Masks',
    views: () => [
      ['groups', 'things', masked(({ result, groups }) => grouped(result.labels, groups))],
      ['motions', 'motions', masked(({ result }) => result.labels)],
    ],
    what: ({ result, groups }, view) => ({
      text: 'The borders at full size, along the edges of the picture, without what is recognised as a shadow. Motions that fit together along their border are one thing. They are numbered anew, by size.',
      table: [['Motions', `${result.count}`], ['Things', `${groups.length}`], ...result.motions.map((one) => [key(one.label, view === 'motions' ? one.label : thingOf(groups, one.label)), percent(one.share), rows(one.matrix)])],
      reading: `${result.count} motions, ${groups.length} things: ${groups.map((labels, k) => `${k ? `thing ${k}` : 'the background'} has ${percent(labels.reduce((sum, label) => sum + result.motions[label].share, 0))}`).join(', ')}.`,
    }),
  },
];

/** A letter with an index, in words that can be read aloud. */
const symbol = (letter, index) => html('span', {}, html('i', {}, letter), html('sub', {}, String(index)));
const percent = (share) => `${written(100 * share, 1)}\u00a0%`;
const named = (label) => (label ? `A ${label + 1}` : 'the background, A 1,');
const entriesOf = (entries) => entries.map((value, k) => written(value, k % 3 === 2 ? 2 : 3));
const matrix = (entries) => `(${entriesOf(entries).join(', ')})`;
/** The two rows of a motion that are not given. */
const rows = (entries) => html('span', {}, entriesOf(entries).slice(0, 3).join(', '), html('br'), entriesOf(entries).slice(3).join(', '));
/** A motion with the colour of its pixels: its own, or that of the thing it is part of. */
const key = (label, coloured = label) => html('span', {}, svg('svg', { class: `swatch ${coloured ? classOf(coloured) : ''}`, viewBox: '0 0 10 10', 'aria-hidden': 'true' }, svg('rect', { width: 10, height: 10 })), ' ', symbol('A', label + 1));
const motions = (all) => all.map((one, k) => [key(k), percent(one.support), rows(one.matrix)]);
const supports = (all) => `${all.map(({ support }, k) => `A ${k + 1} explains ${percent(support)} best`).join(', ')}.`;
const flowText = ([u, v]) => `(${written(u, 1)}, ${written(v, 1)})`;
const thingOf = (groups, label) => groups.findIndex((group) => group.includes(label));
const grouped = (labels, groups) => {
  const of = new Uint8Array(256);
  groups.forEach((group, k) => group.forEach((label) => (of[label] = k)));
  return labels.map((label) => of[label]);
};

/** The share of each label. */
function shares(labels, count) {
  const counts = Array.from({ length: count }, () => 0);
  for (const label of labels) if (label < count) counts[label]++;
  return counts.map((found) => found / labels.length);
}
