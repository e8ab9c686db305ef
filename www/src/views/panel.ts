//! The export panel, which is loaded when it is first opened.

import { clipFormats } from '../export/clip-formats.js';
import type { Session } from '../session/session.js';
import type { Store } from '../state/state.js';
import { mountClipExport } from './clip-export.js';
import { mountClipPreview } from './clip-preview.js';
import { mountCopies } from './copies.js';
import { find } from './markup.js';
import { mountProjects } from './projects.js';

export async function mountPanel(panel: HTMLElement, store: Store, session: Session): Promise<void> {
  mountCopies(find(panel, '#copies', HTMLElement), store, session);
  const formats = await clipFormats();
  mountClipExport(panel, store, session, formats);
  mountClipPreview(panel, store, formats);
  mountProjects(panel, store, session);
}
