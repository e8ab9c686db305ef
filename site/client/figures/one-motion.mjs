// The lines of many pixels of one moving pattern, and the motion that suits them all best.

import { ask, latest } from '../compute.mjs';
import { beside, choice, controls, covered, greyPixels, handle, html, panel, plot, random, segment, set, slider, svg, written } from './kit.mjs';

/** Pixels of a frame, and how far pixels that are measured keep from its border. */
const SIZE = 64;
const BORDER = 6;
const MOST_PIXELS = 80;
/** The second singular value is below this share of the first: all lines are parallel. */
const PARALLEL = 0.02;

export default async function mount({ stage, say }) {
  let motion = [0.8, -0.5];
  let pattern = 'blobs';
  let count = 12;
  let noise = 0;
  const patterns = { blobs: blobs(), stripes: (x, y) => 128 + 80 * Math.sin(0.32 * x + 0.19 * y) };
  const places = spread();

  const canvas = html('canvas', { width: SIZE, height: SIZE, role: 'img', 'aria-label': 'The first frame' });
  canvas.className = 'pixels';
  const picture = plot({ title: 'The pixels that are measured', x: [-0.5, SIZE - 0.5], y: [-0.5, SIZE - 0.5], width: 360, height: 360, flipped: true });
  const plane = plot({ title: 'The plane of motions', x: [-2, 2], y: [-2, 2], width: 360, height: 360, names: ['u', 'v'], flipped: true });
  const estimate = svg('path', { class: 'arrow two', d: 'M-14 -14L14 14M-14 14L14 -14' });
  const marks = places.map(() => ({ tick: svg('path', { class: 'gradient' }), line: svg('line', { class: 'line thin' }) }));
  picture.marks.append(...marks.map(({ tick }) => tick));
  plane.marks.append(...marks.map(({ line }) => line), estimate);

  const context = canvas.getContext('2d');
  const show = latest(async () => {
    const [first, second] = frames(patterns[pattern], motion, noise);
    context.putImageData(new ImageData(first.data, SIZE, SIZE), 0, 0);
    const { horizontal, vertical, temporal } = await ask('derivativesOf', first, second);
    const used = places.slice(0, count).map(([x, y]) => [horizontal, vertical, temporal].map((values) => values[y * SIZE + x]));
    const { coefficients, singularValues } = await ask('multibodyFlow', Float64Array.from(used.flat()), 1);
    const steepest = Math.max(...used.map(([ix, iy]) => Math.hypot(ix, iy)));
    for (const [k, { tick, line }] of marks.entries()) {
      const y = used[k];
      const ends = y && segment(plane, y);
      for (const mark of [tick, line]) set(mark, { visibility: ends || (y && mark === tick) ? 'visible' : 'hidden' });
      if (!y) continue;
      // A gradient of half the length has half the say.
      const [dx, dy] = [y[0], y[1]].map((part) => (5 * part) / steepest);
      const [sx, sy] = picture.at(...places[k]);
      set(tick, { d: `M${sx - 3 * dx} ${sy - 3 * dy}L${sx + 3 * dx} ${sy + 3 * dy}` });
      if (ends) set(line, { ...ends, opacity: Math.max(0.12, Math.hypot(y[0], y[1]) / steepest) * 0.7 });
    }
    const parallel = singularValues[1] < PARALLEL * singularValues[0];
    const [u, v] = coefficients;
    const [ex, ey] = plane.at(u, v);
    set(estimate, { visibility: parallel ? 'hidden' : 'visible', transform: `translate(${ex} ${ey})` });
    const truth = `The pattern moves by (${written(motion[0])}, ${written(motion[1])}).`;
    say(
      parallel
        ? `${truth} All ${count} lines are parallel: how far it moves along the stripes, no pixel can tell.`
        : `${truth} The lines of ${count} pixels agree best on (${written(u)}, ${written(v)}): ${written(Math.hypot(u - motion[0], v - motion[1]), 3)} pixels from the truth.`,
    );
  });

  handle(plane, {
    label: 'Motion of the pattern in pixels per frame',
    at: motion,
    step: 0.05,
    colour: 'one',
    describe: ([u, v]) => `u ${written(u)}, v ${written(v)}`,
    onMove(to) {
      const length = Math.hypot(...to);
      motion = length > 1.5 ? to.map((part) => (1.5 * part) / length) : to;
      void show();
      return motion;
    },
  });

  stage.append(
    beside(panel('Gradients in the first frame', covered(canvas, picture)), panel('The motions that they allow', plane.element)),
    controls(
      choice({
        label: 'Pattern',
        options: [
          ['blobs', 'blobs'],
          ['stripes', 'stripes'],
        ],
        value: pattern,
        onInput: (now) => void ((pattern = now), show()),
      }),
      slider({ label: 'Pixels', min: 2, max: MOST_PIXELS, step: 1, value: count, onInput: (now) => void ((count = now), show()) }),
      slider({ label: 'Noise', min: 0, max: 8, step: 1, value: noise, format: (now) => `±${now}`, onInput: (now) => void ((noise = now), show()) }),
    ),
  );
  await show();
}

/** Two frames of a pattern that moves, each with noise of its own, uniform in grey levels. */
function frames(pattern, [u, v], noise) {
  const draw = random(7);
  return [0, 1].map((time) => greyPixels(SIZE, SIZE, (x, y) => pattern(x - time * u, y - time * v) + noise * (2 * draw() - 1)));
}

/** Soft blobs: waves of many directions. */
function blobs() {
  const draw = random(3);
  const waves = Array.from({ length: 14 }, () => [2 * Math.PI * draw(), (2 * Math.PI) / (16 + 16 * draw()), 2 * Math.PI * draw()]);
  return (x, y) => 128 + 16 * waves.reduce((all, [angle, pace, phase]) => all + Math.sin(pace * (x * Math.cos(angle) + y * Math.sin(angle)) + phase), 0);
}

/** Pixels all over a frame: any first few of them are spread evenly (the plastic number's sequence). */
function spread() {
  const inner = SIZE - 2 * BORDER;
  return Array.from({ length: MOST_PIXELS }, (_, k) => [0.7548776662, 0.5698402910].map((step) => BORDER + Math.floor(((0.5 + (k + 1) * step) % 1) * inner)));
}
