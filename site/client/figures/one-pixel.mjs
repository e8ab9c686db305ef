// A striped sheet behind a window: the derivatives of one pixel, and the line of motions that they allow.

import { ask, latest } from '../compute.mjs';
import { arrow, beside, button, choice, controls, covered, greyPixels, handle, html, panel, plot, segment, set, svg, toggle, written } from './kit.mjs';

/** In pixels: half a frame but for the middle, half the sheet, the radius of the window, a light and a dark stripe together. */
const HALF = 34;
const SHEET = 26;
const WINDOW = 18;
const PERIOD = 18;
/** The radius at which the gradient is turned. */
const RING = WINDOW + 4;
/** The largest motion, in pixels per frame. */
const MOST = 1.5;
/** Frames until the sheet turns back, and frames per second. */
const SWING = 5;
const RATE = 5;
const DEGREE = Math.PI / 180;

/** The brightness at a distance from the middle of a slope. It rises and falls evenly, so that its derivatives are exact. */
const brightness = (distance) => 128 + 110 * (1 - 4 * Math.abs(modulo(distance / PERIOD + 0.25, 1) - 0.5));
const modulo = (value, by) => ((value % by) + by) % by;

export default async function mount({ stage, say }) {
  let angle = -25 * DEGREE;
  let motion = [1.1, 0.5];
  /** The motion's part along the gradient, which is fixed while the motion is bound to the line. */
  let bound;
  const direction = () => [Math.cos(angle), Math.sin(angle)];
  const along = ([u, v]) => u * Math.cos(angle) + v * Math.sin(angle);

  /** The brightness of the sheet, moved by an offset, at a pixel counted from the middle; undefined beside it. */
  const level = (px, py, [dx, dy]) => (Math.max(Math.abs(px - dx), Math.abs(py - dy)) > SHEET ? undefined : brightness(along([px - dx, py - dy])));

  const sheet = moving(level, () => motion);
  const picture = plot({ title: 'The window', x: [-HALF - 0.5, HALF + 0.5], y: [-HALF - 0.5, HALF + 0.5], width: 360, height: 360, flipped: true });
  const scale = 360 / (2 * HALF + 1);
  const cover = svg('path', { class: 'cover', 'fill-rule': 'evenodd', d: `M0 0H360V360H0z${circle(WINDOW * scale)}` });
  const gradient = svg('path', { class: 'arrow' });
  const pixel = svg('rect', { class: 'pixel', x: 180 - scale / 2, y: 180 - scale / 2, width: scale, height: scale });
  picture.marks.append(cover, svg('path', { class: 'line guide', d: circle(RING * scale) }), svg('path', { class: 'line', d: circle(WINDOW * scale) }), gradient, pixel);

  const plane = plot({ title: 'The plane of motions', x: [-2, 2], y: [-2, 2], width: 360, height: 360, names: ['u', 'v'], flipped: true });
  const line = svg('line', { class: 'line' });
  const [truth, normal] = ['one', 'two'].map((tone) => svg('path', { class: `arrow ${tone}` }));
  const [truthName, normalName] = [svg('text', { class: 'one' }, 'true motion'), svg('text', { class: 'two' }, 'normal flow')];
  plane.marks.append(line, truth, normal, normalName, truthName);

  const show = latest(async () => {
    const side = 2 * HALF + 1;
    const [first, second] = [[0, 0], motion].map((offset) => greyPixels(side, side, (x, y) => level(x - HALF, y - HALF, offset) ?? 128));
    const { horizontal, vertical, temporal } = await ask('derivativesOf', first, second);
    const middle = HALF * side + HALF;
    const [ix, iy, it] = [horizontal[middle], vertical[middle], temporal[middle]];
    const [u, v] = motion;
    const square = ix * ix + iy * iy;
    const foot = [(-it * ix) / square, (-it * iy) / square];
    set(line, segment(plane, [ix, iy, it]));
    set(truth, { d: arrow(plane.at(0, 0), plane.at(u, v)) });
    set(normal, { d: arrow(plane.at(0, 0), plane.at(...foot)) });
    const below = v > foot[1];
    put(truthName, plane.at(u, v), below);
    put(normalName, plane.at(...foot), !below);
    say(
      `The pixel in the middle gets brighter by ${written(ix, 1)} grey levels per pixel to the right, by ${written(iy, 1)} per pixel down and by ${written(it, 1)} ` +
        `from frame to frame: it allows every motion (u, v) with ${sum([ix, ' u'], [iy, ' v'], [it, ''])} = 0. ` +
        `The sheet’s motion (${written(u)}, ${written(v)}) gives ${written(ix * u + iy * v + it, 1)} there. ` +
        `The pixel measures only the part along the gradient, the normal flow (${written(foot[0])}, ${written(foot[1])}), ${written(Math.hypot(...foot))} pixels long.`,
    );
  });

  const changed = () => {
    set(gradient, { d: arrow([180, 180], picture.at(...direction().map((part) => (RING - 2) * part))) });
    sheet.draw();
    return show();
  };

  handle(picture, {
    label: 'Direction of the gradient',
    at: direction().map((part) => RING * part),
    along: {
      min: -180,
      max: 180,
      closed: true,
      place: (t) => [RING * Math.cos(t * DEGREE), RING * Math.sin(t * DEGREE)],
      nearest: ([px, py]) => Math.atan2(py, px) / DEGREE,
    },
    step: 3,
    describe: ([px, py]) => `${written(Math.atan2(py, px) / DEGREE, 0)} degrees`,
    onMove([px, py]) {
      angle = Math.atan2(py, px);
      if (bound !== undefined) bound = along(motion);
      void changed();
    },
  });
  handle(plane, {
    label: 'Motion of the sheet in pixels per frame',
    at: motion,
    step: 0.05,
    colour: 'one',
    describe: ([u, v]) => `u ${written(u)}, v ${written(v)}`,
    onMove(to) {
      const [gx, gy] = direction();
      const normalPart = bound ?? along(to);
      const far = Math.sqrt(Math.max(0, MOST * MOST - normalPart * normalPart));
      const across = Math.min(Math.max(gx * to[1] - gy * to[0], -far), far);
      const kept = Math.min(Math.max(normalPart, -MOST), MOST);
      motion = [kept * gx - across * gy, kept * gy + across * gx];
      void changed();
      return motion;
    },
  });

  stage.append(
    beside(panel('A sheet behind a window', covered(sheet.canvas, picture)), panel('The motions that the middle pixel allows', plane.element)),
    controls(
      sheet.button,
      toggle({ label: 'Take the window away', onInput: (on) => set(cover, { visibility: on ? 'hidden' : 'visible' }) }),
      choice({
        label: 'Drag the motion',
        options: [
          ['freely', 'freely'],
          ['line', 'along the line'],
        ],
        value: 'freely',
        onInput: (how) => (bound = how === 'line' ? along(motion) : undefined),
      }),
    ),
  );
  sheet.begin(stage);
  await changed();
}

