//! The status line under the picture: what is running, its progress, and buttons to cancel and resume.

import { strings } from '../common/strings.js';
import { strokesOf } from '../correction/edits.js';
import { constraintsFrom } from '../correction/strokes.js';
import type { Session } from '../session/session.js';
import { type Cause, type Result, type State, type Store, isPassing, isPending } from '../state/state.js';
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
  again.addEventListener('click', () => session.pair.again());

  store.subscribe((now, before) => {
    const same = (['run', 'pair', 'result', 'edits', 'live', 'opening', 'playing', 'scrubbing'] as const).every((part) => now[part] === before[part]);
    if (same && now.look.kind === before.look.kind) return;
    const { run } = now;
    const opening = isOpening(now);
    const busy = run.phase === 'working' || opening;
    root.dataset.phase = opening ? 'opening' : run.phase;
    // Screen readers should not announce what changes many times a second.
    status.setAttribute('aria-live', run.phase === 'live' || isPassing(now) ? 'off' : 'polite');
    status.textContent = sentenceFor(now);
    const stopped = run.phase === 'cancelled' || (run.phase === 'failed' && isPending(now));
    again.hidden = opening || !(stopped && now.pair.first !== null && now.pair.second !== null);
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
      return result === null ? '' : sentenceAbout(run.cause, state, result);
    case 'live':
      return status.live(live?.rate ?? 0, (result?.second?.count ?? 1) - 1);
    case 'idle':
      if (pair.first !== null && pair.second !== null) return ''; // passed while the clip is played
      if (pair.first === null && pair.second === null) return status.idle;
      return status.waiting(pair.first === null ? 'first' : 'second');
    case 'cancelled':
      if (isPending(state)) return status.cancelledStrokes;
      return result === null ? status.cancelled : status.cancelledBefore;
    case 'failed':
      if (isPending(state)) return status.failedStrokes;
      return result === null ? status.failed : status.failedBefore;
  }
}

/** How the masks on screen came about. */
function sentenceAbout(cause: Cause, { look, found, edits }: State, { segmentation, pair, waited }: Result): string {
  const { status } = strings;
  const strokes = strokesOf(edits);
  if (cause === 'solved') return status.solved(strokes.length, waited);
  if (cause === 'tracked') return '';
  if (cause !== 'found') return status[cause];
  const { count, motions, settings } = segmentation;
  const moving = look.kind === 'groups' ? new Set(motions.map(({ group }) => group)).size - 1 : null;
  const answer = status.found(segmentation, moving, settings.motions === 'auto' ? null : settings.motions, waited, count === 1 && isSame(pair));
  return found === null || strokes.length === 0 ? answer : `${answer} ${status.applied(constraintsFrom(strokes, found).length, strokes.length)}`;
}

/** Whether nothing can move, because both frames have the same pixels. */
function isSame({ first, second }: Result['pair']): boolean {
  return first.fingerprint === second.fingerprint || first.data.every((value, k) => value === second.data[k]);
}
