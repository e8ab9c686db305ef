//! What all components share: they show the state as soon as it changes, as everything else on the page does.

import { computed } from '@preact/signals';
import { options } from 'preact';
import { useMemo } from 'preact/hooks';
import type { State, Store } from '../state/state.js';

// Not in a later task: what a person does next meets what the state says.
options.debounceRendering = (render) => render();

/** A part of the state. The component is rendered again whenever `part` returns another value; it reads nothing but the state. */
export function usePart<T>(store: Store, part: (state: State) => T): T {
  const signal = useMemo(() => computed(() => part(store.state.value)), [store]);
  return signal.value;
}
