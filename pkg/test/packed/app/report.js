// The report of every host: the same bits.

export function report({ count, motions, labels }) {
  return JSON.stringify({ count, motions, labels: Array.from(labels).join('') });
}
