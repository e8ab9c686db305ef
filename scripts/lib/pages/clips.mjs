// The tables of docs/clips.md.

import { withoutParts } from './ablation.mjs';
import { amount, fixed, origin, percent, score, table } from './table.mjs';

export const PARTS = {
  generated: [
    'clips',
    (figures) => [origin(figures), `${figures.generated[0]?.clips} clips:`, means(figures.generated, true)].join('\n\n'),
  ],
  events: ['clips', events],
  real: ['clips', ({ real }) => (real.length > 0 ? `${real[0].clips} clips:\n\n${means(real, false)}` : '')],
  ablation: ['clips-ablation', ablation],
};

function means(rows, generated) {
  const scores = ['auto', 'oneClick', 'tracks', 'oracle', 'fAuto', 'fTracks', 'assigned', 'lost', 'idf1'];
  const lines = rows.map((row) => [
    row.method,
    ...scores.map((name) => score(row[name])),
    fixed(row.switches, 1),
    fixed(row.labels, 1),
    ...(generated ? [percent(row.numberRight)] : []),
    amount(row.milliseconds),
  ]);
  const head = [
    'method',
    'auto',
    'one click',
    'tracks',
    'oracle',
    'F auto',
    'F tracks',
    'assigned',
    'lost',
    'IDF1',
    'switches',
    'labels',
    ...(generated ? ['n right'] : []),
    'ms',
  ];
  return table(head, lines);
}

function events({ events }) {
  const methods = events[0]?.rows.map(({ method }) => method) ?? [];
  const lines = events.map(({ event, rows }) => [
    event,
    rows[0].clips,
    ...rows.flatMap(({ auto, assigned, switches }) => [score(auto), score(assigned), fixed(switches, 1)]),
  ]);
  return table(['event', 'clips', ...methods.flatMap((method) => [`${method}: auto`, 'assigned', 'switches'])], lines);
}

function ablation({ date, rows }) {
  const columns = [
    ['auto', 'auto'],
    ['F auto', 'fAuto'],
    ['assigned', 'assigned'],
    ['IDF1', 'idf1'],
    ['lost', 'lost'],
    ['switches', 'switches'],
  ];
  const titles = { real: 'real clips', generated: 'generated clips', slow: 'generated clips at a quarter of the usual speed' };
  const tables = Object.entries(titles).filter(([name]) => rows[0].tables[name]);
  return [
    `${date}.`,
    ...tables.flatMap(([name, title]) => [`${rows[0].tables[name].cases} ${title}:`, withoutParts(rows, name, columns)]),
  ].join('\n\n');
}
