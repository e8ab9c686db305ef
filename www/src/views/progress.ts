//! The line under the picture: what is being done, how far it is, and the way to stop it.

import type { Session } from '../session.js';
import type { State, Store } from '../state.js';
import { strings } from '../strings.js';
import { find, takesText } from './markup.js';

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
  document.addEventListener('keydown', (event) => {
    if (event.key === 'Escape' && !takesText(event.target)) session.cancel();
  });

  store.subscribe((now, before) => {
    if (now.run === before.run && now.pair === before.pair && now.result === before.result) return;
    const { run } = now;
    const busy = run.phase === 'working' || run.phase === 'opening';
    root.dataset.phase = run.phase;
    status.textContent = sentenceFor(now);
    again.hidden = !(run.phase === 'cancelled' && now.pair.first !== null && now.pair.second !== null);
    cancel.hidden = !busy;
    if (!busy) {
      clearTimeout(patience);
      patience = 0;
      bar.hidden = true;
    } else if (patience === 0) {
      patience = window.setTimeout(() => (bar.hidden = false), PATIENCE);
    }
    if (run.phase === 'working' && run.of > 0) bar.value = run.index / run.of;
    else bar.removeAttribute('value');
  });
}

function sentenceFor({ run, pair, result }: State): string {
  switch (run.phase) {
    case 'working':
      return strings.status.working(run.stage, run.index, run.of);
    case 'done':
      return result === null ? '' : strings.status.done(result.segmentation.count, result.waited);
    case 'idle':
      if ((pair.first === null) === (pair.second === null)) return strings.status.idle;
      return strings.status.waiting(pair.first === null ? 'first' : 'second');
    case 'opening':
    case 'cancelled':
    case 'failed':
      return strings.status[run.phase];
  }
}
