// A strip with a column for each frame: bars, the frame that is shown, and the one that is worked on.

import { html, set, svg } from './figures/kit.mjs';

const HEIGHT = 60;
const COLUMN = 10;

/** `onPick` gets the frame of a column that is clicked. */
export function strip({ heading, count, onPick }) {
  const width = count * COLUMN;
  const present = svg('rect', { class: 'present', y: 0, width: COLUMN, height: HEIGHT });
  const work = svg('rect', { class: 'work', y: 0, width: COLUMN, height: HEIGHT, visibility: 'hidden' });
  const columns = Array.from({ length: count }, (_, frame) => svg('g', { transform: `translate(${frame * COLUMN} 0)` }));
  const picture = svg('svg', { viewBox: `0 0 ${width} ${HEIGHT}`, preserveAspectRatio: 'none', class: 'strip', 'aria-hidden': 'true' }, present, work, ...columns);
  picture.addEventListener('click', (event) => {
    const box = picture.getBoundingClientRect();
    onPick(Math.min(count - 1, Math.floor((count * (event.clientX - box.left)) / box.width)));
  });
  return {
    element: html('div', { class: 'strip-row' }, html('h3', {}, heading), picture),
    /** Parts on top of each other, shares of the height, and a line. */
    bar(frame, parts, line) {
      let top = HEIGHT;
      const marks = parts.map(({ share, tone = '' }) => {
        top -= share * HEIGHT;
        return svg('rect', { class: `bar ${tone}`, x: 1.5, y: top, width: COLUMN - 3, height: share * HEIGHT });
      });
      if (line) marks.push(svg('line', { x1: 0, x2: COLUMN, y1: HEIGHT * (1 - line), y2: HEIGHT * (1 - line) }));
      columns[frame].replaceChildren(...marks);
    },
    point: (frame) => set(present, { x: frame * COLUMN }),
    busy: (frame) => set(work, { x: (frame ?? 0) * COLUMN, visibility: frame === undefined ? 'hidden' : 'visible' }),
  };
}
