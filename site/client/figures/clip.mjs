// A clip: what the pairs of each frame show alone, what all frames show together, and how a stroke in one frame spreads to the others.

import { SegmenterPool } from '../../package/dist/web.js';
import { brush, pathOf } from '../brush.mjs';
import { difference, overlap, stamp, classOf, withMasks } from '../masks.mjs';
import { strip } from '../strip.mjs';
import { beside, button, canvas, choice, controls, html, pixels, plot, slider, svg, written } from './kit.mjs';

const COUNT = 25;
const EVERY = 2;
const MOST_WORKERS = 4;
const RADIUS = 8;
/** Left open by a stroke. */
const OPEN = 255;
const PER_SECOND = 6;
/** A stroke to begin with: beneath the second car, on its shadow. */
const EXAMPLE = { frame: 17, label: 0, points: [[228, 240], [306, 240]] };

const address = (frame) => new URL(`../../samples/passing-cars/frames/${String(2 + EVERY * frame).padStart(2, '0')}.webp`, import.meta.url);

export default async function mount({ stage, say }) {
  const frames = await Promise.all(Array.from({ length: COUNT }, (_, frame) => pixels(address(frame))));
  const { width, height } = frames[0];
  const segmenter = new SegmenterPool({ jobs: Math.min(MOST_WORKERS, navigator.hardwareConcurrency || 1) });
  const clip = await segmenter.openClip(frames);

  /** Labels of each frame: of its pairs alone, of the whole clip, and with strokes where those have changed it. */
  const [alone, whole, corrected] = [[], [], []];
  /** The revision of each frame before there are strokes. */
  let revisions = [];
  let [strokes, frame, view, tool] = [[], EXAMPLE.frame, 'whole', 0];
  /** Number of steps of the clip that have not taken effect. */
  let working = 0;
  let objects = [];
  /** Settled when the labels of all frames that have changed are here. */
  let reading = Promise.resolve();

  // The picture
  const screen = canvas({ width, height, label: 'The frame with the masks of its objects; the reading below says what they are' });
  const context = screen.getContext('2d');
  const area = plot({ title: 'A brush over the frame', x: [0, width], y: [0, height], width, height, flipped: true });
  const brushes = html('div', { class: 'over' }, area.element);
  const seen = () => (view === 'alone' ? alone : corrected[frame] ? corrected : whole)[frame] ?? alone[frame];
  const nameOf = (label) => (label ? `object ${label}` : 'the ground');
  const pen = brush(area, {
    label: 'Brush: the arrow keys move it, Space begins and ends a stroke',
    at: [width / 2, height / 2],
    step: 4,
    radius: RADIUS,
    describe: ([x, y]) => `column ${Math.round(x)}, row ${Math.round(y)}, on ${nameOf(seen()?.[Math.round(Math.min(y, height - 1)) * width + Math.round(Math.min(x, width - 1))])}`,
    onStroke: (points) => paint({ frame, label: tool, points }),
  });

  // The results of each frame
  const areas = strip({ heading: 'What moves: the objects of the clip in their colours, a line for the pairs alone', count: COUNT, onPick: show });
  const agreement = strip({ heading: 'Agreement of the pairs alone with the clip', count: COUNT, onPick: show });
  const changed = strip({ heading: 'Changed by strokes', count: COUNT, onPick: show });
  const strips = [areas, agreement, changed];
  const table = html('tbody');
  const news = html('p', { class: 'news' });

  // Controls
  const at = slider({ label: 'Frame', min: 1, max: COUNT, step: 1, value: frame + 1, format: (value) => `${value} of ${COUNT}`, onInput: (value) => show(value - 1) });
  const play = button('Play', () => (playing ? pause() : start()));
  const views = choice({ label: 'Masks of', options: [['alone', 'its pairs alone'], ['whole', 'the whole clip']], value: view, onInput: (value) => ((view = value), show()) });
  const tools = html('div', { class: 'tools' });
  const example = button('Paint the shadow, for example', () => (show(EXAMPLE.frame), paint(EXAMPLE)));
  const back = button('Take back', takeBack);
  const stop = button('Stop', () => clip.cancel());

  stage.append(
    beside(
      html('div', { class: 'panel' }, html('div', { class: 'picture' }, screen, brushes), controls(at, play), controls(views)),
      html('div', { class: 'panel' }, ...strips.map(({ element }) => element), news),
    ),
    controls(tools, example, back, stop),
    html('details', {}, html('summary', {}, 'All frames as a table'), html('div', { class: 'scroll', tabindex: 0, role: 'group', 'aria-label': 'All frames' }, html('table', { class: 'numbers' }, html('thead', {}, row('th', ['Frame', 'Objects of the clip, pixels', 'Pairs alone, pixels', 'Agreement', 'Changed by strokes'])), table))),
  );
  stage.firstElementChild.classList.add('clip-parts');
  matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => show());

  let playing;
  function start() {
    playing = setInterval(() => step((frame + 1) % COUNT), 1000 / PER_SECOND);
    play.textContent = 'Pause';
  }
  function pause() {
    clearInterval(playing);
    playing = undefined;
    play.textContent = 'Play';
  }
  function step(next) {
    const input = at.querySelector('input');
    input.value = next + 1;
    input.dispatchEvent(new Event('input'));
  }

  /** Draws everything of one frame. */
  function show(next = frame) {
    if (next !== frame) {
      frame = next;
      const input = at.querySelector('input');
      if (input.valueAsNumber !== frame + 1) step(frame);
    }
    context.putImageData(withMasks(frames[frame], seen()), 0, 0);
    area.marks.replaceChildren(
      ...strokes.filter((stroke) => stroke.frame === frame).map(({ points, label }) => svg('polyline', { class: `stroke ${label ? classOf(label) : ''}`, points: pathOf(area, points), 'stroke-width': 2 * RADIUS })),
    );
    pen.show();
    for (const one of strips) one.point(frame);
    if (working === 0) say(sentence());
  }

  function figures(index) {
    const labels = corrected[index] ?? whole[index];
    const sizes = objects.map((id) => ({ id, pixels: labels ? count(labels, (label) => label === id) : 0 }));
    const alonePixels = alone[index] && count(alone[index], Boolean);
    const { both, any } = alone[index] && whole[index] ? overlap(alone[index], whole[index]) : {};
    return { sizes, alonePixels, agreement: any ? both / any : undefined, changed: corrected[index] ? difference(corrected[index], whole[index]) : 0 };
  }

  /** The strips and the table. */
  function summarise() {
    const all = frames.map((_, index) => figures(index));
    const most = Math.max(1, ...all.flatMap(({ sizes, alonePixels }) => [sum(sizes.map(({ pixels: size }) => size)), alonePixels ?? 0]));
    const mostChanged = Math.max(1, ...all.map((one) => one.changed));
    all.forEach((one, index) => {
      areas.bar(index, one.sizes.map(({ id, pixels: size }) => ({ share: size / most, tone: classOf(id) })), one.alonePixels === undefined ? undefined : one.alonePixels / most);
      agreement.bar(index, [{ share: one.agreement ?? 0 }]);
      changed.bar(index, [{ share: one.changed / mostChanged }]);
    });
    table.replaceChildren(...all.map((one, index) => row('td', [index + 1, one.sizes.map(({ id, pixels: size }) => `${id}: ${size}`).join(', '), one.alonePixels ?? '–', percent(one.agreement), one.changed])));
  }

  function sentence() {
    const { sizes, alonePixels, agreement: share, changed: here } = figures(frame);
    if (!whole[frame]) return `Frame ${frame + 1} of ${COUNT}.`;
    const visible = sizes.filter(({ pixels: size }) => size);
    const clip = visible.length ? visible.map(({ id, pixels: size }) => `object ${id} has ${grouped(size)} pixels`).join(', ') : 'nothing moves';
    const pairs = alonePixels === undefined ? 'No pair begins with this frame.' : share === undefined ? 'The pairs alone find the same.' : `The pairs alone find ${grouped(alonePixels)} pixels that move; both agree on ${percent(share)}.`;
    const spread = strokes.length ? ` ${strokes.length === 1 ? 'One stroke' : `${strokes.length} strokes`} changed ${grouped(here)} pixels here, and something in ${reached()} of ${COUNT} frames.` : '';
    return `Frame ${frame + 1} of ${COUNT}: in the whole clip ${clip}. ${pairs}${spread}`;
  }

  function ready() {
    const isSegmented = revisions.length > 0;
    for (const one of strips) one.busy(undefined);
    brushes.inert = !isSegmented;
    example.disabled = !isSegmented || strokes.includes(EXAMPLE);
    back.disabled = strokes.length === 0 || working > 0;
    stop.disabled = working === 0;
    summarise();
    show();
  }

  /** Waits for a step of the clip, which can be stopped. Returns whether it has taken effect. */
  async function done(step) {
    working += 1;
    back.disabled = true;
    stop.disabled = false;
    try {
      await step;
      return true;
    } catch (thrown) {
      news.textContent = thrown.code === 'cancelled' ? 'Stopped.' : thrown.message;
      return false;
    } finally {
      working -= 1;
    }
  }

  clip.subscribe((event) => {
    if (event.type === 'progress') for (const one of strips) one.busy(event.frame);
    else if (event.type === 'draft') drafted(event.frame);
    else if (event.type === 'frames' && revisions.length > 0) reading = Promise.all([reading, ...event.frames.map(changedIn)]);
  });

  function drafted({ index, labels }) {
    alone[index] = labels;
    news.textContent = `The pairs of ${alone.filter(Boolean).length} of ${COUNT} frames are solved.`;
    say(news.textContent);
    summarise();
    if (index === frame) show();
  }

  /** Equal revisions have equal labels: a frame whose strokes are taken back is again as it was found. */
  async function changedIn(index) {
    const { labels } = await clip.labels(index);
    corrected[index] = clip.frames[index].revision === revisions[index] ? undefined : labels;
    if (clip.steps.waiting > 0) {
      news.textContent = `The stroke has reached ${reached()} of ${COUNT} frames.`;
      say(news.textContent);
    }
    summarise();
    if (index === frame) show();
  }

  const reached = () => corrected.filter(Boolean).length;

  async function segment() {
    const step = clip.segment({ quality: 'fast', drafts: true });
    if (await done(step)) {
      for await (const { index, labels } of step) whole[index] = labels;
      objects = clip.objects.map(({ number }) => number);
      revisions = clip.frames.map(({ revision }) => revision);
      news.textContent = 'Is something wrong? Choose what it is and paint over it.';
    } else news.replaceChildren('Stopped. ', button('Go on', segment));
    offerTools();
    ready();
  }

  function offerTools() {
    const options = [0, ...objects].map((label) => [label, label ? `object ${label}` : 'ground']);
    tools.replaceChildren(choice({ label: 'This is', options, value: tool, onInput: (value) => (tool = value) }));
  }

  /** Annotates the frame of a stroke. Strokes that follow while it spreads wait for it. */
  async function paint(stroke) {
    strokes = [...strokes, stroke];
    const labels = new Uint8Array(width * height).fill(OPEN);
    stamp(labels, { width, height }, { ...stroke, radius: RADIUS });
    const result = done(clip.annotate({ frame: stroke.frame, labels }));
    ready();
    const isThere = await result;
    await reading;
    if (isThere) settled();
    else strokes = strokes.filter((other) => other !== stroke);
    ready();
  }

  async function takeBack() {
    strokes = strokes.slice(0, -1);
    await done(clip.undo());
    await reading;
    settled();
    ready();
  }

  function settled() {
    news.textContent = strokes.length ? `${reached()} of ${COUNT} frames have changed.` : 'All strokes are taken back.';
  }

  ready();
  news.textContent = 'Each frame is compared with its neighbours.';
  void segment();
}

const grouped = (value) => value.toLocaleString('en').replaceAll(',', '\u202f');
const row = (tag, cells) => html('tr', {}, ...cells.map((cell) => html(tag, {}, String(cell))));
const sum = (values) => values.reduce((total, value) => total + value, 0);
const percent = (share) => (share === undefined ? '–' : `${written(100 * share, 1)}\u00a0%`);

function count(labels, wanted) {
  let found = 0;
  for (const label of labels) found += wanted(label) ? 1 : 0;
  return found;
}
