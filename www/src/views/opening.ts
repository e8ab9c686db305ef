//! Parts of the page that are loaded when a panel is first opened, or something is first switched on.

import { strings } from '../common/strings.js';
import type { Session } from '../session/session.js';
import type { Store } from '../state/state.js';

/** `mount` is called once; again only if it fails. */
export function mountOnOpening(panel: HTMLElement, session: Session, mount: (panel: HTMLElement) => Promise<void>): void {
  const open = (): void => {
    mount(panel).catch(() => {
      panel.addEventListener('toggle', open, { once: true });
      session.say(strings.errors.notLoaded, 'not-loaded');
    });
  };
  panel.addEventListener('toggle', open, { once: true });
}

/** `mount` is called once; if it fails, again when this is switched on again. */
export function mountWhenOn(what: 'onion', store: Store, mount: () => Promise<void>): void {
  const leave = store.subscribe(({ look }, before) => {
    if (!look[what] || before.look[what]) return;
    leave();
    mount().catch(() => {
      mountWhenOn(what, store, mount);
      store.say(strings.errors.notLoaded, 'not-loaded');
    });
  });
}
