// A clip: what the pairs of each frame tell alone, what all frames tell together, and how a stroke in one frame goes through the others.

import { SegmenterPool } from '../../package/dist/web.js';
import { brush, pathOf } from '../brush.mjs';
import { difference, overlap, stamp, classOf, withMasks } from '../masks.mjs';
import { strip } from '../strip.mjs';
import { beside, button, canvas, choice, controls, html, pixels, plot, slider, svg, written } from './kit.mjs';

const COUNT = 25;
const EVERY = 2;
const MOST_WORKERS = 4;
const RADIUS = 8;
const SAID_NOTHING = 255;
const PER_SECOND = 6;
/** A stroke to begin with: beneath the second car, on its shadow. */
const EXAMPLE = { frame: 17, label: 0, points: [[228, 240], [306, 240]] };

const address = (frame) => new URL(`../../samples/passing-cars/frames/${String(2 + EVERY * frame).padStart(2, '0')}.webp`, import.meta.url);

export default async function mount({ stage, say }) {
  const frames = await Promise.all(Array.from({ length: COUNT }, (_, frame) => pixels(address(frame))));
  const { width, height } = frames[0];
  const source = { length: COUNT, read: (index) => frames[index] };
  const segmenter = new SegmenterPool({ jobs: Math.min(MOST_WORKERS, navigator.hardwareConcurrency || 1) });

  /** Labels of each frame: of its pairs alone, of the whole clip, and with strokes. */
  const [alone, whole, corrected] = [[], [], []];
  /** The evidence of each pair, with which a run that was stopped goes on. */
  const known = [];
  let [state, strokes, frame, view, tool] = [undefined, [], EXAMPLE.frame, 'whole', 0];
  let running;
  let objects = [];
  /** The state to which a stopped stroke returns. */
  let settled = { strokes, corrected: [] };

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
    onStroke: (points) => state && correct([...strokes, { frame, label: tool, points }]),
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
  const example = button('Paint the shadow, for example', () => (show(EXAMPLE.frame), correct([...strokes, EXAMPLE])));
  const back = button('Take back', () => correct(strokes.slice(0, -1)));
  const stop = button('Stop', () => running?.abort());

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
    if (!running) say(reading());
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

  function reading() {
    const { sizes, alonePixels, agreement: share, changed: here } = figures(frame);
    if (!whole[frame]) return `Frame ${frame + 1} of ${COUNT}.`;
    const visible = sizes.filter(({ pixels: size }) => size);
    const clip = visible.length ? visible.map(({ id, pixels: size }) => `object ${id} has ${grouped(size)} pixels`).join(', ') : 'nothing moves';
    const pairs = alonePixels === undefined ? 'No pair begins with this frame.' : share === undefined ? 'The pairs alone say the same.' : `The pairs alone find ${grouped(alonePixels)} pixels that move; both agree on ${percent(share)}.`;
    const reached = corrected.filter(Boolean).length;
    const spread = strokes.length ? ` ${strokes.length === 1 ? 'One stroke' : `${strokes.length} strokes`} changed ${grouped(here)} pixels here, and something in ${reached} of ${COUNT} frames.` : '';
    return `Frame ${frame + 1} of ${COUNT}: in the whole clip ${clip}. ${pairs}${spread}`;
  }

  function ready() {
    running = undefined;
    for (const one of strips) one.busy(undefined);
    brushes.inert = !state;
    example.disabled = !state || strokes.includes(EXAMPLE);
    back.disabled = strokes.length === 0;
    stop.disabled = true;
    summarise();
    show();
  }

  /** Runs something that can be stopped. Says whether it came to its end. */
  async function run(work) {
    running?.abort();
    const mine = (running = new AbortController());
    stop.disabled = false;
    try {
      await work(mine);
      return running === mine;
    } catch (thrown) {
      if (running !== mine) return false;
      news.textContent = thrown.code === 'cancelled' ? 'Stopped.' : thrown.message;
      return undefined;
    }
  }

  async function segment() {
    const done = await run(async ({ signal }) => {
      const clip = segmenter.segmentClip(source, {
        quality: 'fast',
        signal,
        onPairs: (index, pairs) => void (known[index] = pairs),
        knownPairs: (index) => known[index],
        onPreview: ({ index, labels }) => {
          alone[index] = labels;
          news.textContent = `The pairs of ${alone.filter(Boolean).length} of ${COUNT} frames are solved.`;
          say(news.textContent);
          summarise();
          if (index === frame) show();
        },
        onProgress: ({ frame: at, stage: what }) => {
          if (what === 'pairs') for (const one of strips) one.busy(at);
        },
      });
      for await (const { index, labels } of clip) whole[index] = labels;
      objects = clip.tracks().objects.map(({ id }) => id);
      state = await clip.state();
    });
    if (done === false) return;
    if (done) news.textContent = 'Is something wrong? Choose what it is and paint over it.';
    else news.replaceChildren('Stopped. ', button('Go on', segment));
    offerTools();
    ready();
  }

  function offerTools() {
    const options = [0, ...objects].map((label) => [label, label ? `object ${label}` : 'ground']);
    tools.replaceChildren(choice({ label: 'This is', options, value: tool, onInput: (value) => (tool = value) }));
  }

  /** The clip under the strokes `next`, which all count together. */
  async function correct(next) {
    strokes = next;
    example.disabled = back.disabled = true;
    const changes = [];
    const done = await run(async ({ signal }) => {
      const clip = segmenter.segmentClip(source, {
        state,
        corrections: corrections(),
        changesOnly: true,
        signal,
        onChange: async (index, segmented) => {
          changes[index] = (await segmented()).labels;
          if (!signal.aborted) spreads(index, changes);
        },
        onProgress: ({ frame: at, stage: what }) => {
          if (what === 'corrections') for (const one of strips) one.busy(at);
        },
      });
      for await (const { index, labels } of clip) changes[index] = labels;
    });
    if (done === false) return;
    if (done) settled = { strokes, corrected: changes };
    strokes = settled.strokes;
    for (let index = 0; index < COUNT; index++) corrected[index] = settled.corrected[index];
    if (done) news.textContent = strokes.length ? `${changes.filter(Boolean).length} of ${COUNT} frames have changed.` : 'All strokes are taken back.';
    ready();
  }

  function spreads(index, changes) {
    corrected[index] = changes[index];
    news.textContent = `The stroke has reached ${changes.filter(Boolean).length} of ${COUNT} frames.`;
    say(news.textContent);
    summarise();
    if (index === frame) show();
  }

  function corrections() {
    return [...new Set(strokes.map((stroke) => stroke.frame))].map((spoken) => {
      const labels = new Uint8Array(width * height).fill(SAID_NOTHING);
      for (const stroke of strokes) if (stroke.frame === spoken) stamp(labels, { width, height }, { ...stroke, radius: RADIUS });
      return { frame: spoken, labels };
    });
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
