//! An example of a host page: a small annotation tool around `<veronese-segmenter>`. It uses what the package documents, and nothing of
//! the other page.

import { VeroneseSegmenterElement } from 'veronese/element';

const find = <E extends Element>(selector: string, kind: abstract new (...args: never) => E): E => {
  const element = document.querySelector(selector);
  if (!(element instanceof kind)) throw new Error(`embed.html has no ${selector}`);
  return element;
};

const segmenter = find('#segmenter', VeroneseSegmenterElement);
const form = find('#annotation', HTMLFormElement);
const source = find('#source', HTMLSelectElement);
const files = find('#open', HTMLInputElement);
const cancel = find('#cancel', HTMLButtonElement);
const status = find('#host-status', HTMLElement);
const timeline = find('#timeline', HTMLElement);
const lanes = find('#lanes', HTMLElement);
const position = find('#position', HTMLOutputElement);
const playing = find('#play', HTMLButtonElement);
const annotations = find('#annotations', HTMLElement);
const empty = find('#empty', HTMLElement);
const saved = find('#saved', HTMLDialogElement);

// Sources: frames that come with the page, and files.

// From where both cars are in the picture.
const clip = Array.from({ length: 33 }, (_, k) => `samples/passing-cars/frames/${16 + k}.webp`);
const pair = (sample: string): string[] => ['first', 'second'].map((name) => `samples/${sample}/${name}.png`);
const SOURCES: readonly { title: string; frames: readonly string[] }[] = [
  { title: 'Passing cars, clip', frames: clip },
  { title: 'Two cars, pair', frames: pair('intel-two-cars') },
  { title: 'Parallax, pair', frames: pair('parallax') },
];

/** Two frames are a pair, more are a clip, and a video is one too. */
function open(given: readonly (string | File)[]): void {
  const [first, second] = given;
  const isVideo = first instanceof File && first.type.startsWith('video/');
  clear();
  timeline.hidden = !isVideo && given.length < 3;
  if (isVideo) segmenter.src = URL.createObjectURL(first);
  else if (given.length > 2) segmenter.frames = given;
  else if (first !== undefined && second !== undefined) segmenter.setFrames(first, second).catch(() => undefined); // said by the event
  else status.textContent = 'A video or at least two frames are needed.';
}

source.append(...SOURCES.map(({ title }) => new Option(title)));
source.addEventListener('change', () => open(SOURCES[source.selectedIndex]?.frames ?? []));
files.addEventListener('change', () => {
  const byName = new Intl.Collator('en', { numeric: true });
  const given = [...(files.files ?? [])].sort((one, other) => byName.compare(one.name, other.name));
  files.value = '';
  if (given.length > 0) open(given);
});
for (const name of ['motions', 'quality']) {
  const select = find(`#${name}`, HTMLSelectElement);
  select.addEventListener('change', () => segmenter.setAttribute(name, select.value));
}

// What the element tells.

/** Of the frame that is shown. */
let size = { width: 1, height: 1 };

segmenter.addEventListener('progress', ({ detail }) => {
  cancel.hidden = false;
  status.textContent = 'frame' in detail ? `Frame ${detail.frame + 1}${detail.of === undefined ? '' : ` of ${detail.of}`}…` : `Step ${detail.index + 1} of ${detail.of}…`;
});
segmenter.addEventListener('error', ({ detail: { message } }) => end(`No masks: ${message}.`));
segmenter.addEventListener('result', ({ detail: { width, height, motions } }) => {
  size = { width, height };
  const groups = new Set(motions.map(({ group }) => group));
  groups.delete(0);
  list([...groups].sort((one, other) => one - other));
  end(`${counted(groups.size, 'object')} in two frames.`);
});
segmenter.addEventListener('show', ({ detail: { index, width, height } }) => {
  size = { width, height };
  list(segmenter.tracks()?.objects.map(({ id }) => id) ?? []);
  tell(index);
});
segmenter.addEventListener('tracks', ({ detail: { objects } }) => {
  drawLanes();
  list(objects.map(({ id }) => id));
  tell(segmenter.currentFrame);
  end(`${counted(objects.length, 'object')} in ${counted(segmenter.frameCount, 'frame')}.`);
});
segmenter.addEventListener('select', ({ detail }) => choose(detail));

