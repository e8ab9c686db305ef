//! Segmenting the whole clip: its name, the button, what is running and how far, cancelling it, and the review of its masks.

import { type VNode, render } from 'preact';
import { useLayoutEffect, useRef } from 'preact/hooks';
import { strings } from '../common/strings.js';
import type { Session } from '../session/session.js';
import { type Store, seenIn } from '../state/state.js';
import { type Tracked, acceptedIn, changedIn, isDrafting, isReady, lengthOf, livesOf, masksIn, rangeOf } from '../state/tracked.js';
import { usePart } from './component.js';
import { accept } from './review.js';

interface Given {
  readonly store: Store;
  readonly session: Session;
}

export function mountClipRun(root: HTMLElement, store: Store, session: Session): void {
  render(<ClipRun root={root} store={store} session={session} />, root);
}

function ClipRun({ root, store, session }: Given & { root: HTMLElement }): VNode {
  const tracked = usePart(store, (state) => state.tracked);
  const buttons = { segment: useRef<HTMLButtonElement>(null), cancel: useRef<HTMLButtonElement>(null) };
  const phase = tracked?.run.phase ?? 'idle';
  const isWorking = phase === 'working';
  const isHeld = document.activeElement !== null && document.activeElement === buttons.cancel.current;
  useLayoutEffect(() => {
    root.dataset.phase = phase;
    if (isHeld && !isWorking) buttons.segment.current!.focus();
  }, [phase]);
  const segment = (): void => {
    session.shown.objects();
    void session.clip.segment();
    buttons.cancel.current!.focus();
  };
  const done = tracked && shareOf(tracked);
  return (
    <>
      <ClipName store={store} />
      <p class="told" tabIndex={0}>
        <span>
          {/* Screen readers announce beginning and end, not each frame. */}
          <span id="clip-status" role="status" aria-busy={tracked?.isMoving ?? false}>
            {tracked && sentenceFor(tracked)}
          </span>{' '}
          <span id="clip-detail">{tracked && detailOf(tracked)}</span>
        </span>
      </p>
      <progress id="clip-progress" max="1" aria-label="Progress of the clip" hidden={!isWorking} {...(done !== null && { value: done })} />
      <Review store={store} session={session} />
      <button
        ref={buttons.segment}
        type="button"
        id="clip-segment"
        class={phase === 'done' ? 'button small' : 'button small primary'}
        hidden={isWorking}
        disabled={tracked !== null && lengthOf(tracked.range) < 2}
        onClick={segment}
      >
        {tracked === null ? strings.tracking.segment : nameOfAction(tracked)}
      </button>
      <button ref={buttons.cancel} type="button" id="clip-cancel" class="button small" hidden={!isWorking} onClick={() => session.clip.cancel()}>
        Cancel
      </button>
    </>
  );
}

/** What it is called, how long it is, and how large its frames are. */
function ClipName({ store }: { store: Store }): VNode {
  const clip = usePart(store, ({ timeline }) => timeline?.clip);
  const facts = clip && strings.clipFacts(clip.count, clip.width, clip.height);
  return (
    <h3 id="clip-name" title={clip && `${clip.name}, ${facts}`}>
      {clip && (
        <>
          <span>{clip.name}</span>
          <span class="visually-hidden">, </span>
          <small>{facts}</small>
        </>
      )}
    </h3>
  );
}

/** Accepting masks, how far that is, and what the last correction changed. */
function Review({ store, session }: Given): VNode {
  const tracked = usePart(store, (state) => state.tracked);
  const at = usePart(store, (state) => seenIn(state)?.index ?? -1);
  const accepted = tracked === null ? [] : acceptedIn(tracked);
  const count = tracked === null ? 0 : masksIn(tracked.frames, all(tracked));
  const changed = tracked === null ? 0 : changedIn(tracked).size;
  return (
    <div id="review" class="review" hidden={!isReady(tracked)}>
      <button
        type="button"
        id="next-change"
        class="button small quiet"
        title="Go to the frame that the last correction changed most; again, to the next (N)"
        hidden={changed === 0}
        onClick={() => session.frames.goToChanged()}
      >
        {strings.changedFrames(changed)}
      </button>
      <span id="reviewed">{strings.accepted(accepted.length, count)}</span>
      <button
        type="button"
        id="accept"
        class="button small quiet"
        title="Accept the masks of this frame and go on (Y)"
        disabled={accepted.length === count && accepted.includes(at)}
        onClick={() => accept(session, 'shown')}
      >
        Accept
      </button>
      <button
        type="button"
        id="accept-all"
        class="button small quiet"
        title="Accept the masks of all frames (Shift Y)"
        disabled={accepted.length === count}
        onClick={() => accept(session, 'all')}
      >
        Accept all
      </button>
    </div>
  );
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
