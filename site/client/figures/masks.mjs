// From two frames to masks, stage by stage: what the product's own pipeline notes on its way.

import { computer } from '../compute.mjs';
import { STAGES } from '../pair-stages.mjs';
import { beside, button, choice, controls, html, pixels, pixelsOf } from './kit.mjs';

const SAMPLES = { cars: 'intel-two-cars', parallax: 'parallax' };

const address = (sample, name) => new URL(`../../samples/${sample}/${name}.png`, import.meta.url);
/** Its own worker: a pair takes seconds. */
const ask = computer();

export default async function mount({ stage, say }) {
  let pair;
  let at = 0;
  /** The picture that is chosen, of stages that have several. */
  const chosen = {};

  const picture = html('div', { class: 'picture' });
  const heading = html('h3');
  const thought = html('p');
  const head = html('thead');
  const numbers = html('tbody');
  const which = html('div');
  const news = html('p', { class: 'news', role: 'status' });
  const steps = html('div', { class: 'steps' });
  const back = button('Back', () => go(at - 1));
  const on = button('Next stage', () => go(at + 1));
  const files = html('input', { type: 'file', accept: 'image/*', multiple: '' });
  files.addEventListener('change', () => own([...files.files]));
  const source = choice({ label: 'Frames', options: [['cars', 'two cars'], ['parallax', 'parallax']], value: 'cars', onInput: sample });

  stage.append(
    steps,
    beside(html('div', { class: 'panel' }, picture, which), html('div', { class: 'panel' }, heading, thought, html('div', { class: 'scroll', tabindex: 0, role: 'group', 'aria-label': 'Numbers of the stage' }, html('table', { class: 'numbers' }, head, numbers)))),
    controls(back, on, source, html('label', { class: 'button own' }, 'Two frames of your own', files), news),
  );
  const parts = steps.nextElementSibling;
  parts.classList.add('clip-parts');
  stage.addEventListener('dragover', (event) => event.preventDefault());
  stage.addEventListener('drop', (event) => {
    event.preventDefault();
    void own([...event.dataTransfer.files]);
  });
  matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => pair && show());

  function sample(name) {
    return take(['first', 'second'].map((one) => pixels(address(SAMPLES[name], one))));
  }
  async function own(list) {
    if (list.length !== 2) return void (news.textContent = `Two pictures are needed, not ${list.length}. Choose both at once.`);
    const sorted = list.toSorted((one, other) => one.name.localeCompare(other.name, 'en', { numeric: true }));
    for (const input of source.querySelectorAll('input')) input.checked = false;
    await take(sorted.map(pixelsOf));
  }
  let newest;
  async function take(loading) {
    const mine = (newest = loading);
    news.textContent = 'The pair goes through all stages.';
    stage.classList.add('busy');
    try {
      const frames = await Promise.all(loading);
      const [plain, found] = await Promise.all([ask('derivativesOf', ...frames), ask('segmentPairStages', ...frames)]);
      if (newest !== mine) return;
      pair = { frames, plain, ...found, taken: found.hypotheses[found.chosen] };
      news.textContent = '';
      go(at);
    } catch (thrown) {
      if (newest === mine) news.textContent = thrown.message;
      if (!pair) throw thrown;
    } finally {
      if (newest === mine) stage.classList.remove('busy');
    }
  }

  function go(to) {
    at = Math.min(Math.max(0, to), STAGES.length - 1);
    const radios = choice({ label: 'Stage', options: STAGES.map(({ name }, k) => [k, [html('b', {}, String(k + 1)), ' ', html('span', { class: 'name' }, name)]]), value: at, onInput: go });
    const had = steps.contains(document.activeElement);
    steps.replaceChildren(radios);
    if (had) radios.querySelector(':checked').focus();
    back.disabled = at === 0;
    on.disabled = at === STAGES.length - 1;
    show();
  }

  function show() {
    const { name, views, what } = STAGES[at];
    const options = views(pair);
    const view = options.find(([key]) => key === chosen[at]) ?? options[0];
    heading.textContent = `${at + 1} ${name}`;
    which.replaceChildren(...(options.length > 1 ? [choice({ label: 'Picture', options: options.map(([key, text]) => [key, text]), value: view[0], onInput: pick })] : []));
    picture.replaceChildren(view[2](pair, name));
    const { text, head: columns = [], table, reading } = what(pair, view[0]);
    thought.textContent = text;
    head.replaceChildren(...(columns.length ? [html('tr', {}, ...columns.map((column) => html('th', { scope: 'col' }, column)))] : []));
    numbers.replaceChildren(...table.map(([label, ...values]) => html('tr', {}, html('th', { scope: 'row' }, label), ...values.map((value) => html('td', {}, value)))));
    say(`Stage ${at + 1} of ${STAGES.length}, ${name.toLowerCase()}. ${reading}`);
  }
  function pick(key) {
    chosen[at] = key;
    show();
    which.querySelector(':checked')?.focus();
  }

  await sample('cars');
}
