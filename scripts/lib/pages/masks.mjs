// The tables of docs/masks.md.

import { change, origin, percent, score, table } from './table.mjs';

export const PARTS = {
  scenes: ['masks', (figures) => `${origin(figures)}\n\n${scenes(figures)}`],
  pairs: ['masks', ({ sequences, pairs }) => real([...sequences, ...pairs])],
  ablation: ['masks-ablation', ablation],
  calibration: ['masks-calibration', calibration],
};

function scenes({ scenes }) {
  const rows = scenes.map(({ of, cases, method, miou, countRight, subPixel, boundary }) => [
    of, cases, method, score(miou), percent(countRight), score(subPixel), score(boundary),
  ]);
  return table(['scenes', 'cases', 'method', 'mean IoU', 'n right', 'sub-pixel', 'F'], rows);
}

function real(pairs) {
  if (pairs.length === 0) return '';
  const rows = pairs.map(({ of, cases, method, jBackground, jOracle, groupedBoundary, rand }) => [
    of, cases, method, ...[jBackground, jOracle, groupedBoundary, rand].map(score),
  ]);
  return table(['pairs', 'cases', 'method', 'J', 'J by hand', 'F', 'adjusted Rand'], rows);
}

/** The scores of the whole pipeline, then by how much they change without each part. */
function ablation({ date, rows: found }) {
  const columns = [
    ['mean IoU, best', ({ best }) => best.scenes.miou],
    ['fast', ({ fast }) => fast.scenes.miou],
    ['bare ground, best', ({ best }) => best.bare.miou],
    ['fast', ({ fast }) => fast.bare.miou],
    ['J, best', ({ best }) => best.pairs?.jBackground],
    ['fast', ({ fast }) => fast.pairs?.jBackground],
    ['F, best', ({ best }) => best.pairs?.groupedBoundary],
    ['fast', ({ fast }) => fast.pairs?.groupedBoundary],
  ];
  const [all, ...parts] = found;
  const rows = parts.map((part) => [part.without, ...columns.map(([, of]) => change(of(part), of(all)))]);
  const head = ['without', ...columns.map(([title]) => title)];
  const { scenes, bare, pairs } = all.best;
  const counts = `${scenes.cases} scenes, ${bare.cases} of bare ground, ${pairs?.cases ?? 0} real pairs, ${date}:`;
  return `${counts}\n\n${table(head, [[all.without, ...columns.map(([, of]) => score(of(all)))], ...rows])}`;
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

