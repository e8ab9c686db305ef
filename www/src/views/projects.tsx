//! The projects: whether the work is kept, saving it as a file, and the list of those that this browser keeps. Loaded with the panel.

import { type VNode, render } from 'preact';
import { useMemo, useRef } from 'preact/hooks';
import { codeOf, sentenceOf } from '../common/errors.js';
import { strings } from '../common/strings.js';
import type { Listed } from '../projects/shelf.js';
import type { Session } from '../session/session.js';
import type { Store } from '../state/state.js';
import { usePart } from './component.js';
import { listedProjects, refreshListed } from './listed.js';
import { saveProject } from './save-project.js';

export function mountProjects(root: HTMLElement, store: Store, session: Session): void {
  render(<Projects store={store} session={session} />, root);
}

function Projects({ store, session }: { store: Store; session: Session }): VNode {
  const keeping = usePart(store, (state) => state.keeping);
  const { value: listed } = useMemo(listedProjects, []);
  const all = useRef<HTMLDetailsElement>(null);
  const forget = async (one: Listed): Promise<void> => {
    try {
      await session.projects.forget(one);
      session.say(strings.projects.forgotten(one.header.name));
    } catch (error) {
      session.say(sentenceOf(error), codeOf(error));
    }
    await refreshListed();
    (all.current!.querySelector('button') ?? all.current!.querySelector('summary'))?.focus();
  };
  return (
    <>
      <h3>Project</h3>
      <p id="project-status" class="help">
        {strings.projects.keeping(keeping)}
      </p>
      <div class="copies">
        <button type="button" id="save-project" class="button small" onClick={() => void saveProject(session)}>
          Save project
        </button>
      </div>
      <details ref={all} class="more" hidden={listed.length === 0}>
        <summary>{strings.projects.summary(listed.length)}</summary>
        <ul id="projects" class="projects">
          {listed.map((one) => {
            const { of, name, frames, saved } = one.header;
            return (
              <li key={of} data-of={of}>
                <div>
                  <strong>{name}</strong>
                  <span class="faint">{strings.projects.facts(frames, one.bytes, new Date(saved))}</span>
                </div>
                <button type="button" class="button small quiet" aria-label={strings.projects.forgetOf(name)} onClick={() => void forget(one)}>
                  {strings.projects.forget}
                </button>
              </li>
            );
          })}
        </ul>
      </details>
    </>
  );
}
