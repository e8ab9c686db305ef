// The parts of figures: plots, points to drag, sliders, choices, pictures. Everything works by mouse, touch and keyboard.

/** The same numbers for the same seed, and so the same figure for every reader. */
export { random } from '../../../scripts/lib/random.mjs';

const SVG = 'http://www.w3.org/2000/svg';

/** An SVG element. Attributes that are undefined are left out. */
export function svg(tag, attributes = {}, ...children) {
  return filled(document.createElementNS(SVG, tag), attributes, children);
}

/** An HTML element. */
export function html(tag, attributes = {}, ...children) {
  return filled(document.createElement(tag), attributes, children);
}

function filled(element, attributes, children) {
  for (const [name, value] of Object.entries(attributes)) if (value !== undefined) element.setAttribute(name, value);
  element.append(...children);
  return element;
}

/** Changes attributes. */
export function set(element, attributes) {
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
}

/**
 * A plot in coordinates of its own. `x` and `y`: the range of each axis; `title`: what it shows, for those who do not see it; `names`: the
 * names at the ends of the axes, if axes are drawn. Marks go to `marks` in pixels of the plot: `at(x, y)` converts.
 */
export function plot({ title, x, y, width = 360, height = 300, names, flipped = false }) {
  const at = (px, py) => [((px - x[0]) / (x[1] - x[0])) * width, (flipped ? (py - y[0]) / (y[1] - y[0]) : (y[1] - py) / (y[1] - y[0])) * height];
  const from = (sx, sy) => [x[0] + (sx / width) * (x[1] - x[0]), flipped ? y[0] + (sy / height) * (y[1] - y[0]) : y[1] - (sy / height) * (y[1] - y[0])];
  const axes = svg('g', { class: 'axes' });
  const marks = svg('g', { class: 'marks' });
  const handles = svg('g', { class: 'handles' });
  const picture = svg('svg', { viewBox: `0 0 ${width} ${height}`, class: 'plot', role: 'group', 'aria-label': title }, axes, marks, handles);
  if (names) {
    const [ox, oy] = at(Math.min(Math.max(0, x[0]), x[1]), Math.min(Math.max(0, y[0]), y[1]));
    axes.append(svg('line', { x1: 0, x2: width, y1: oy, y2: oy }), svg('line', { x1: ox, x2: ox, y1: 0, y2: height }));
    axes.append(svg('text', { x: width - 6, y: oy - 6, 'text-anchor': 'end' }, names[0]), svg('text', { x: ox + 6, y: flipped ? height - 6 : 14 }, names[1]));
  }
  return { element: picture, marks, handles, at, from, width, height, x, y };
}

/** The segment of the line a·x + b·y + c = 0 inside a plot, in its pixels; undefined where it does not cross it. */
export function segment({ at, x, y }, [a, b, c]) {
  const ends = [];
  const near = (value, [low, high]) => value >= low - 1e-9 && value <= high + 1e-9;
  if (Math.abs(b) > 1e-12) for (const px of x) if (near((-c - a * px) / b, y)) ends.push([px, (-c - a * px) / b]);
  if (Math.abs(a) > 1e-12) for (const py of y) if (near((-c - b * py) / a, x)) ends.push([(-c - b * py) / a, py]);
  if (ends.length < 2) return undefined;
  const far = ends.reduce((best, end) => (distance(end, ends[0]) > distance(best, ends[0]) ? end : best));
  const [[x1, y1], [x2, y2]] = [at(...ends[0]), at(...far)];
  return { x1, y1, x2, y2 };
}

const distance = ([ax, ay], [bx, by]) => Math.hypot(ax - bx, ay - by);

/** The path of an arrow, in pixels of a plot. Nothing where it is too short to have a direction. */
export function arrow([x1, y1], [x2, y2], head = 8) {
  const length = Math.hypot(x2 - x1, y2 - y1);
  if (length < 1) return '';
  const [dx, dy] = [((x2 - x1) / length) * Math.min(head, length), ((y2 - y1) / length) * Math.min(head, length)];
  const barb = (side) => `${x2 - dx - side * 0.5 * dy} ${y2 - dy + side * 0.5 * dx}`;
  return `M${x1} ${y1}L${x2} ${y2}M${barb(1)}L${x2} ${y2}L${barb(-1)}`;
}