/** The path of a circle around the middle of the picture. */
const circle = (radius) => `M${180 - radius} 180a${radius} ${radius} 0 1 0 ${2 * radius} 0a${radius} ${radius} 0 1 0 ${-2 * radius} 0z`;

/** Puts a text above or below a point, within the plot. */
const put = (text, [px, py], below) => set(text, { x: Math.min(Math.max(px, 45), 315), y: py + (below ? 26 : -16), 'text-anchor': 'middle' });

/** Numbers with their names, as a sum. */
const sum = (...terms) => terms.map(([value, name], k) => `${k ? (value < 0 ? ' − ' : ' + ') : value < 0 ? '−' : ''}${written(Math.abs(value), 1)}${name}`).join('');

/** The sheet, there and back as long as it is in view and nobody stops it. */
function moving(level, motion) {
  const side = 2 * HALF + 1;
  const canvas = html('canvas', { width: side, height: side, role: 'img', 'aria-label': 'A striped square sheet' });
  canvas.className = 'pixels';
  const context = canvas.getContext('2d');
  const image = context.createImageData(side, side);
  let playing = false;
  let visible = true;
  let phase = SWING / 2;
  let before;
  const draw = () => {
    const now = SWING - Math.abs(modulo(phase + SWING, 4 * SWING) - 2 * SWING);
    const offset = motion().map((part) => part * now);
    for (let p = 0; p < side * side; p++) {
      const value = level((p % side) - HALF, Math.floor(p / side) - HALF, offset);
      image.data.fill(value ?? 0, 4 * p, 4 * p + 3);
      image.data[4 * p + 3] = value === undefined ? 0 : 255;
    }
    context.putImageData(image, 0, 0);
  };
  const tick = (time) => {
    phase += before === undefined ? 0 : ((time - before) / 1000) * RATE;
    before = time;
    draw();
    if (playing && visible) requestAnimationFrame(tick);
    else before = undefined;
  };
  const run = (on) => {
    playing = on;
    one.textContent = on ? 'Stop the sheet' : 'Move the sheet';
    if (on && before === undefined) requestAnimationFrame(tick);
  };
  const one = button('', () => run(!playing));
  return {
    canvas,
    button: one,
    draw,
    begin(stage) {
      run(!matchMedia('(prefers-reduced-motion: reduce)').matches);
      new IntersectionObserver(([{ isIntersecting }]) => {
        visible = isIntersecting;
        if (visible) run(playing);
      }).observe(stage);
    },
  };
}
