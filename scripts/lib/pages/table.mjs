// Tables of Markdown, and how numbers stand in them.

const NONE = '–';

export function table(head, rows) {
  return [head, head.map(() => '---'), ...rows].map((cells) => `| ${cells.join(' | ')} |`).join('\n');
}

const there = (value) => typeof value === 'number' && Number.isFinite(value);

/** With so many decimals, or a dash where there is no number. */
export function fixed(value, decimals) {
  return there(value) ? value.toFixed(decimals) : NONE;
}

/** A score between 0 and 1. */
export function score(value) {
  return fixed(value, 2);
}

export function percent(share, decimals = 0) {
  return there(share) ? `${(100 * share).toFixed(decimals)} %` : NONE;
}

/** A change with its sign; 0 where rounding leaves nothing. */
export function signed(value, decimals) {
  const text = Math.abs(value).toFixed(decimals);
  if (Number(text) === 0) return '0';
  return `${value < 0 ? '−' : '+'}${text}`;
}

/** A time or a size: three digits or so, and no decimals beyond ten. */
export function amount(value) {
  return fixed(value, there(value) && Math.abs(value) < 10 ? 1 : 0);
}

/** How many times as much. */
export function ratio(value) {
  return fixed(value, there(value) && value < 10 ? 2 : 1);
}

export function whole(value) {
  return there(value) ? value.toLocaleString('en') : NONE;
}

/** "640x480" or [640, 480] as "640 × 480". */
export function size(value) {
  return (Array.isArray(value) ? value : value.split('x')).join(' × ');
}

export function mean(values) {
  const there = values.filter((value) => Number.isFinite(value));
  return there.length > 0 ? there.reduce((sum, value) => sum + value, 0) / there.length : undefined;
}

/** Where and when something was measured. */
export function origin({ machine: { processor, cores, ...programs }, date, version }) {
  const names = { node: 'Node', chromium: 'Chromium', rust: 'Rust' };
  const others = Object.entries(programs).map(([name, version]) => `${names[name] ?? name} ${version}`);
  const machine = processor ? [processor, `${cores} cores`] : [];
  return `${[`Version ${version}`, ...machine, ...others, date].join(', ')}.`;
}
