// The tables of docs/annotating.md.

import { amount, fixed, mean, origin, score, table, whole } from './table.mjs';

export const PARTS = {
  object: ['annotator', (figures) => `${origin(figures)} Quality *${figures.quality}*.\n\n${object(figures)}`],
  harm: ['annotator', harm],
  points: ['annotator', points],
  objects: ['annotator', objects],
  page: ['annotator-page', page],
};

/** Rows of all clips, then of those that constants were first set on and of the others. */
function groups(rows) {
  const all = [
    ['all', rows],
    ['old', rows.filter(({ old }) => old)],
    ['new', rows.filter(({ old }) => !old)],
  ];
  return all.filter(([, own]) => own.length > 0);
}

function object({ real }) {
  if (real.length === 0) return '';
  const rounds = Math.min(...real.map(({ rounds }) => rounds.length));
  const scores = [
    ['auto', ({ auto }) => auto],
    ['mask', ({ mask }) => mask],
    ['OpenCV', ({ baseline }) => baseline],
    ['box', ({ boxed }) => boxed.atOnce],
    ['GrabCut', ({ baselineBoxed }) => baselineBoxed],
    ['box, clip', ({ boxed }) => boxed.through],
    ['touch', ({ touched }) => touched.atOnce],
    ['touch, clip', ({ touched }) => touched.through],
    ['click', ({ click }) => click],
    ...Array.from({ length: rounds - 1 }, (_, k) => [`round ${k + 1}`, ({ rounds }) => rounds[k + 1]]),
  ];
  const times = [
    ['ms a round', ({ roundSeconds }) => 1000 * mean(roundSeconds)],
    ['ms a frame', ({ frameMilliseconds }) => frameMilliseconds],
    ['ms a box', ({ boxed }) => boxed.milliseconds],
    ['ms a touch', ({ touched }) => touched.milliseconds],
  ];
  const rows = groups(real).map(([name, own]) => [
    `${name} (${own.length})`,
    ...scores.map(([, of]) => score(mean(own.map(of)))),
    ...times.map(([, of]) => amount(mean(own.map(of)))),
  ]);
  const falls = ({ rounds }) => rounds.some((j, k) => j < rounds[k - 1] - 0.01);
  const sum = (own, of) => own.reduce((all, row) => all + of(row), 0);
  const far = (own) => sum(own, ({ farLost: [lost] }) => lost) / sum(own, ({ farLost: [, all] }) => all);
  const last = (own) => score(mean(own.map((row) => row.rounds.at(-1))));
  const worst = (own) => own.toSorted((one, other) => one.auto - other.auto).slice(0, Math.ceil(own.length / 3));
  const trust = groups(real).map(([name, own]) => [
    `${name} (${own.length})`,
    own.filter(falls).length,
    `${fixed(100 * far(own), 1)} %`,
    last(worst(own)),
    score(mean(worst(own).map(({ mask }) => mask))),
    whole(sum(own, ({ othersChanged }) => othersChanged)),
    whole(sum(own, ({ acceptedChanged }) => acceptedChanged)),
  ]);
  const titles = [
    'clips',
    'fall in a round',
    'far frames that lose',
    'worst third, last round',
    'worst third, mask',
    'pixels of others',
    'pixels of accepted',
  ];
  return `${table(['clips', ...[...scores, ...times].map(([title]) => title)], rows)}\n\n${table(titles, trust)}`;
}

function harm({ harm }) {
  if (harm.length === 0) return '';
  const rounds = Math.max(...harm.map(({ rounds }) => rounds.length));
  const ways = [
    ['the true mask painted', ({ painted }) => painted],
    ['the true mask outlined', ({ outlined }) => outlined],
    ...Array.from({ length: rounds }, (_, k) => [`round ${k + 1} of strokes`, ({ rounds }) => rounds[k]]),
  ];
  const rows = ways.map(([name, of]) => {
    const changes = harm.map(of).filter(Boolean);
    const sum = (of) => changes.reduce((all, change) => all + of(change), 0);
    const worse = changes.filter(({ before, after }) => after < before - 0.01).length;
    const [before, after] = [({ before }) => before, ({ after }) => after].map((of) => score(mean(changes.map(of))));
    const right = sum(({ mended }) => mended);
    const wrong = sum(({ spoilt }) => spoilt);
    return [
      `${name} (${changes.length})`,
      before,
      after,
      worse,
      ...[right, wrong].map((pixels) => whole(Math.round(pixels / 1000))),
      fixed(wrong / right, 2),
    ];
  });
  return table(
    ['annotation of one frame', 'J before', 'J after', 'clips that lose', 'mended, 1000 pixels', 'spoilt, 1000 pixels', 'harm'],
    rows,
  );
}

function points({ points }) {
  if (points.length === 0) return '';
  const rows = groups(points).map(([name, own]) => [
    `${name} (${own.length})`,
    score(mean(own.map(({ boxed }) => boxed))),
    ...[0, 1, 2].map((k) => score(mean(own.map(({ clicks }) => clicks[k])))),
    ...[0, 1].map((k) => amount(mean(own.map(({ milliseconds }) => milliseconds[k])))),
  ]);
  return table(['frames', 'box', 'click', '2 clicks', '3 clicks', 'ms a box', 'ms 3 clicks'], rows);
}

function objects({ objects }) {
  const kindOf = ({ clip }) => clip.replace(/ \d+$/, '');
  const kinds = [...new Set(objects.map(kindOf))];
  const rows = [...kinds.map((kind) => [kind, objects.filter((row) => kindOf(row) === kind)]), ['all', objects]].map(([name, own]) => {
    const all = own.flatMap((row) => row.objects);
    const changed = all.reduce((sum, { othersChanged }) => sum + othersChanged, 0);
    const scores = ['assigned', 'lastQuarter', 'stroked'].map((figure) =>
      score(mean(all.map((object) => object[figure]).filter((j) => j != null))),
    );
    return [`${name} (${own.length})`, all.length, ...scores, whole(changed), amount(mean(own.map((row) => row.frameMilliseconds)))];
  });
  return table(['clips', 'objects', 'assigned', 'last quarter', 'after strokes', 'pixels of others changed', 'ms a frame'], rows);
}

function page({ rows, ...figures }) {
  const lines = rows.map(({ clip, frames, found, actions, seconds, j }) => [
    clip,
    frames,
    score(found),
    actions,
    fixed(seconds, 0),
    score(j),
  ]);
  return `${origin(figures)}\n\n${table(['clip', 'frames', 'found', 'actions', 'seconds', 'J'], lines)}`;
}
