//! The line under the picture: what is being done, how far it is, and the way to stop it.

import type { Session } from '../session.js';
import type { State, Store } from '../state.js';
import { strings } from '../strings.js';
import { find } from './markup.js';

/** Work shorter than this shows no bar: a flash tells nobody anything. Milliseconds. */
const PATIENCE = 150;

export function mountProgress(root: HTMLElement, store: Store, session: Session): void {
  const status = find(root, '#status', HTMLElement);
  const bar = find(root, '#progress', HTMLProgressElement);
  const cancel = find(root, '#cancel', HTMLButtonElement);
  const again = find(root, '#again', HTMLButtonElement);
  let patience = 0;

  cancel.addEventListener('click', () => session.cancel());
  again.addEventListener('click', () => void session.segment());

  store.subscribe((now, before) => {
    if (now.run === before.run && now.pair === before.pair && now.result === before.result && now.live === before.live && now.opening === before.opening) return;
    const { run, opening } = now;
    const busy = run.phase === 'working' || opening;
    root.dataset.phase = opening ? 'opening' : run.phase;
    // The rate changes many times a second, which nobody wants to hear.
    status.setAttribute('aria-live', run.phase === 'live' ? 'off' : 'polite');
    status.textContent = sentenceFor(now);
    again.hidden = !(!opening && run.phase === 'cancelled' && now.pair.first !== null && now.pair.second !== null);
    cancel.hidden = !busy;
    if (!busy) {
      clearTimeout(patience);
      patience = 0;
      bar.hidden = true;
    } else if (patience === 0) {
      patience = window.setTimeout(() => (bar.hidden = false), PATIENCE);
    }
    if (!opening && run.phase === 'working' && run.of > 0) bar.value = run.index / run.of;
    else bar.removeAttribute('value');
  });
}

function sentenceFor({ run, pair, result, live, history, opening }: State): string {
  if (opening) return strings.status.opening;
  switch (run.phase) {
    case 'working':
      return strings.status.working(run.stage, run.index, run.of);
    case 'done':
      if (result === null) return '';
      return history.strokes.length > 0 ? strings.status.corrected(result.waited) : strings.status.done(result.segmentation.count, result.waited);
    case 'live':
      return strings.status.live(live?.rate ?? 0, result?.segmentation.count ?? 0);
    case 'idle':
      if ((pair.first === null) === (pair.second === null)) return strings.status.idle;
      return strings.status.waiting(pair.first === null ? 'first' : 'second');
    case 'cancelled':
    case 'failed':
      return strings.status[run.phase];
  }
}
