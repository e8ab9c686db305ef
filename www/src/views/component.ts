//! What all components share: they show the state as soon as it changes, as everything else on the page does.

import { computed } from '@preact/signals';
import { type Component, type FunctionComponent, type RenderableProps, h, options } from 'preact';
import { useMemo } from 'preact/hooks';
import type { State, Store } from '../state/state.js';

// Not in a later task: what a person does next meets what the state says.
options.debounceRendering = (render) => render();

/** A part of the state. The component is rendered again whenever `part` returns another value; it reads nothing but the state. */
export function usePart<T>(store: Store, part: (state: State) => T): T {
  const signal = useMemo(() => computed(() => part(store.state.value)), [store]);
  return signal.value;
}

/** The component, rendered again only if a property is another. */
export function memo<P extends object>(Part: FunctionComponent<P>): FunctionComponent<P> {
  return function (this: Component<P>, properties: RenderableProps<P>) {
    this.shouldComponentUpdate = (next) => (Object.keys(next) as (keyof P)[]).some((key) => next[key] !== this.props[key as keyof typeof this.props]);
    return h(Part as FunctionComponent, properties);
  };
}
