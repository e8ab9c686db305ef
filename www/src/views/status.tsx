//! The status line of the page: what is being opened, and what the frame on screen has.

import { type VNode, render } from 'preact';
import { useEffect, useLayoutEffect, useState } from 'preact/hooks';
import { strings } from '../common/strings.js';
import type { Session } from '../session/session.js';
import { type State, type Store, isPassing } from '../state/state.js';
import { usePart } from './component.js';

/** The progress bar appears after this time, so that it does not flash up, milliseconds. */
const PATIENCE = 150;

export function mountStatus(root: HTMLElement, store: Store, session: Session): void {
  render(<Status root={root} store={store} session={session} />, root);
}

function Status({ root, store, session }: { root: HTMLElement; store: Store; session: Session }): VNode {
  const phase = usePart(store, phaseOf);
  const sentence = usePart(store, sentenceFor);
  // Screen readers should not announce what changes many times a second.
  const isQuiet = usePart(store, (state) => state.live !== null || isPassing(state));
  const [isSlow, setSlow] = useState(false);
  useLayoutEffect(() => void (root.dataset.phase = phase), [phase]);
  useEffect(() => {
    if (phase !== 'opening') return;
    const waiting = setTimeout(() => setSlow(true), PATIENCE);
    return () => {
      clearTimeout(waiting);
      setSlow(false);
    };
  }, [phase]);
  return (
    <>
      <p class="told" tabIndex={0}>
        <span id="status" role="status" aria-live={isQuiet ? 'off' : 'polite'}>
          {sentence}
        </span>
      </p>
      <progress id="progress" aria-label="Progress of opening" hidden={!isSlow} />
      <button type="button" id="cancel" class="button small" hidden={phase !== 'opening'} onClick={() => session.cancel()}>
        Cancel
      </button>
    </>
  );
}

function phaseOf(state: State): 'opening' | 'live' | 'done' | 'idle' {
  // Not the next frame of a clip that is played.
  if (state.opening && !isPassing(state)) return 'opening';
  return state.live !== null ? 'live' : state.result !== null ? 'done' : 'idle';
}

function sentenceFor(state: State): string {
  const { pair, result, live, timeline } = state;
  const { status } = strings;
  switch (phaseOf(state)) {
    case 'opening':
      return status.opening;
    case 'live':
      return status.live(live?.rate ?? 0, result?.second?.objects.length ?? 0);
    case 'done':
      return strings.frameHas(result?.masks.objects.length ?? 0);
    case 'idle':
      if (pair.first === null) return status.idle;
      return timeline === null ? status.waiting : strings.notTracked;
  }
}
