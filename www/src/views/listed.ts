//! What this browser keeps, for components: read again whenever it changes.

import { type ReadonlySignal, signal } from '@preact/signals';
import { type Listed, list, watch } from '../projects/shelf.js';

const listed = signal<readonly Listed[]>([]);
let read: Promise<void> | null = null;

/** All projects, the latest first. */
export function listedProjects(): ReadonlySignal<readonly Listed[]> {
  if (read === null) watch(() => void refreshListed());
  void refreshListed();
  return listed;
}

/** Looks again. Resolves when what is there is shown. */
export function refreshListed(): Promise<void> {
  return (read = (read ?? Promise.resolve()).then(async () => void (listed.value = await list().catch(() => []))));
}
