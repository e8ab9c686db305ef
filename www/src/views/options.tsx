//! The settings. Whether clips are segmented by themselves is kept for the next visit.

import { type ComponentChildren, type VNode, render } from 'preact';
import { LONGEST_SIDES, type Settings } from '../state/settings.js';
import type { Store } from '../state/state.js';
import { usePart } from './component.js';

/** Where the browser keeps that clips wait until a person asks for their masks. */
const KEY = 'veronese-segment';
const ASKED = 'asked';

export function mountOptions(form: HTMLFormElement, store: Store): void {
  form.addEventListener('submit', (event) => event.preventDefault());
  try {
    store.set({ automatic: localStorage.getItem(KEY) !== ASKED });
  } catch {
    // A browser that keeps nothing begins as it always does.
  }
  render(<Options store={store} />, form);
}

function Options({ store }: { store: Store }): VNode {
  const { quality, subject, longestSide, markUnknown } = usePart(store, ({ settings }) => settings);
  const automatic = usePart(store, (state) => state.automatic);
  const set = (change: Partial<Settings>): void => store.set({ settings: { ...store.get().settings, ...change } });
  const setAutomatic = (on: boolean): void => {
    store.set({ automatic: on });
    try {
      if (on) localStorage.removeItem(KEY);
      else localStorage.setItem(KEY, ASKED);
    } catch {
      // It holds until the page is left.
    }
  };
  return (
    <>
      <fieldset class="field" aria-describedby="help-quality">
        <legend>Quality</legend>
        <div class="segmented">
          {(['fast', 'best'] as const).map((value) => (
            <label key={value}>
              <input type="radio" name="quality" value={value} checked={quality === value} onChange={() => set({ quality: value })} />
              <span>{value === 'fast' ? 'Fast' : 'Best'}</span>
            </label>
          ))}
        </div>
        <p id="help-quality" class="help faint">
          Fast for a quick look, Best for final masks.
        </p>
      </fieldset>
      <div class="field">
        <Check name="subject" checked={subject} help="help-subject" take={(on) => set({ subject: on })}>
          Main subject only
        </Check>
        <p id="help-subject" class="help faint">
          One object: what the pictures are about, as for a cut-out.
        </p>
      </div>
      <Check name="automatic" checked={automatic} take={setAutomatic}>
        Segment a clip when it is opened
      </Check>
      <details>
        <summary>Advanced</summary>
        <div class="fields">
          <div class="field">
            <label for="longest-side">Working size</label>
            <select
              id="longest-side"
              name="longestSide"
              aria-describedby="help-size"
              value={String(longestSide)}
              onChange={({ currentTarget }) => set({ longestSide: Number(currentTarget.value) })}
            >
              {LONGEST_SIDES.map((side) => (
                <option key={side} value={String(side)}>
                  {side} pixels
                </option>
              ))}
            </select>
            <p id="help-size" class="help faint">
              Larger frames are scaled down to this size when opened. Masks are exported at full size.
            </p>
          </div>
          <div class="field">
            <Check name="markUnknown" checked={markUnknown} help="help-unknown" take={(on) => set({ markUnknown: on })}>
              Leave unexplained pixels unlabelled
            </Check>
            <p id="help-unknown" class="help faint">
              For example, those that are hidden in the second frame.
            </p>
          </div>
        </div>
      </details>
    </>
  );
}

function Check({ name, checked, help, take, children }: { name: string; checked: boolean | undefined; help?: string; take: (on: boolean) => void; children: ComponentChildren }): VNode {
  return (
    <label class="check">
      <input type="checkbox" name={name} checked={checked} aria-describedby={help} onChange={({ currentTarget }) => take(currentTarget.checked)} />
      {children}
    </label>
  );
}
