//! An example of a host page: it gives `<veronese-segmenter>` two frames and lists the masks as annotations.

import { VeroneseSegmenterElement } from 'veronese/element';
import { SAMPLES } from './frames/samples.js';

const find = <E extends Element>(selector: string, kind: abstract new (...args: never) => E): E => {
  const element = document.querySelector(selector);
  if (!(element instanceof kind)) throw new Error(`embed.html has no ${selector}`);
  return element;
};

const segmenter = find('veronese-segmenter', VeroneseSegmenterElement);
const status = find('#host-status', HTMLElement);
const annotations = find('#annotations', HTMLElement);
const pair = find('[name=pair]', HTMLSelectElement);
const motions = find('[name=motions]', HTMLSelectElement);

pair.append(...SAMPLES.map(({ title, id }) => new Option(title, id)));
pair.addEventListener('change', () => {
  const sample = SAMPLES[pair.selectedIndex] ?? SAMPLES[0];
  segmenter.setAttribute('first', sample.first);
  segmenter.setAttribute('second', sample.second);
});
motions.addEventListener('change', () => segmenter.setAttribute('motions', motions.value));

segmenter.addEventListener('progress', ({ detail: { stage, index, of } }) => (status.textContent = `${stage}, ${index + 1} of ${of}`));
segmenter.addEventListener('error', ({ detail: { message } }) => (status.textContent = `No masks: ${message}.`));
segmenter.addEventListener('result', ({ detail: { width, height, motions: found } }) => {
  const groups = [...new Set(found.map(({ group }) => group))].filter((group) => group !== 0);
  status.textContent = `${groups.length} masks received.`;
  annotations.replaceChildren(...groups.map((group) => annotation(group, segmenter.mask(group) ?? new Uint8Array(), width, height)));
});

/** One item of the host's list: a thumbnail of the mask and its number of pixels. */
function annotation(group: number, mask: Uint8Array, width: number, height: number): HTMLElement {
  const canvas = document.createElement('canvas');
  canvas.width = width;
  canvas.height = height;
  const image = new ImageData(width, height);
  mask.forEach((value, p) => image.data.set([value, value, value, 255], 4 * p));
  canvas.getContext('2d')?.putImageData(image, 0, 0);
  const item = document.createElement('li');
  item.append(canvas, `Object ${group}: ${mask.filter((value) => value === 255).length} pixels`);
  return item;
}
