// The tables of what a pipeline loses without its parts.

import { fixed, signed, table } from './table.mjs';

/**
 * A table of the rows of experiments/left_out.rs: what everything scores, then by how much each figure of these columns changes without a part,
 * with its 95 % interval, in bold where that does not contain 0.
 */
export function withoutParts(rows, name, columns) {
  const lines = rows.map(({ without, tables: { [name]: of } }, k) => {
    const figures = columns.map(([, figure]) => (k === 0 ? fixed(of.figures[figure]?.mean, 3) : difference(of.figures[figure])));
    return [without, ...figures, ...(k === 0 ? ['', ''] : [`${of.changed} of ${of.cases}`, `${signed(100 * (of.time - 1), 0)} %`])];
  });
  return table(['without', ...columns.map(([title]) => title), 'cases changed', 'time'], lines);
}

function difference(estimate) {
  if (!estimate) return fixed(undefined);
  const mean = signed(estimate.mean, 3);
  const ends = (estimate.interval ?? []).map((end) => signed(end, 3));
  if (ends.every((end) => end === '0')) return mean;
  const text = `${mean} [${ends.join(', ')}]`;
  return ends[0][0] === ends[1][0] ? `**${text}**` : text;
}
