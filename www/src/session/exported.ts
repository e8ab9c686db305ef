//! The needs of exports: masks with all strokes, and a record of what was taken away. Loaded with the panel; all is in the state.

import { asSaved } from '../correction/edits.js';
import { type State, type Store, isPending } from '../state/state.js';
import { type Tracked, savedOf } from '../state/tracked.js';

/** The state once all strokes are applied, or none is being applied. */
export function settled(store: Store): Promise<State> {
  return new Promise((resolve) => {
    const look = (now: State, before: State): void => {
      const left = now.pair !== before.pair;
      if (!left && isPending(now) && now.run.phase === 'working') return;
      end();
      resolve(left ? before : now);
    };
    const end = store.subscribe(look);
    look(store.get(), store.get());
  });
}

/** Records that the masks of the pair were exported with these edits. */
export function pairExported(store: Store, { edits, pair }: State): void {
  const now = store.get();
  if (now.pair === pair) store.set({ edits: { ...now.edits, saved: asSaved(edits).saved } });
}

/** Records that the masks of the clip were exported as they are. */
export function clipExported(store: Store, exported: Tracked): void {
  const { tracked } = store.get();
  if (tracked?.clip === exported.clip) store.clip({ saved: savedOf(exported) });
}
