//! Segmenting the whole clip: the button, what is running, its progress, and the button to cancel it.

import { strings } from '../common/strings.js';
import type { Session } from '../session/session.js';
import type { Store } from '../state/state.js';
import { type Tracked, livesOf } from '../state/tracked.js';
import { find } from './markup.js';

export function mountClipRun(root: HTMLElement, store: Store, session: Session): void {
  const status = find(root, '#clip-status', HTMLElement);
  const detail = find(root, '#clip-detail', HTMLElement);
  const bar = find(root, '#clip-progress', HTMLProgressElement);
  const segment = find(root, '#clip-segment', HTMLButtonElement);
  const cancel = find(root, '#clip-cancel', HTMLButtonElement);

  segment.addEventListener('click', () => {
    void session.tracking.segment();
    cancel.focus();
  });
  cancel.addEventListener('click', () => {
    session.tracking.cancel();
    segment.focus();
  });

  store.subscribe(({ tracked }, before) => {
    if (tracked === before.tracked || tracked === null) return;
    const working = tracked.run.phase === 'working';
    root.dataset.phase = tracked.run.phase;
    segment.hidden = working;
    segment.disabled = tracked.clip.count < 2;
    segment.textContent = nameOfAction(tracked);
    segment.classList.toggle('primary', tracked.run.phase !== 'done');
    cancel.hidden = !working;
    bar.hidden = !working;
    // Screen readers are told what begins and ends, not of each frame.
    const sentence = sentenceFor(tracked);
    if (status.textContent !== sentence) status.textContent = sentence;
    detail.textContent = detailOf(tracked);
    const done = shareOf(tracked);
    if (done === null) bar.removeAttribute('value');
    else bar.value = done;
  });
}

function nameOfAction({ run }: Tracked): string {
  const { tracking } = strings;
  if (run.phase === 'cancelled' || run.phase === 'failed') return tracking.resume;
  return run.phase === 'done' ? tracking.again : tracking.segment;
}

function sentenceFor(tracked: Tracked): string {
  const { run, solved, clip } = tracked;
  const { tracking } = strings;
  switch (run.phase) {
    case 'idle':
      return '';
    case 'working':
      return run.stage === 'corrections' ? tracking.corrections : tracking.started;
    case 'done':
      return run.cause === 'found' || run.cause === 'continued' ? tracking[run.cause](livesOf(tracked).length, clip.count) : tracking[run.cause](run.changed);
    case 'cancelled':
    case 'failed':
      return tracking[run.phase](solved, clip.count);
  }
}

function detailOf({ run, solved, frames, clip }: Tracked): string {
  if (run.phase !== 'working' || run.stage === 'corrections') return '';
  return run.stage === 'pairs' ? strings.tracking.pairs(solved, clip.count, run.left) : strings.tracking.labels(withMasks(frames), clip.count);
}

/** What is done, 0 to 1; `null` if it cannot be told. */
function shareOf({ run, solved, frames, clip }: Tracked): number | null {
  if (run.phase !== 'working' || run.stage === 'corrections') return null;
  if (run.stage === 'labels') return withMasks(frames) / clip.count;
  return solved < clip.count ? solved / clip.count : null;
}

function withMasks(frames: Tracked['frames']): number {
  return frames.filter((frame) => frame !== null).length;
}
