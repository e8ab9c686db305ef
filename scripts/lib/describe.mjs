// Describes the result of `veronese pair` in words.

/** One line per motion of a result: its position, the motion of its centre, and its residual. */
export function describe({ width, height, count, motions, unlabelled, milliseconds }) {
  const noun = count === 1 ? 'motion' : 'motions';
  const lines = [`${count} ${noun} in ${width} × ${height} pixels, ${milliseconds.total.toFixed(0)} ms:`];
  for (const motion of motions) lines.push(`  ${describeMotion(motion)}`);
  if (unlabelled > 0) lines.push(`  ${unlabelled} pixels without a label`);
  return lines.join('\n');
}

function describeMotion({ label, matrix: [a11, a12, a13, a21, a22, a23], share, residual, bbox: [x, y, w, h] }) {
  // The centre of the box; pixel centres are at whole numbers.
  const cx = x + (w - 1) / 2;
  const cy = y + (h - 1) / 2;
  const u = a11 * cx + a12 * cy + a13;
  const v = a21 * cx + a22 * cy + a23;
  return [
    `motion ${label}`,
    `${(100 * share).toFixed(1).padStart(5)} % of the pixels`,
    `at (${cx.toFixed(0)}, ${cy.toFixed(0)}) it moves ${direction(u, v)}`,
    `residual ${residual.toFixed(1)} grey levels`,
  ].join(', ');
}

function direction(u, v) {
  const part = (value, forward, back) => `${Math.abs(value).toFixed(1)} px ${value < 0 ? back : forward}`;
  return `${part(u, 'right', 'left')} and ${part(v, 'down', 'up')}`;
}
