// The tables of docs/masks.md.

import { withoutParts } from './ablation.mjs';
import { origin, percent, score, table } from './table.mjs';

export const PARTS = {
  scenes: ['masks', (figures) => `${origin(figures)}\n\n${scenes(figures)}`],
  pairs: ['masks', ({ sequences, pairs }) => real([...sequences, ...pairs])],
  ablation: ['masks-ablation', ablation],
  calibration: ['masks-calibration', calibration],
};

function scenes({ scenes }) {
  const rows = scenes.map(({ of, cases, method, miou, countRight, subPixel, boundary }) => [
    of,
    cases,
    method,
    score(miou),
    percent(countRight),
    score(subPixel),
    score(boundary),
  ]);
  return table(['scenes', 'cases', 'method', 'mean IoU', 'n right', 'sub-pixel', 'F'], rows);
}

function real(pairs) {
  if (pairs.length === 0) return '';
  const rows = pairs.map(({ of, cases, method, jBackground, jOracle, groupedBoundary, rand }) => [
    of,
    cases,
    method,
    ...[jBackground, jOracle, groupedBoundary, rand].map(score),
  ]);
  return table(['pairs', 'cases', 'method', 'J', 'J by hand', 'F', 'adjusted Rand'], rows);
}

function ablation({ date, rows }) {
  const columns = [
    ['J', 'j'],
    ['J by hand', 'byHand'],
    ['F', 'f'],
    ['scenes', 'scenes'],
    ['bare ground', 'bare'],
    ['large', 'large'],
  ];
  const { scenes, bare, large, j } = rows[0].tables.best.figures;
  const counts = `${j?.cases ?? 0} real pairs, ${scenes.cases} scenes, ${bare.cases} of bare ground, ${large.cases} large ones, ${date}.`;
  return [counts, ...['best', 'fast'].flatMap((quality) => [`*${quality}*:`, withoutParts(rows, quality, columns)])].join('\n\n');
}

const sum = (ranges, figure) => ranges.reduce((total, range) => total + range[figure], 0);

function calibration({ date, scenes, object, background, unknown }) {
  const edge = (share) => Number((100 * share).toFixed(1));
  const heads = scenes.map(({ from }, k) => `${edge(from)} to ${edge(scenes[k + 1]?.from ?? 1)} %`);
  const cells = (ranges, k) => {
    const { pixels, confidence, right } = ranges[k];
    return [pixels / sum(ranges, 'pixels'), confidence / pixels, right / pixels].map((share) => percent(share, 1));
  };
  const ranges = heads.map((head, k) => [head, ...cells(scenes, k), ...cells(object, k), ...cells(background, k)]);
  const head = ['confidence', 'scenes: share', 'mean', 'right', 'objects: share', 'mean', 'right', 'background: share', 'mean', 'right'];
  const marked = (of) => percent(unknown[`${of}Marked`] / unknown[of]);
  const sentence = `\`markUnknown\` marks ${marked('occluded')} of the hidden pixels of the scenes and ${marked('visible')} of the others.`;
  return [`${date}.`, table(head, ranges), sentence].join('\n\n');
}
