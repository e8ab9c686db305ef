// Singular values as bars, as the rule of the paper's footnote 4 reads them.

import { set, svg } from './figures/kit.mjs';

/** The paper's threshold κ. */
export const KAPPA = 3e-3;
/** Decades below 1 that the bars show. */
const DECADES = 5;

/** Each singular value divided by the sum of those before it; the first is 1. Below κ it counts as zero, with all that follow. */
export function shares(singularValues) {
  let sum = 0;
  return singularValues.map((value) => {
    const share = sum > 0 ? value / sum : 1;
    sum += value;
    return share;
  });
}

/** How many bars stand before the first that ends below the line κ. */
export function rankAt(singularValues, kappa) {
  const first = shares(singularValues).findIndex((share) => share < kappa);
  return first < 0 ? singularValues.length : first;
}

/** Bars on a logarithmic scale with the line κ. `show(singularValues, kappa)` draws them. Those that count as zero have a ground of their own. */
export function spectrum({ width, height }) {
  const bars = svg('g');
  const line = svg('line', { x1: 0, x2: width, class: 'kappa' });
  const element = svg('svg', { viewBox: `0 0 ${width} ${height}`, class: 'spectrum', 'aria-hidden': 'true', preserveAspectRatio: 'none' }, bars, line);
  const tall = (share) => Math.max(0, 1 + Math.log10(Math.max(share, 1e-300)) / DECADES) * (height - 4);
  return {
    element,
    show(singularValues, kappa) {
      const rank = rankAt(singularValues, kappa);
      const step = width / singularValues.length;
      const wide = step * (singularValues.length > 80 ? 1 : 0.78);
      bars.replaceChildren(
        ...shares(singularValues).flatMap((share, k) => {
          const x = k * step + (step - wide) / 2;
          const ground = k < rank ? [] : [svg('rect', { x: k * step, width: step, y: 0, height, class: 'none' })];
          // A bar of zero keeps a foot, so that it can be counted.
          const high = Math.max(tall(share), 1.5);
          return [...ground, svg('rect', { x, width: wide, y: height - high, height: high, class: k < rank ? 'kept' : 'lost' })];
        }),
      );
      const y = height - tall(kappa);
      set(line, { y1: y, y2: y });
    },
  };
}
