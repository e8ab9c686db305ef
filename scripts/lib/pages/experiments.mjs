// The tables of docs/experiments.md.

import { amount, origin, percent, score, table, whole } from './table.mjs';

export const PARTS = {
  'figure-1': [
    'experiments',
    (figures) => `${origin(figures)} ${whole(figures.trials)} trials per point, seed ${figures.seed}.\n\n${errors(figures)}`,
  ],
  pairs: ['experiments', pairs],
};

/** Per cent: mean / median [share of trials with a motion that is far off]. */
function errors({ methods, cells }) {
  const rows = cells.map(({ motions, noise, methods: found, countRight }) => [
    motions,
    `${noise} %`,
    ...found.map(({ mean, median, gross }) => `${short(mean)} / ${short(median)} [${amount(gross)}]`),
    ...countRight.map((share) => percent(share / 100)),
  ]);
  return table(['n', 'noise', ...methods, 'n right, paper', 'n right, ours'], rows);
}

/** An error, with about two digits; without noise only its order matters. */
function short(value) {
  if (value < 1e-3) return value.toExponential(0);
  return value < 10 ? score(value) : amount(value);
}

function pairs({ pairs }) {
  const rows = pairs.map(({ pair, kept, aboveThreshold, byRule, byOurs, score: found }) => [
    pair,
    whole(kept),
    whole(aboveThreshold),
    ...(found ? [`${percent(found.right)} of ${whole(found.on)}`, whole(found.beside), found.ours.map(score).join(', ')] : ['–', '–', '–']),
    byRule,
    byOurs,
  ]);
  return table(
    ['pair', 'pixels kept', 'above 0.115', 'right, of those on objects', 'beside objects', 'IoU of our masks', 'n, paper', 'n, ours'],
    rows,
  );
}