/**
 * A point to drag, or to move with the arrow keys (with Shift ten times as far). `describe` puts its place into words; `onMove` gets its new place
 * and returns nothing, or a place that it prefers. A point that is bound to a curve has `along`: `place(t)` and the inverse `nearest(place)`,
 * the range `min` to `max`, and `closed` where the curve's ends are one; the keys then move t by `step`.
 */
export function handle(area, { label, at: start, step, colour = 'ink', describe = ([px, py]) => `${written(px)}, ${written(py)}`, onMove, along }) {
  let place = start;
  const [low, high] = along ? [along.min, along.max] : area.x;
  const dot = svg(
    'g',
    { class: 'handle', tabindex: 0, role: 'slider', 'aria-label': label, 'aria-valuemin': low, 'aria-valuemax': high },
    svg('circle', { r: 22, class: 'reach' }),
    svg('circle', { r: 9, class: `dot ${colour}` }),
  );
  const show = () => {
    const [sx, sy] = area.at(...place);
    const now = along ? along.nearest(place) : place[0];
    set(dot, { transform: `translate(${sx} ${sy})`, 'aria-valuenow': String(+now.toFixed(3)), 'aria-valuetext': describe(place) });
  };
  const slide = (t) => {
    const turns = along.closed ? Math.floor((t - low) / (high - low)) : 0;
    place = along.place(Math.min(Math.max(t - turns * (high - low), low), high));
    place = onMove(place) ?? place;
    show();
  };
  const move = ([px, py]) => {
    if (along) return slide(along.nearest([px, py]));
    const kept = [Math.min(Math.max(px, area.x[0]), area.x[1]), Math.min(Math.max(py, area.y[0]), area.y[1])];
    place = onMove(kept) ?? kept;
    return show();
  };
  dot.addEventListener('keydown', (event) => {
    const far = (event.shiftKey ? 10 : 1) * step;
    const way = { ArrowLeft: [-far, 0], ArrowRight: [far, 0], ArrowUp: [0, far], ArrowDown: [0, -far] }[event.key];
    if (!way) return;
    event.preventDefault();
    if (along) return slide(along.nearest(place) + (way[0] || way[1]));
    const up = area.at(0, 1)[1] < area.at(0, 0)[1] ? 1 : -1;
    move([place[0] + way[0], place[1] + up * way[1]]);
  });
  dot.addEventListener('pointerdown', (event) => {
    event.preventDefault();
    dot.focus({ preventScroll: true });
    dot.setPointerCapture(event.pointerId);
  });
  dot.addEventListener('pointermove', (event) => {
    if (!dot.hasPointerCapture(event.pointerId)) return;
    const box = area.element.getBoundingClientRect();
    move(area.from(((event.clientX - box.left) / box.width) * area.width, ((event.clientY - box.top) / box.height) * area.height));
  });
  area.handles.append(dot);
  show();
  return {
    element: dot,
    get place() {
      return place;
    },
    /** Puts it elsewhere without a call of `onMove`. */
    put(to) {
      place = to;
      show();
    },
  };
}

/** A slider with its name and value. `format` writes the value. */
export function slider({ label, min, max, step, value, format = String, onInput }) {
  const output = html('output', {}, format(value));
  const input = html('input', { type: 'range', min, max, step, value, 'aria-label': label });
  input.setAttribute('aria-valuetext', format(value));
  input.addEventListener('input', () => {
    output.textContent = format(input.valueAsNumber);
    input.setAttribute('aria-valuetext', format(input.valueAsNumber));
    onInput(input.valueAsNumber);
  });
  return html('label', { class: 'slider' }, html('span', {}, label), input, output);
}

