//! The export panel, which is loaded when it is first opened.

import { clipFormats } from '../export/clip-formats.js';
import type { Session } from '../session/session.js';
import type { Store } from '../state/state.js';
import { mountClipExport } from './clip-export.js';
import { mountCopies } from './copies.js';
import { refreshListed } from './listed.js';
import { find } from './markup.js';
import { mountProjects } from './projects.js';

export async function mountPanel(panel: HTMLElement, store: Store, session: Session): Promise<void> {
  const part = (id: string): HTMLElement => find(panel, `#${id}`, HTMLElement);
  mountCopies(part('copies'), store, session);
  mountClipExport({ panel, root: part('clip-export'), store, session, formats: await clipFormats() });
  mountProjects(part('project'), store, session);
  panel.addEventListener('toggle', () => void refreshListed());
}
