//! The samples: small moving pictures over their names. They move while they can be seen, rest beside other frames, and fold away once a person
//! has frames of their own.

import { type VNode, render } from 'preact';
import { SAMPLES } from '../frames/samples.js';
import type { Session } from '../session/session.js';
import type { Store } from '../state/state.js';
import { usePart } from './component.js';
import { find } from './markup.js';

export function mountSamples(root: HTMLElement, store: Store, session: Session): void {
  render(<Samples store={store} session={session} />, root);
  new IntersectionObserver((changes) => root.classList.toggle('seen', changes.at(-1)!.isIntersecting)).observe(root);

  const details = find(document, '#welcome', HTMLDetailsElement);
  // Whoever folds or unfolds them has the last word.
  let touched = false;
  find(details, 'summary', HTMLElement).addEventListener('click', () => (touched = true));
  store.subscribe(({ pair, live, tracked }, before) => {
    if (pair !== before.pair && !touched) details.open = pair.first === null || live !== null || tracked?.clip.sample !== undefined;
  });
}

function Samples({ store, session }: { store: Store; session: Session }): VNode {
  const open = usePart(store, ({ tracked }) => tracked?.clip.sample);
  return (
    <>
      {SAMPLES.map((sample) => (
        <button key={sample.id} type="button" class="sample" aria-current={sample === open} onClick={() => void session.open.sample(sample)}>
          <span class="window">
            <img
              alt=""
              loading="lazy"
              decoding="async"
              style={{ '--count': sample.thumbnail.count, '--each': `${sample.thumbnail.each}s` }}
              src={sample.thumbnail.path}
            />
          </span>
          <span>{sample.title}</span>
        </button>
      ))}
    </>
  );
}
