//! Taking the masks of a whole clip away, with the objects that are ticked. Loaded with the panel.

import { strings } from '../common/strings.js';
import { type ClipFormat, exportOfClip } from '../export/clip-export.js';
import { save } from '../export/save.js';
import { zipped } from '../export/zip.js';
import type { Session } from '../session/session.js';
import type { State, Store } from '../state/state.js';
import { isDrafting, isSeen } from '../state/tracked.js';
import { find } from './markup.js';

export function mountClipExport(panel: HTMLElement, store: Store, session: Session, formats: readonly ClipFormat[]): void {
  const root = find(panel, '#clip-export', HTMLElement);
  const select = find(root, 'select', HTMLSelectElement);
  const button = find(root, 'button', HTMLButtonElement);
  const hint = find(root, '#clip-format-hint', HTMLElement);
  const status = find(root, '#clip-export-status', HTMLElement);
  const chosen = (): ClipFormat => formats[select.selectedIndex]!;

  const describe = (): void => void (hint.textContent = chosen().hint);
  select.addEventListener('change', describe);

  button.addEventListener('click', async () => {
    const { tracked } = store.get();
    const format = chosen();
    if (tracked === null) return;
    if (isDrafting(tracked)) return session.say(strings.notices.drafts);
    button.disabled = true;
    try {
      const exported = exportOfClip(tracked, store.get(), (done, of) => (status.textContent = strings.exporting(done, of)));
      if (exported.objects.length === 0) return session.say(strings.notices.nothingTicked);
      await saveFiles(format, await format.make(exported));
      session.projects.exported();
      status.textContent = strings.exported(exported.objects.length, exported.count);
    } catch (error) {
      status.textContent = '';
      session.say(strings.errors.notExported(format.title, error instanceof Error ? error.message : ''), 'not-written');
    } finally {
      button.disabled = false;
    }
  });

  const masks = find(root, '#import-masks', HTMLInputElement);
  masks.addEventListener('change', () => {
    const files = [...(masks.files ?? [])];
    masks.value = ''; // so that choosing the same file again is a change
    if (files.length > 0) void session.open.masks(files);
  });
  masks.disabled = false;

  const render = ({ look, tracked }: State, before: State | null): void => {
    root.hidden = !isSeen(tracked);
    if (tracked?.frames !== before?.tracked?.frames || look.hidden !== before?.look.hidden) status.textContent = '';
  };
  store.subscribe(render);
  render(store.get(), null);
  select.replaceChildren(...formats.map(({ id, title }) => new Option(title, id)));
  describe();
  button.disabled = false;
}

/** One file is saved as it is, several as an archive. */
async function saveFiles(format: ClipFormat, made: Awaited<ReturnType<ClipFormat['make']>>): Promise<void> {
  const files = Object.entries(made);
  const [[name, content]] = files as [(typeof files)[number]];
  if (files.length === 1) return save(content instanceof Uint8Array ? new Uint8Array(content) : content, 'application/octet-stream', name);
  const bytes = files.map(async ([path, one]) => [path, new Uint8Array(await new Blob([one as BlobPart]).arrayBuffer())] as const);
  save(zipped(Object.fromEntries(await Promise.all(bytes))), 'application/zip', `${format.id}.zip`);
}
