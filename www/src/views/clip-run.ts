//! Segmenting the whole clip: the button, what is running, its progress, and the button to cancel it.

import { strings } from '../common/strings.js';
import type { Session } from '../session/session.js';
import type { Store } from '../state/state.js';
import { type Tracked, isDrafting, lengthOf, livesOf, masksIn, rangeOf } from '../state/tracked.js';
import { find } from './markup.js';

export function mountClipRun(root: HTMLElement, store: Store, session: Session): void {
  const status = find(root, '#clip-status', HTMLElement);
  const detail = find(root, '#clip-detail', HTMLElement);
  const bar = find(root, '#clip-progress', HTMLProgressElement);
  const segment = find(root, '#clip-segment', HTMLButtonElement);
  const cancel = find(root, '#clip-cancel', HTMLButtonElement);

  segment.addEventListener('click', () => {
    session.shown.objects();
    void session.clip.segment();
    cancel.focus();
  });
  cancel.addEventListener('click', () => session.clip.cancel());

  store.subscribe(({ tracked }, before) => {
    if (tracked === before.tracked || tracked === null) return;
    const working = tracked.run.phase === 'working';
    root.dataset.phase = tracked.run.phase;
    segment.hidden = working;
    segment.disabled = lengthOf(tracked.range) < 2;
    segment.textContent = nameOfAction(tracked);
    segment.classList.toggle('primary', tracked.run.phase !== 'done');
    const held = document.activeElement === cancel;
    cancel.hidden = !working;
    if (held && !working) segment.focus();
    bar.hidden = !working;
    status.ariaBusy = String(tracked.isMoving);
    // Screen readers announce beginning and end, not each frame.
    const sentence = sentenceFor(tracked);
    if (status.textContent !== sentence) status.textContent = sentence;
    detail.textContent = detailOf(tracked);
    const done = shareOf(tracked);
    if (done === null) bar.removeAttribute('value');
    else bar.value = done;
  });
}

function nameOfAction({ run, range, clip, frames }: Tracked): string {
  const { tracking } = strings;
  const done = rangeOf(frames);
  const begun = run.phase === 'done' && done?.first === range.first && done.last < range.last;
  if (begun || run.phase === 'cancelled' || run.phase === 'failed') return tracking.resume;
  if (lengthOf(range) < clip.count) return tracking.segmentRange(range.first, range.last);
  return run.phase === 'done' ? tracking.again : tracking.segment;
}

function sentenceFor(tracked: Tracked): string {
  const { run, range, frames } = tracked;
  const { tracking } = strings;
  switch (run.phase) {
    case 'idle':
      return '';
    case 'working':
      return run.stage === 'corrections' ? tracking.corrections : isDrafting(tracked) ? tracking.drafting : tracking.started;
    case 'done':
      if (run.cause === 'corrected') return tracking.corrected(run.changed, run.kept ?? 0);
      if (run.cause === 'undone' || run.cause === 'redone') return tracking[run.cause](run.changed);
      return tracking[run.cause](livesOf(tracked).length, masksIn(frames, all(tracked)), run.notes);
    case 'cancelled':
    case 'failed':
      return tracking[run.phase](masksIn(frames, range), lengthOf(range));
  }
}

function detailOf({ run, solved, range }: Tracked): string {
  if (run.phase !== 'working') return '';
  if (run.stage === 'corrections') return run.of === undefined ? '' : strings.tracking.carried(run.labelled, run.of, run.left);
  return run.stage === 'pairs' ? strings.tracking.pairs(solved, lengthOf(range), run.left) : strings.tracking.labels(run.labelled, solved);
}

/** The share that is done, 0 to 1; `null` if it is not known. */
export function shareOf({ run, solved, range }: Tracked): number | null {
  if (run.phase !== 'working') return null;
  if (run.stage === 'corrections') return run.of === undefined ? null : run.labelled / run.of;
  if (run.stage === 'labels') return run.labelled / Math.max(1, solved);
  const of = lengthOf(range);
  return solved < of ? solved / of : null;
}

function all({ clip }: Tracked): Tracked['range'] {
  return { first: 0, last: clip.count - 1 };
}
