//! The first words; or work that the browser keeps, to go on with: the newest in their place, the others behind it.

import { type VNode, render } from 'preact';
import { useLayoutEffect, useMemo } from 'preact/hooks';
import { strings } from '../common/strings.js';
import { sampleCalled } from '../frames/samples.js';
import { type Listed, framesOf } from '../projects/shelf.js';
import type { Session } from '../session/session.js';
import type { Store } from '../state/state.js';
import { usePart } from './component.js';
import { listedProjects } from './listed.js';
import { find } from './markup.js';

interface Given {
  readonly store: Store;
  readonly session: Session;
}

export function mountContinuing(root: HTMLElement, store: Store, session: Session): void {
  render(<Continuing title={find(root, 'summary', HTMLElement)} store={store} session={session} />, find(root, '.beginning', HTMLElement));
}

function Continuing({ title, store, session }: Given & { title: HTMLElement }): VNode {
  const open = usePart(store, ({ tracked }) => tracked?.clip.fingerprint);
  const { value: listed } = useMemo(listedProjects, []);
  const [newest, ...others] = listed.filter(({ header }) => header.of !== open);
  useLayoutEffect(() => void (title.textContent = newest === undefined ? strings.projects.welcome : strings.projects.continue), [newest === undefined]);
  if (newest === undefined) return <p>No model, no upload: drop a video or frames here. Or try one of these.</p>;
  return (
    <section id="continue" class="continue" aria-label="Continue your work">
      <ul>
        <Work key={newest.header.of} listed={newest} session={session} />
      </ul>
      {others.length > 0 && (
        <details>
          <summary>{strings.projects.more(others.length)}</summary>
          <ul>
            {others.map((one) => (
              <Work key={one.header.of} listed={one} session={session} />
            ))}
          </ul>
        </details>
      )}
    </section>
  );
}

function Work({ listed: { header, hasFrames }, session }: { listed: Listed; session: Session }): VNode {
  const { of, name, frames, saved, thumbnail } = header;
  const sample = sampleCalled(header.sample ?? null);
  const open = (): void => {
    if (sample !== null) void session.open.sample(sample);
    else if (hasFrames) void session.open.files(framesOf(of));
    // Their project is found when they are opened.
    else find(document, '#open-pair', HTMLInputElement).click();
  };
  return (
    <li data-of={of}>
      <button type="button" class="work" title={name} onClick={open}>
        <img alt="" hidden={thumbnail === undefined} src={thumbnail} />
        <span>
          <strong>{name}</strong>
          <span class="faint">{strings.projects.left(frames, new Date(saved), sample !== null || hasFrames)}</span>
        </span>
      </button>
    </li>
  );
}
