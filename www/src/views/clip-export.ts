//! Taking the masks of a whole clip away, with the objects that are ticked.

import { strings } from '../common/strings.js';
import { exportOfClip } from '../export/clip-export.js';
import type { ClipFormat } from '../export/clip-export.js';
import { save } from '../export/save.js';
import { zipped } from '../export/zip.js';
import type { Session } from '../session/session.js';
import type { Store } from '../state/state.js';
import { find } from './markup.js';

export function mountClipExport(panel: HTMLElement, store: Store, session: Session): void {
  const root = find(panel, '#clip-export', HTMLElement);
  const select = find(root, 'select', HTMLSelectElement);
  const button = find(root, 'button', HTMLButtonElement);
  const hint = find(root, '#clip-format-hint', HTMLElement);
  const told = find(root, '#clip-export-told', HTMLElement);
  let formats: readonly ClipFormat[] = [];

  const describe = (): void => void (hint.textContent = formats[select.selectedIndex]?.hint ?? '');
  select.addEventListener('change', describe);
  panel.addEventListener('toggle', async () => {
    if (formats.length > 0 || store.get().look.kind !== 'objects') return;
    try {
      ({ CLIP_FORMATS: formats } = await import('../export/clip-formats.js'));
    } catch {
      return session.say(strings.errors.notLoaded, 'not-loaded');
    }
    select.replaceChildren(...formats.map(({ id, title }) => new Option(title, id)));
    describe();
  });

  button.addEventListener('click', async () => {
    const { tracked, look } = store.get();
    const format = formats[select.selectedIndex];
    if (tracked === null || format === undefined) return;
    button.disabled = true;
    try {
      const exported = exportOfClip(tracked, look, (done, of) => (told.textContent = strings.exporting(done, of)));
      if (exported.objects.length === 0) return session.say(strings.notices.nothingTicked);
      const files = Object.entries(await format.make(exported));
      const [[name, content]] = files as [(typeof files)[number]];
      if (files.length === 1) save(typeof content === 'string' ? content : new Uint8Array(content), 'application/octet-stream', name);
      else save(await zipped(Object.fromEntries(files.map(([path, one]) => [path, typeof one === 'string' ? new TextEncoder().encode(one) : one]))), 'application/zip', `${format.id}.zip`);
      session.tracking.saved(tracked);
      told.textContent = strings.exported(exported.objects.length, exported.count);
    } catch (error) {
      told.textContent = '';
      session.say(strings.errors.notExported(format.title, error instanceof Error ? error.message : ''), 'not-written');
    } finally {
      button.disabled = false;
    }
  });

  store.subscribe(({ look, tracked }, before) => {
    if (look === before.look && tracked === before.tracked) return;
    root.hidden = look.kind !== 'objects';
    if (tracked?.frames !== before.tracked?.frames || look.hidden !== before.look.hidden) told.textContent = '';
  });
}
