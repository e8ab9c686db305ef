//! How frames and masks are shown: opacity, outlines, onion skin, and what inspecting a frame shows.

import { type VNode, render } from 'preact';
import { strings } from '../common/strings.js';
import type { Session } from '../session/session.js';
import type { Store } from '../state/state.js';
import { usePart } from './component.js';
import { Inspect } from './inspect.js';

export function mountLook(form: HTMLElement, store: Store, session: Session): void {
  form.addEventListener('submit', (event) => event.preventDefault());
  render(
    <>
      <Look store={store} />
      <Inspect store={store} session={session} />
    </>,
    form,
  );
}

function Look({ store }: { store: Store }): VNode {
  const opacity = usePart(store, ({ look }) => look.opacity);
  const outlines = usePart(store, ({ look }) => look.outlines);
  const onion = usePart(store, ({ look }) => look.onion);
  const isClip = usePart(store, ({ timeline }) => timeline !== null);
  return (
    <div class="view">
      <label class="slider">
        Masks{' '}
        <input
          type="range"
          name="opacity"
          min="0"
          max="100"
          step="1"
          value={Math.round(opacity * 100)}
          aria-label="Opacity of the masks in per cent"
          onInput={({ currentTarget }) => store.look({ opacity: currentTarget.valueAsNumber / 100 })}
        />
        <output id="opacity-value">{strings.percent(opacity)}</output>
      </label>
      <label class="check">
        <input type="checkbox" name="outlines" checked={outlines} onChange={({ currentTarget }) => store.look({ outlines: currentTarget.checked })} /> Outlines
      </label>
      <label class="check" title="Outlines of the objects in the frame before, dashed, and in the frame after, dotted (U)">
        <input type="checkbox" name="onion" checked={onion} disabled={!isClip} onChange={({ currentTarget }) => store.look({ onion: currentTarget.checked })} /> Onion skin
      </label>
    </div>
  );
}
