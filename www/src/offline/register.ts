//! Registers the service worker when the sample that the page opens is segmented, so that caching does not slow that down.

import type { Store } from '../state/state.js';

export function keepForOffline(store: Store): void {
  if (!('serviceWorker' in navigator) || import.meta.env.DEV) return;
  const stop = store.subscribe(({ tracked }) => {
    if (tracked?.run.phase !== 'done' && tracked?.run.phase !== 'failed') return;
    stop();
    const root = document.documentElement;
    navigator.serviceWorker
      .register(new URL('./service-worker.js', document.baseURI), { scope: './' })
      .then(() => navigator.serviceWorker.ready)
      .then(
        () => (root.dataset.offline = 'ready'),
        () => (root.dataset.offline = 'none'), // in a private window, for instance: the page works all the same
      );
  });
}