cancel.addEventListener('click', () => {
  segmenter.abort();
  end('Cancelled.');
});

function end(sentence: string): void {
  cancel.hidden = true;
  status.textContent = sentence;
}

function clear(): void {
  stop();
  segmenter.selected = null;
  position.value = '';
  lanes.replaceChildren();
  annotations.replaceChildren();
  empty.hidden = false;
}

// The list of objects. Their names are fields of the form.

/** Lists objects; those that are listed already keep what was typed. */
function list(objects: readonly number[]): void {
  const items = new Map(itemsOf().map((item) => [Number(item.dataset['object']), item]));
  annotations.replaceChildren(...objects.map((object) => items.get(object) ?? newItem(object)));
  for (const item of itemsOf()) describe(item);
  empty.hidden = objects.length > 0;
  choose(segmenter.selected);
}

function itemsOf(): HTMLElement[] {
  return [...annotations.querySelectorAll<HTMLElement>('li')];
}

function newItem(object: number): HTMLElement {
  const item = document.createElement('li');
  item.dataset['object'] = String(object);
  item.style.setProperty('--colour', colourOf(object));
  const pick = document.createElement('button');
  pick.type = 'button';
  pick.setAttribute('aria-label', `Choose object ${object}`);
  pick.append(document.createElement('canvas'));
  pick.addEventListener('click', () => choose(segmenter.selected === object ? null : object));
  const name = document.createElement('input');
  name.name = `object-${object}`;
  name.setAttribute('form', form.id);
  name.placeholder = `Object ${object}`;
  name.setAttribute('aria-label', `Name of object ${object}`);
  name.addEventListener('focus', () => choose(object));
  name.addEventListener('input', drawLanes);
  item.append(pick, name, document.createElement('span'));
  return item;
}

/** The shape of the object in the frame that is shown, and its size. */
function describe(item: HTMLElement): void {
  const canvas = item.querySelector('canvas');
  const told = item.querySelector('span');
  const mask = segmenter.mask(Number(item.dataset['object']));
  if (!canvas || !told || !mask) return;
  const pixels = mask.filter((value) => value === 255).length;
  told.textContent = pixels === 0 ? 'not in this frame' : `${pixels.toLocaleString('en-GB')} pixels`;
  item.classList.toggle('absent', pixels === 0);
  // The shape fills the picture of it.
  const [left, top, right, bottom] = box(mask, size.width);
  const side = Math.max(right - left, bottom - top, 1);
  canvas.width = canvas.height = 96;
  const context = canvas.getContext('2d');
  const shape = new OffscreenCanvas(size.width, size.height);
  const image = new ImageData(size.width, size.height);
  mask.forEach((value, p) => (image.data[4 * p + 3] = value));
  shape.getContext('2d')?.putImageData(image, 0, 0);
  if (!context || pixels === 0) return;
  context.drawImage(shape, (left + right - side) / 2, (top + bottom - side) / 2, side, side, 6, 6, 84, 84);
  context.globalCompositeOperation = 'source-in';
  context.fillStyle = getComputedStyle(item).getPropertyValue('--colour');
  context.fillRect(0, 0, 96, 96);
}

/** The edges of what a mask shows. */
function box(mask: Uint8Array, width: number): [left: number, top: number, right: number, bottom: number] {
  let [left, top, right, bottom] = [width, Infinity, 0, 0];
  mask.forEach((value, p) => {
    if (value === 0) return;
    const [x, y] = [p % width, Math.floor(p / width)];
    left = Math.min(left, x);
    right = Math.max(right, x + 1);
    top = Math.min(top, y);
    bottom = Math.max(bottom, y + 1);
  });
  return [left, top, right, bottom];
}

/** Marks an object here and in the element. */
function choose(object: number | null): void {
  segmenter.selected = object;
  for (const item of itemsOf()) {
    const chosen = Number(item.dataset['object']) === object;
    item.classList.toggle('chosen', chosen);
    item.querySelector('button')?.setAttribute('aria-pressed', String(chosen));
  }
  for (const lane of lanes.children) lane.classList.toggle('chosen', lane instanceof HTMLElement && lane.dataset['object'] === String(object));
}

