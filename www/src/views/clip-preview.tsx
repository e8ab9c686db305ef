//! The preview of a clip's export: the names of its files, and one frame as its file shows it.

import type { VNode } from 'preact';
import { useEffect, useRef, useState } from 'preact/hooks';
import { sentenceOf } from '../common/errors.js';
import { strings } from '../common/strings.js';
import type { ClipFormat } from '../export/clip-export.js';
import { type Folder, type Preview, previewOf } from '../export/clip-preview.js';
import type { Store } from '../state/state.js';
import { usePart } from './component.js';

interface Given {
  readonly panel: HTMLElement;
  readonly store: Store;
  readonly format: ClipFormat;
}

/** A preview that is made, of a frame, and what is said of it. */
interface Made {
  readonly index: number;
  readonly preview: Preview | null;
  readonly sentence: string;
}

export function ClipPreview({ panel, store, format }: Given): VNode {
  const [made, show] = useState<Made>({ index: 0, preview: null, sentence: '' });
  const wanted = useRef({ format, isOutdated: false, isWorking: false });
  wanted.current.format = format;
  const [tracked, look, timeline] = [usePart(store, (state) => state.tracked), usePart(store, (state) => state.look), usePart(store, (state) => state.timeline)];

  /** One preview is made at a time, and shown unless another is wanted meanwhile. */
  const refresh = async (): Promise<void> => {
    const now = wanted.current;
    now.isOutdated = true;
    if (now.isWorking) return;
    now.isWorking = true;
    while (now.isOutdated) {
      now.isOutdated = false;
      const state = store.get();
      if (state.tracked === null || !panel.matches(':popover-open')) break;
      const index = state.timeline?.first ?? 0;
      try {
        const preview = await previewOf(now.format, state.tracked, state, index);
        if (!now.isOutdated) show({ index, preview, sentence: captionOf(preview, index) });
      } catch (error) {
        show({ index, preview: null, sentence: sentenceOf(error) });
      }
    }
    now.isWorking = false;
  };
  useEffect(() => void refresh(), [format, tracked, look, timeline]);
  useEffect(() => panel.addEventListener('toggle', () => void refresh()), []);

  const shown = made.preview?.shown ?? null;
  return (
    <figure id="clip-preview" class="preview">
      <ul aria-label="Files">{(made.preview?.folders ?? []).map(rowOf)}</ul>
      <div>
        <Picture file={shown instanceof Blob ? shown : null} alt={strings.preview.picture(made.index)} />
        <pre hidden={typeof shown !== 'string'} tabIndex={0} aria-label="Beginning of the file">
          {typeof shown === 'string' ? shown : ''}
        </pre>
      </div>
      <figcaption class="help faint">{made.sentence}</figcaption>
    </figure>
  );
}

function Picture({ file, alt }: { file: Blob | null; alt: string }): VNode {
  const [address, set] = useState('');
  useEffect(() => {
    const own = file === null ? '' : URL.createObjectURL(file);
    set(own);
    return () => URL.revokeObjectURL(own);
  }, [file]);
  return <img hidden={file === null} alt={alt} src={address === '' ? undefined : address} />;
}

function captionOf(preview: Preview | null, index: number): string {
  if (preview === null) return strings.notices.nothingTicked;
  const { file, shown } = preview;
  if (shown === null) return strings.preview.noMasks;
  if (file === null) return strings.frameNumber(index);
  return file.ofFrame ? strings.preview.ofFrame(file.name, file.bytes) : strings.preview.ofAll(file.name, index, file.bytes);
}

function rowOf({ path, files }: Folder): VNode {
  return (
    <li key={path}>
      <code>
        {path}
        {files[0]}
      </code>
      {files.length > 1 && (
        <>
          {' … '}
          <code>{files.at(-1)}</code>
          <span class="faint">{strings.preview.files(files.length)}</span>
        </>
      )}
    </li>
  );
}
