//! Taking the masks of a whole clip away, with the objects that are ticked, and a preview of that; importing masks. Loaded with the panel.

import { type VNode, render } from 'preact';
import { useLayoutEffect, useState } from 'preact/hooks';
import { strings } from '../common/strings.js';
import { type ClipFormat, exportOfClip } from '../export/clip-export.js';
import { save } from '../export/save.js';
import { zipped } from '../export/zip.js';
import type { Session } from '../session/session.js';
import type { Store } from '../state/state.js';
import { isDrafting, isSeen } from '../state/tracked.js';
import { ClipPreview } from './clip-preview.js';
import { usePart } from './component.js';

interface Given {
  readonly panel: HTMLElement;
  readonly root: HTMLElement;
  readonly store: Store;
  readonly session: Session;
  readonly formats: readonly ClipFormat[];
}

export function mountClipExport(given: Given): void {
  render(<ClipExport {...given} />, given.root);
}

function ClipExport({ panel, root, store, session, formats }: Given): VNode {
  const isEmpty = usePart(store, ({ tracked }) => !isSeen(tracked));
  const frames = usePart(store, ({ tracked }) => tracked?.frames);
  const hidden = usePart(store, ({ look }) => look.hidden);
  const [format, choose] = useState(formats[0]!);
  const [status, tell] = useState('');
  const [isWorking, setWorking] = useState(false);
  useLayoutEffect(() => void (root.hidden = isEmpty), [isEmpty]);
  // It was about other masks.
  useLayoutEffect(() => tell(''), [frames, hidden]);

  const saveClip = async (): Promise<void> => {
    const { tracked } = store.get();
    if (tracked === null) return;
    if (isDrafting(tracked)) return session.say(strings.notices.drafts);
    setWorking(true);
    try {
      const exported = exportOfClip(tracked, store.get(), (done, of) => tell(strings.exporting(done, of)));
      if (exported.objects.length === 0) return session.say(strings.notices.nothingTicked);
      await saveFiles(format, await format.make(exported));
      session.projects.exported();
      tell(strings.exported(exported.objects.length, exported.count));
    } catch (error) {
      tell('');
      session.say(strings.errors.notExported(format.title, error instanceof Error ? error.message : ''), 'not-written');
    } finally {
      setWorking(false);
    }
  };
  const importMasks = (input: HTMLInputElement): void => {
    const files = [...(input.files ?? [])];
    input.value = ''; // so that choosing the same file again is a change
    if (files.length > 0) void session.open.masks(files);
  };
  return (
    <>
      <p class="help">The ticked objects, in all frames that have masks.</p>
      <div class="format-row">
        <select aria-label="Format of the clip" aria-describedby="clip-format-hint" onChange={({ currentTarget }) => choose(formats[currentTarget.selectedIndex]!)}>
          {formats.map(({ id, title }) => (
            <option key={id} value={id}>
              {title}
            </option>
          ))}
        </select>
        <button type="button" class="button small primary" disabled={isWorking} onClick={() => void saveClip()}>
          Save clip
        </button>
      </div>
      <p id="clip-format-hint" class="help faint">
        {format.hint}
      </p>
      <ClipPreview panel={panel} store={store} format={format} />
      <p id="clip-export-status" class="help" role="status">
        {status}
      </p>
      <div class="copies">
        <label class="button small">
          <input type="file" id="import-masks" class="file" accept=".json,.xml,.zip,.png,.txt" multiple onChange={({ currentTarget }) => importMasks(currentTarget)} />
          Import masks…
        </label>
      </div>
      <p class="help faint">
        Masks of COCO, YouTube-VIS, CVAT, Label Studio, MOTS, YOLO or PNG files become corrections of their frames. You can also drop the files on the page.
      </p>
    </>
  );
}

/** One file is saved as it is, several as an archive. */
async function saveFiles(format: ClipFormat, made: Awaited<ReturnType<ClipFormat['make']>>): Promise<void> {
  const files = Object.entries(made);
  const [[name, content]] = files as [(typeof files)[number]];
  if (files.length === 1) return save(content instanceof Uint8Array ? new Uint8Array(content) : content, 'application/octet-stream', name);
  const bytes = files.map(async ([path, one]) => [path, new Uint8Array(await new Blob([one as BlobPart]).arrayBuffer())] as const);
  save(zipped(Object.fromEntries(await Promise.all(bytes))), 'application/zip', `${format.id}.zip`);
}
