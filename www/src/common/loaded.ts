//! Parts of the page that are loaded when they are used.

import { PageError } from './errors.js';
import { strings } from './strings.js';

/** The part, or a {@link PageError} if it cannot be loaded. */
export function loaded<T>(load: () => Promise<T>): Promise<T> {
  return imported(load).catch(() => {
    throw new PageError('not-loaded', strings.errors.notLoaded);
  });
}

/** How often a module could not be loaded, by its address. */
const failures = new Map<string, number>();

/**
 * The module that `load` imports. Browsers remember by its address that a module could not be loaded; it is then asked for under another one.
 */
export async function imported<M>(load: () => Promise<M>): Promise<M> {
  try {
    return await load();
  } catch (error) {
    const [address] = /\bhttps?:\/\/\S+/.exec(String(error)) ?? [];
    if (address === undefined) throw error;
    const before = failures.get(address) ?? 0;
    failures.set(address, before + 1);
    if (before === 0) throw error;
    return (await import(/* @vite-ignore */ `${address}?${before}`)) as M;
  }
}
