//! Whether the work on screen is saved, since when, or why not, with a button that saves it as a file. Screen readers announce it
//! once, and a refusal is a notice, which they announce as well.

import { type VNode, render } from 'preact';
import { useRef } from 'preact/hooks';
import { strings } from '../common/strings.js';
import type { Session } from '../session/session.js';
import type { Store } from '../state/state.js';
import { usePart } from './component.js';
import { saveProject } from './save-project.js';

export function mountSaving(root: HTMLElement, store: Store, session: Session): void {
  render(<Saving store={store} session={session} />, root);
}

function Saving({ store, session }: { store: Store; session: Session }): VNode {
  const keeping = usePart(store, (state) => state.keeping);
  const wasSaved = useRef(false);
  wasSaved.current ||= keeping.is === 'kept';
  const [what, where, more] = keeping.is === 'kept' ? strings.projects.savedHere(keeping.at, keeping.without) : keeping.is === 'refused' ? strings.projects.notSaved[keeping.code] : [];
  return (
    <>
      <button
        type="button"
        class={keeping.is === 'refused' ? 'refused' : undefined}
        hidden={keeping.is === 'nothing'}
        aria-busy={keeping.is === 'kept' && keeping.waits}
        title={strings.projects.keeping(keeping)}
        onClick={() => void saveProject(session)}
      >
        <span>
          {what}
          <span class="in-full">{where}</span>
          {more}
        </span>
        <span class="link">Save as a file</span>
      </button>
      <p class="visually-hidden" role="status">
        {wasSaved.current && strings.projects.firstSaved}
      </p>
    </>
  );
}
