//! The status line under the picture: what is running, its progress, and buttons to cancel and resume.

import { strings } from '../common/strings.js';
import type { Session } from '../session/session.js';
import { type Result, type State, type Store, isPassing } from '../state/state.js';
import { find } from './markup.js';

/** The progress bar appears after this time, so that it does not flash up, milliseconds. */
const PATIENCE = 150;

export function mountProgress(root: HTMLElement, store: Store, session: Session): void {
  const status = find(root, '#status', HTMLElement);
  const bar = find(root, '#progress', HTMLProgressElement);
  const cancel = find(root, '#cancel', HTMLButtonElement);
  const again = find(root, '#again', HTMLButtonElement);
  let patience = 0;

  cancel.addEventListener('click', () => session.cancel());
  again.addEventListener('click', () => void session.pair.segment());

  store.subscribe((now, before) => {
    const same = (['run', 'pair', 'result', 'live', 'opening', 'playing', 'scrubbing'] as const).every((part) => now[part] === before[part]);
    if (same && now.look.kind === before.look.kind) return;
    const { run } = now;
    const opening = isOpening(now);
    const busy = run.phase === 'working' || opening;
    root.dataset.phase = opening ? 'opening' : run.phase;
    // Screen readers should not announce what changes many times a second.
    status.setAttribute('aria-live', run.phase === 'live' || isPassing(now) ? 'off' : 'polite');
    status.textContent = sentenceFor(now);
    again.hidden = opening || !(run.phase === 'cancelled' && now.pair.first !== null && now.pair.second !== null);
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

/** Whether something is being opened: not the next frame of a clip that is played. */
function isOpening(state: State): boolean {
  return state.opening && !isPassing(state);
}

function sentenceFor(state: State): string {
  const { run, pair, result, live } = state;
  const { status } = strings;
  if (isOpening(state)) return status.opening;
  switch (run.phase) {
    case 'working':
      return status.working(run.stage, run.index, run.of);
    case 'done':
      if (run.cause === 'tracked') return result === null ? strings.notTracked : strings.frameHas(result.segmentation.motions.filter(({ label }) => label > 0).length);
      return result === null ? '' : sentenceAbout(result, state);
    case 'live':
      return status.live(live?.rate ?? 0, (result?.second?.count ?? 1) - 1);
    case 'idle':
      if (pair.first !== null && pair.second !== null) return ''; // passed while the clip is played
      if (pair.first === null && pair.second === null) return status.idle;
      return status.waiting(pair.first === null ? 'first' : 'second');
    case 'cancelled':
      return result === null ? status.cancelled : status.cancelledBefore;
    case 'failed':
      return result === null ? status.failed : status.failedBefore;
  }
}

/** How the masks of a pair came about. */
function sentenceAbout({ segmentation, pair, waited }: Result, { look }: State): string {
  const { count, motions, settings } = segmentation;
  const moving = look.kind === 'groups' ? new Set(motions.map(({ group }) => group)).size - 1 : null;
  return strings.status.found(segmentation, moving, settings.motions === 'auto' ? null : settings.motions, waited, count === 1 && isSame(pair));
}

/** Whether nothing can move, because both frames have the same pixels. */
function isSame({ first, second }: Result['pair']): boolean {
  return first.fingerprint === second.fingerprint || first.data.every((value, k) => value === second.data[k]);
}
