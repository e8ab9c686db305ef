//! The preview of a clip's export: the names of its files, and one frame as its file shows it.

import { sentenceOf } from '../common/errors.js';
import { strings } from '../common/strings.js';
import type { ClipFormat } from '../export/clip-export.js';
import { type Folder, type Preview, previewOf } from '../export/clip-preview.js';
import type { Store } from '../state/state.js';
import { element, find } from './markup.js';

export function mountClipPreview(panel: HTMLElement, store: Store, formats: readonly ClipFormat[]): void {
  const select = find(panel, '#clip-export select', HTMLSelectElement);
  const root = find(panel, '#clip-preview', HTMLElement);
  const list = find(root, 'ul', HTMLUListElement);
  const caption = find(root, 'figcaption', HTMLElement);
  const picture = find(root, 'img', HTMLImageElement);
  const text = find(root, 'pre', HTMLElement);
  /** Whether what is shown is outdated. */
  let outdated = false;
  let working = false;

  const show = (made: Preview | null, sentence: string): void => {
    const shown = made?.shown ?? null;
    list.replaceChildren(...(made?.folders ?? []).map(rowOf));
    caption.textContent = sentence;
    text.hidden = typeof shown !== 'string';
    text.textContent = typeof shown === 'string' ? shown : '';
    picture.hidden = !(shown instanceof Blob);
    URL.revokeObjectURL(picture.src);
    picture.removeAttribute('src');
    if (shown instanceof Blob) picture.src = URL.createObjectURL(shown);
  };

  /** One preview is made at a time, and shown unless another is wanted meanwhile. */
  const refresh = async (): Promise<void> => {
    outdated = true;
    if (working) return;
    working = true;
    while (outdated) {
      outdated = false;
      const { tracked, timeline } = store.get();
      const format = formats[select.selectedIndex];
      if (format === undefined || tracked === null || !panel.matches(':popover-open')) break;
      const index = timeline?.first ?? 0;
      picture.alt = strings.preview.picture(index);
      try {
        const made = await previewOf(format, tracked, store.get(), index);
        if (!outdated) show(made, captionOf(made, index));
      } catch (error) {
        show(null, sentenceOf(error));
      }
    }
    working = false;
  };

  select.addEventListener('change', () => void refresh());
  panel.addEventListener('toggle', () => void refresh());
  store.subscribe(({ tracked, look, timeline }, before) => {
    if (tracked !== before.tracked || look !== before.look || timeline !== before.timeline) void refresh();
  });
  void refresh();
}

function captionOf(preview: Preview | null, index: number): string {
  if (preview === null) return strings.notices.nothingTicked;
  const { file, shown } = preview;
  if (shown === null) return strings.preview.noMasks;
  if (file === null) return strings.frameNumber(index);
  return file.ofFrame ? strings.preview.ofFrame(file.name, file.bytes) : strings.preview.ofAll(file.name, index, file.bytes);
}

function rowOf({ path, files }: Folder): HTMLElement {
  const row = element('li');
  row.append(element('code', `${path}${files[0]!}`));
  if (files.length > 1) row.append(' … ', element('code', files.at(-1)), element('span', strings.preview.files(files.length), 'faint'));
  return row;
}
