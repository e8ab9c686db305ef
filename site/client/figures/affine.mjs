// An affine motion: what it does to a square, and its six numbers as the pixels tell them.

import { ask, latest } from '../compute.mjs';
import { arrow, beside, button, controls, handle, html, panel, plot, set, slider, svg, written } from './kit.mjs';

/** Lines of the grid in each direction. */
const LINES = 9;
const SEED = 5;
/** Three corners determine the motion, the fourth follows. */
const CORNERS = [
  ['Upper left corner', -1, -1],
  ['Upper right corner', 1, -1],
  ['Lower left corner', -1, 1],
];
const PRESETS = [
  ['Shift', [0, 0, 0.4, 0, 0, -0.25]],
  ['Turn', [-0.1, -0.44, 0, 0.44, -0.1, 0]],
  ['Grow', [0.35, 0, 0, 0, 0.35, 0]],
  ['Shear', [0, 0.45, 0, 0, 0, 0]],
];
const ENTRIES = ['11', '12', '13', '21', '22', '23'];

export default async function mount({ stage, say }) {
  let truth = [0.12, -0.3, 0.1, 0.25, -0.05, 0.05];
  let count = 20;
  let noise = 0;

  const plane = plot({ title: 'A grid before and after the motion', x: [-1.9, 1.9], y: [-1.6, 1.6], width: 380, height: 320, flipped: true });
  const [before, after, found] = ['line thin', 'line one', 'line two found'].map((names) => svg('path', { class: names }));
  const arrows = svg('path', { class: 'arrow ticks' });
  const grid = (motion) => lines().map((ends) => `M${ends.map((end) => plane.at(...moved(motion, end)).join(' ')).join('L')}`).join('');
  set(before, { d: grid([0, 0, 0, 0, 0, 0]) });
  plane.marks.append(before, after, found, arrows);

  const cells = ENTRIES.map(() => [html('td'), html('td')]);
  const heading = (text) => html('th', { scope: 'col' }, text);
  const table = html(
    'table',
    { class: 'numbers' },
    html('thead', {}, html('tr', {}, heading('Entry'), heading('The motion'), heading('From the pixels'))),
    html('tbody', {}, ...ENTRIES.map((entry, k) => html('tr', {}, html('th', { scope: 'row' }, html('i', {}, 'a'), html('sub', {}, entry)), ...cells[k]))),
  );

  const show = latest(async () => {
    const { positions, derivatives } = await ask('motionMeasurements', Float64Array.from(truth), Float64Array.of(1), count, noise / 100, SEED);
    const answer = await ask('fitMotions', positions, derivatives, { motions: 1 }).catch((error) => error);
    const fit = answer.motions?.[0];
    set(after, { d: grid(truth) });
    set(arrows, { d: normals(plane, positions, derivatives) });
    set(found, { d: fit ? grid(fit.matrix) : '' });
    for (const [k, [given, told]] of cells.entries()) {
      given.textContent = written(truth[k], 3);
      told.textContent = fit ? written(fit.matrix[k], 3) : '–';
    }
    const what = `The motion is u = ${spoken(truth.slice(0, 3))}, v = ${spoken(truth.slice(3))}.`;
    if (!fit) return say(`${what} ${count} pixels do not determine it: ${answer.message}`);
    const worst = Math.max(...truth.map((entry, k) => Math.abs(entry - fit.matrix[k])));
    return say(`${what} ${count} pixels tell ${fit.determined} of its 6 numbers, ${worst < 1e-9 ? 'exactly' : `to within ${written(worst, 3)}`}.`);
  });

  const handles = CORNERS.map(([label, x, y], k) =>
    handle(plane, {
      label,
      at: moved(truth, [x, y]),
      step: 0.05,
      colour: 'one',
      onMove(to) {
        const [corner, right, down] = CORNERS.map(([, cx, cy], other) => (other === k ? to : moved(truth, [cx, cy])).map((part, axis) => part - [cx, cy][axis]));
        // Corners are two apart.
        truth = [0, 1].flatMap((axis) => {
          const [a, b] = [(right[axis] - corner[axis]) / 2, (down[axis] - corner[axis]) / 2];
          return [a, b, corner[axis] + a + b];
        });
        void show();
      },
    }),
  );
  const take = (motion) => {
    truth = motion;
    handles.forEach((one, k) => one.put(moved(truth, CORNERS[k].slice(1))));
    void show();
  };

  stage.append(
    beside(panel('A square of pixels, and where it goes', plane.element), panel('The six numbers', table)),
    controls(
      html('div', { class: 'buttons' }, ...PRESETS.map(([name, motion]) => button(name, () => take(motion)))),
      slider({ label: 'Pixels', min: 4, max: 60, step: 1, value: count, onInput: (now) => void ((count = now), show()) }),
      slider({ label: 'Noise', min: 0, max: 5, step: 0.5, value: noise, format: (now) => `${now} %`, onInput: (now) => void ((noise = now), show()) }),
    ),
  );
  await show();
}

/** Where a motion takes a point. */
const moved = ([a11, a12, a13, a21, a22, a23], [x, y]) => [x + a11 * x + a12 * y + a13, y + a21 * x + a22 * y + a23];

/** The ends of the lines of the grid. */
function lines() {
  const at = Array.from({ length: LINES }, (_, k) => -1 + (2 * k) / (LINES - 1));
  return at.flatMap((t) => [
    [
      [t, -1],
      [t, 1],
    ],
    [
      [-1, t],
      [1, t],
    ],
  ]);
}

/** Each pixel with its normal flow, the only part of the motion that it measures. */
function normals({ at }, positions, derivatives) {
  const paths = [];
  for (let j = 0; j < positions.length / 2; j++) {
    const [x, y] = positions.subarray(2 * j);
    const [ix, iy, it] = derivatives.subarray(3 * j);
    const far = -it / (ix * ix + iy * iy);
    paths.push(arrow(at(x, y), at(x + far * ix, y + far * iy), 5));
  }
  return paths.join('');
}

const spoken = ([a, b, c]) => `${written(a)} x ${b < 0 ? '−' : '+'} ${written(Math.abs(b))} y ${c < 0 ? '−' : '+'} ${written(Math.abs(c))}`;
