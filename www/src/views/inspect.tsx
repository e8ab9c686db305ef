//! Inspecting a frame: it is compared with the one beside it, and the motions between both are listed, with what says how many there are.

import type { VNode } from 'preact';
import { useRef } from 'preact/hooks';
import { strings } from '../common/strings.js';
import { mayInspect } from '../session/inspecting.js';
import type { Session } from '../session/session.js';
import type { Inspected, Look, State, Store } from '../state/state.js';
import { toggleBlinking } from './blink.js';
import { usePart } from './component.js';
import { Evidence } from './evidence.js';
import { MotionRow } from './motion-row.js';

interface Given {
  readonly store: Store;
  readonly session: Session;
}

const VIEWS: readonly (readonly [Look['view'], string])[] = [
  ['first', 'First'],
  ['split', 'Split'],
  ['second', 'Second'],
];

/** Draws the motions in the place of the objects, or no longer. They are found when a frame is inspected. */
export function toggleMotions(store: Store): void {
  const motions = !store.get().look.motions;
  // First, because motions are drawn of a frame that is inspected alone.
  if (motions) store.set({ inspecting: true });
  store.look({ motions, ...(motions && { view: 'first', blinking: false }) });
}

export function Inspect({ store, session }: Given): VNode {
  const inspecting = usePart(store, (state) => state.inspecting);
  const toggle = (open: boolean): void => {
    if (open === store.get().inspecting) return;
    store.set({ inspecting: open });
    if (!open) store.look({ view: 'first', blinking: false });
  };
  return (
    <details id="inspect" class="inspect" open={inspecting} onToggle={({ currentTarget }) => toggle(currentTarget.open)}>
      <summary>Inspect</summary>
      {inspecting && <Comparing store={store} />}
      {inspecting && <Motions store={store} session={session} />}
    </details>
  );
}

function Comparing({ store }: { store: Store }): VNode {
  const view = usePart(store, ({ look }) => look.view);
  const blinking = usePart(store, ({ look }) => look.blinking);
  const isAlone = usePart(store, ({ pair }) => pair.second === null);
  return (
    <div class="view">
      <fieldset class="segmented" disabled={isAlone}>
        <legend class="visually-hidden">Frame shown</legend>
        {VIEWS.map(([value, title]) => (
          <label key={value}>
            <input type="radio" name="frame" value={value} checked={view === value} onChange={() => store.look({ view: value, blinking: false })} />
            <span>{title}</span>
          </label>
        ))}
      </fieldset>
      <button type="button" id="blink" class="button small quiet" aria-pressed={blinking} disabled={isAlone} onClick={() => toggleBlinking(store)}>
        Blink
      </button>
      <Drawn store={store} />
    </div>
  );
}

function Drawn({ store }: { store: Store }): VNode {
  const drawn = usePart(store, ({ look }) => look.motions);
  return (
    <label class="check" title="Draw the motions in the place of the objects (G)">
      <input type="checkbox" name="motions" checked={drawn} onChange={() => toggleMotions(store)} /> Show motions
    </label>
  );
}

function Motions({ store, session }: Given): VNode {
  const inspected = usePart(store, (state) => state.inspected);
  const sentence = usePart(store, sentenceOf);
  // Those of the frames before stay until others are found, so that nothing moves.
  const last = useRef<Inspected | null>(null);
  if (inspected !== null) last.current = inspected;
  const shown = last.current;
  const found = shown?.segmentation ?? null;
  return (
    <>
      <p id="inspect-status" class="help" role="status">
        {sentence}
      </p>
      {shown !== null && found !== null && (
        <div class="inspected" inert={inspected === null} aria-busy={inspected === null}>
          <ol id="motions">
            {found.motions.map((motion) => (
              <MotionRow key={motion.label} frame={shown.first} segmentation={found} motion={motion} session={session} store={store} />
            ))}
          </ol>
          <Evidence segmentation={found} />
        </div>
      )}
    </>
  );
}

function sentenceOf(state: State): string {
  const { inspected, pair } = state;
  if (pair.second === null) return '';
  if (inspected === null) return mayInspect(state) ? strings.inspect.finding : strings.inspect.waits;
  return inspected.segmentation === null ? strings.inspect.failed : strings.inspect.found(inspected.segmentation.count, inspected.waited);
}
