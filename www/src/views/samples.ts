//! The samples: small moving pictures over their names. They move while they can be seen, rest beside other frames, and fold away once a person
//! has frames of their own.

import { SAMPLES, type Sample } from '../frames/samples.js';
import type { Session } from '../session/session.js';
import type { Store } from '../state/state.js';
import { element, find } from './markup.js';

export function mountSamples(root: HTMLElement, store: Store, session: Session): void {
  const buttons = SAMPLES.map((sample) => ({ sample, button: buttonOf(sample, () => void session.open.sample(sample)) }));
  root.append(...buttons.map(({ button }) => button));
  new IntersectionObserver((changes) => root.classList.toggle('seen', changes.at(-1)!.isIntersecting)).observe(root);

  const open = (): Sample | undefined => store.get().tracked?.clip.sample;
  const details = find(document, '#welcome', HTMLDetailsElement);
  // Whoever folds or unfolds them has the last word.
  let touched = false;
  find(details, 'summary', HTMLElement).addEventListener('click', () => (touched = true));
  const fold = (): void => {
    const { pair, live } = store.get();
    if (!touched) details.open = pair.first === null || live !== null || open() !== undefined;
  };
  store.subscribe(({ pair }, before) => {
    if (pair === before.pair) return;
    fold();
    for (const { sample, button } of buttons) button.setAttribute('aria-current', String(sample === open()));
  });
}

function buttonOf({ title, thumbnail }: Sample, open: () => void): HTMLElement {
  const button = element('button', '', 'sample');
  button.type = 'button';
  const window = element('span', '', 'window');
  const strip = element('img');
  strip.alt = '';
  strip.loading = 'lazy';
  strip.decoding = 'async';
  strip.style.setProperty('--count', String(thumbnail.count));
  strip.style.setProperty('--each', `${thumbnail.each}s`);
  strip.src = thumbnail.path;
  window.append(strip);
  button.append(window, element('span', title));
  button.addEventListener('click', open);
  return button;
}
