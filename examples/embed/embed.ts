//! An example of a host page: a form with masks of `<veronese-segmenter>` and names of their objects. It uses what the package documents,
//! and nothing of the other page.

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
const motions = find('#motions', HTMLSelectElement);
const cancel = find('#cancel', HTMLButtonElement);
const status = find('#host-status', HTMLElement);
const annotations = find('#annotations', HTMLElement);
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
  annotations.replaceChildren();
  if (first instanceof File && first.type.startsWith('video/')) segmenter.src = URL.createObjectURL(first);
  else if (given.length > 2) segmenter.frames = given;
  else if (first !== undefined && second !== undefined) segmenter.setFrames(first, second).catch(() => undefined); // an event follows
  else status.textContent = 'A video or at least two frames are needed.';
}

source.append(...SOURCES.map(({ title }) => new Option(title)));
source.addEventListener('change', () => open(SOURCES[source.selectedIndex]?.frames ?? []));
files.addEventListener('change', () => {
  const byName = new Intl.Collator('en', { numeric: true });
  open([...(files.files ?? [])].sort((one, other) => byName.compare(one.name, other.name)));
});
motions.addEventListener('change', () => segmenter.setAttribute('motions', motions.value));

// Events of the element.

segmenter.addEventListener('progress', ({ detail }) => {
  cancel.hidden = false;
  status.textContent =
    'frame' in detail
      ? `Frame ${detail.frame + 1}${detail.of === undefined ? '' : ` of ${detail.of}`}…`
      : `Step ${detail.index + 1} of ${detail.of}…`;
});
segmenter.addEventListener('error', ({ detail: { message } }) => end(`No masks: ${message}.`));
segmenter.addEventListener('result', ({ detail: { motions } }) => {
  const objects = [...new Set(motions.map(({ group }) => group))].filter((group) => group !== 0).sort((one, other) => one - other);
  list(objects);
  end(`${counted(objects.length, 'object')} in two frames.`);
});
segmenter.addEventListener('tracks', ({ detail: { objects } }) => {
  list(objects.map(({ id }) => id));
  end(`${counted(objects.length, 'object')} in ${counted(segmenter.frameCount, 'frame')}.`);
});
segmenter.addEventListener('select', ({ detail }) => mark(detail));
cancel.addEventListener('click', () => {
  segmenter.abort();
  end('Cancelled.');
});

function end(sentence: string): void {
  cancel.hidden = true;
  status.textContent = sentence;
}

/** Lists objects. Their names are fields of the form; whoever names one sees which it is. */
function list(objects: readonly number[]): void {
  annotations.replaceChildren(
    ...objects.map((object) => {
      const name = Object.assign(document.createElement('input'), { name: `object-${object}`, placeholder: `Object ${object}` });
      name.setAttribute('aria-label', `Name of object ${object}`);
      name.addEventListener('focus', () => {
        segmenter.selected = object;
        mark(object);
      });
      const item = document.createElement('li');
      // The colours of the masks, which the style sheet gives to the element too.
      item.style.setProperty('--colour', `var(--veronese-colour-${1 + ((object - 1) % 8)})`);
      item.append(name);
      return item;
    }),
  );
}

function mark(object: number | null): void {
  for (const item of annotations.children) item.classList.toggle('chosen', item.querySelector('input')?.name === `object-${object}`);
}

// The form: nothing is sent; what would be is shown.

form.addEventListener('submit', (event) => {
  event.preventDefault();
  find('#fields', HTMLElement).replaceChildren(...[...new FormData(form)].map(([name, value]) => field(name, value)));
  saved.showModal();
});
form.addEventListener('reset', () => mark(null));
saved.addEventListener('close', () => {
  for (const link of saved.querySelectorAll('a')) URL.revokeObjectURL(link.href);
});

function field(name: string, value: FormDataEntryValue): HTMLElement {
  const item = document.createElement('li');
  if (typeof value === 'string') item.append(`${name}: ${value}`);
  else
    item.append(
      `${name}: `,
      Object.assign(document.createElement('a'), { href: URL.createObjectURL(value), download: value.name, textContent: value.name }),
    );
  return item;
}

function counted(count: number, thing: string): string {
  return `${count} ${thing}${count === 1 ? '' : 's'}`;
}

open(clip);