/** The colours of the masks, which the style sheet gives to the element too. */
function colourOf(object: number): string {
  return `var(--veronese-colour-${1 + ((object - 1) % 8)})`;
}

// The timeline: the element has the slider, the page adds a lane for each object.

function drawLanes(): void {
  const last = Math.max(1, segmenter.frameCount - 1);
  const drawn = (segmenter.tracks()?.objects ?? []).map(({ id, frames }) => {
    const lane = document.createElement('div');
    lane.dataset['object'] = String(id);
    lane.style.setProperty('--colour', colourOf(id));
    const seen = frames.map(({ frame }) => frame);
    const begins = seen.filter((frame) => !seen.includes(frame - 1));
    const ends = seen.filter((frame) => !seen.includes(frame + 1));
    begins.forEach((first, run) => {
      const bar = document.createElement('span');
      bar.style.left = `${(100 * first) / last}%`;
      bar.style.width = `${(100 * ((ends[run] ?? first) - first)) / last}%`;
      if (run === 0) bar.textContent = nameOf(id);
      lane.append(bar);
    });
    return lane;
  });
  lanes.replaceChildren(...drawn);
  choose(segmenter.selected);
}

function nameOf(object: number): string {
  const name = form.elements.namedItem(`object-${object}`);
  return (name instanceof HTMLInputElement && name.value) || `Object ${object}`;
}

function tell(frame: number): void {
  const last = Math.max(1, segmenter.frameCount - 1);
  position.value = `Frame ${frame + 1} of ${segmenter.frameCount}`;
  lanes.style.setProperty('--at', String(frame / last));
}

lanes.addEventListener('click', ({ clientX, target }) => {
  const lane = target instanceof Element ? target.closest('[data-object]') : null;
  if (!(lane instanceof HTMLElement)) return;
  const { left, width } = lane.getBoundingClientRect();
  segmenter.currentFrame = Math.round(((clientX - left) / width) * (segmenter.frameCount - 1));
  choose(Number(lane.dataset['object']));
});

for (const [selector, frames] of [['#back', -1], ['#forward', 1]] as const) {
  find(selector, HTMLButtonElement).addEventListener('click', () => {
    stop();
    segmenter.currentFrame += frames;
  });
}

let player: ReturnType<typeof setInterval> | undefined;
playing.addEventListener('click', () => {
  if (player !== undefined) return stop();
  player = setInterval(() => (segmenter.currentFrame = (segmenter.currentFrame + 1) % segmenter.frameCount), 160);
  playing.setAttribute('aria-pressed', 'true');
});

function stop(): void {
  clearInterval(player);
  player = undefined;
  playing.setAttribute('aria-pressed', 'false');
}

// The form: nothing is sent; what would be is shown.

form.addEventListener('submit', (event) => {
  event.preventDefault();
  find('#fields', HTMLElement).replaceChildren(...[...new FormData(form)].map(([name, value]) => field(name, value)));
  saved.showModal();
});
form.addEventListener('reset', () => {
  stop();
  // The form is empty, and the element reset, after this event.
  setTimeout(() => {
    choose(null);
    if (!timeline.hidden) drawLanes();
  });
});
saved.addEventListener('close', () => {
  for (const link of saved.querySelectorAll('a')) URL.revokeObjectURL(link.href);
});

function field(name: string, value: FormDataEntryValue): HTMLElement {
  const item = document.createElement('li');
  const label = document.createElement('code');
  label.textContent = name;
  item.append(label);
  if (typeof value === 'string') {
    item.append(value === '' ? '(empty)' : value);
    return item;
  }
  const link = document.createElement('a');
  link.href = URL.createObjectURL(value);
  link.download = value.name;
  const image = document.createElement('img');
  image.src = link.href;
  image.alt = '';
  link.append(image, value.name);
  item.append(link, `${(value.size / 1024).toFixed(1)} KB`);
  return item;
}

function counted(count: number, thing: string): string {
  return `${count} ${thing}${count === 1 ? '' : 's'}`;
}

open(SOURCES[0]?.frames ?? []);
