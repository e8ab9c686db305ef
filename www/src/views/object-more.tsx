//! What else can be done with an object, and with all others.

import type { VNode } from 'preact';
import { useLayoutEffect, useState } from 'preact/hooks';
import { strings } from '../common/strings.js';
import type { Session } from '../session/session.js';
import type { Store } from '../state/state.js';
import { livesOf } from '../state/tracked.js';
import { memo } from './component.js';

interface Given {
  readonly id: number;
  readonly name: string;
  readonly ready: boolean;
  /** Numbers and names of all objects. */
  readonly others: readonly (readonly [number, string])[];
  readonly store: Store;
  readonly session: Session;
}

export const ObjectMore = memo(function ({ id, name, ready, others, store, session }: Given): VNode {
  // A select changes with every arrow key, so it only chooses.
  const [into, setInto] = useState('');
  const partners = others.filter(([other]) => other !== id);
  const isChosen = partners.some(([other]) => String(other) === into);
  // One that comes back is not chosen any more.
  useLayoutEffect(() => {
    if (!isChosen) setInto('');
  }, [isChosen]);
  const isAlone = partners.length === 0;
  const otherIds = (): number[] => livesOf(store.get().tracked ?? { frames: [] }).map((life) => life.id).filter((other) => other !== id);
  const aboutOthers = [
    { what: 'Lock', action: 'lock-others', run: () => session.objects.toggleLock(...otherIds()) },
    { what: 'Hide', action: 'hide-others', run: () => store.look({ hidden: new Set(otherIds()), solo: null }) },
    { what: 'Delete', action: 'remove-others', run: () => session.objects.remove(...otherIds()) },
  ];
  return (
    <details class="more">
      <summary>
        <span>More</span>
      </summary>
      <div class="copies">
        <select data-action="merge-with" aria-label={strings.mergeWithOf(name)} disabled={!ready} hidden={isAlone} onChange={({ currentTarget }) => setInto(currentTarget.value)}>
          <option value="">{strings.mergeWith}</option>
          {partners.map(([other, called]) => (
            <option key={other} value={String(other)}>
              {called}
            </option>
          ))}
        </select>
        <button
          type="button"
          class="button small quiet"
          data-action="merge"
          aria-label={strings.mergeOf(name)}
          disabled={!ready || !isChosen}
          hidden={isAlone}
          onClick={() => session.objects.merge(id, Number(into))}
        >
          Merge
        </button>
        <button type="button" class="button small quiet" data-action="split" aria-label={strings.splitOf(name)} disabled={!ready} onClick={() => session.objects.split(id)}>
          Split
        </button>
        <button type="button" class="button small quiet" data-action="remove" aria-label={strings.removeOf(name)} disabled={!ready} onClick={() => session.objects.remove(id)}>
          Delete
        </button>
      </div>
      <div class="copies others">
        <span class="faint">All others</span>
        {aboutOthers.map(({ what, action, run }) => (
          <button
            type="button"
            class="button small quiet"
            data-action={action}
            aria-label={strings.othersOf(what, name)}
            disabled={isAlone || (!ready && what !== 'Hide')}
            onClick={run}
          >
            {what}
          </button>
        ))}
      </div>
    </details>
  );
});