/** One of several: `options` are pairs of value and text, or a list of parts of it. */
export function choice({ label, options, value, onInput }) {
  const name = `choice-${Math.random().toString(36).slice(2)}`;
  const buttons = options.map(([option, text]) => {
    const input = html('input', { type: 'radio', name, value: option });
    input.checked = option === value;
    input.addEventListener('change', () => onInput(option));
    return html('label', {}, input, html('span', {}, ...[text].flat()));
  });
  return html('fieldset', { class: 'choice' }, html('legend', {}, label), ...buttons);
}

/** One thing that is on or off. */
export function toggle({ label, value = false, onInput }) {
  const input = html('input', { type: 'checkbox', role: 'switch' });
  input.checked = value;
  input.addEventListener('change', () => onInput(input.checked));
  return html('label', { class: 'toggle' }, input, html('span', {}, label));
}

export function button(text, onClick) {
  const one = html('button', { type: 'button', class: 'button' }, text);
  one.addEventListener('click', onClick);
  return one;
}

/** The row of controls below a figure. */
export function controls(...parts) {
  return html('div', { class: 'controls' }, ...parts);
}

/** Two or more parts side by side, below each other where there is no room. */
export function beside(...parts) {
  return html('div', { class: 'beside' }, ...parts);
}

/** A part with a heading. */
export function panel(heading, ...parts) {
  return html('div', { class: 'panel' }, html('h3', {}, heading), ...parts);
}

/** A canvas for pictures, with a name for those who do not see it. */
export function canvas({ width, height, label }) {
  return html('canvas', { width, height, role: 'img', 'aria-label': label });
}

/** A picture with a plot over it. */
export function covered(picture, { element }) {
  return html('div', { class: 'covered' }, picture, element);
}

/** Grey levels 0 to 255 as a picture that the module takes. */
export function greyPixels(width, height, level) {
  const data = new Uint8ClampedArray(4 * width * height).fill(255);
  for (let p = 0; p < width * height; p++) data.fill(level(p % width, Math.floor(p / width)), 4 * p, 4 * p + 3);
  return { width, height, data };
}

/** The pixels of an image file, as the module takes them. */
export async function pixels(url) {
  const response = await fetch(url);
  if (!response.ok) throw new Error(`${url} could not be loaded.`);
  return pixelsOf(await response.blob());
}

/** The same of an image file that is here. */
export async function pixelsOf(file) {
  const bitmap = await createImageBitmap(file, { colorSpaceConversion: 'none' });
  const { width, height } = bitmap;
  const context = new OffscreenCanvas(width, height).getContext('2d', { willReadFrequently: true });
  context.drawImage(bitmap, 0, 0);
  bitmap.close();
  return { width, height, data: context.getImageData(0, 0, width, height).data };
}

/** A number as the text writes it: at most `digits` decimals, with a true minus. */
export function written(value, digits = 2) {
  return String(+value.toFixed(digits)).replace('-', '−');
}

const MATHML = 'http://www.w3.org/1998/Math/MathML';

/** A formula of letters, numbers and signs apart by spaces, each with at most one `_` below and one `^` above: `formula('I_x u + b^2')`. */
export function formula(text) {
  const node = (tag, ...children) => {
    const element = document.createElementNS(MATHML, tag);
    element.append(...children);
    return element;
  };
  const leaf = (part) => node(/^[\d.]+$/.test(part) ? 'mn' : /^\p{L}+$/u.test(part) ? 'mi' : 'mo', part);
  const term = (word) => {
    const [, base, below, above] = word.match(/^(.+?)(?:_(.+?))?(?:\^(.+))?$/u);
    if (below && above) return node('msubsup', leaf(base), leaf(below), leaf(above));
    if (below) return node('msub', leaf(base), leaf(below));
    return above ? node('msup', leaf(base), leaf(above)) : leaf(base);
  };
  return node('math', ...text.split(' ').map(term));
}

/** The colours of the motions, as CSS classes and as values of the page's theme. */
export const MOTIONS = ['one', 'two', 'three', 'four'];

export function colour(name) {
  const value = getComputedStyle(document.documentElement).getPropertyValue(`--${name}`);
  const [light, dark] = value.match(/#\w+/g);
  return matchMedia('(prefers-color-scheme: dark)').matches ? dark : light;
}
