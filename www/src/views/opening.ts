//! Parts of the page that are loaded when a panel is first opened.

import { strings } from '../common/strings.js';
import type { Session } from '../session/session.js';

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
