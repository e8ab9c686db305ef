//! Taking the result away as files.

import { groupLabels } from 'veronese';
import { pngFromLabels } from '../png.js';
import type { Result, Store } from '../state.js';
import { find } from './markup.js';

export function mountDownloads(root: ParentNode, store: Store): void {
  const labels = find(root, '#take-labels', HTMLButtonElement);
  const json = find(root, '#take-json', HTMLButtonElement);
  store.subscribe(({ result }) => {
    labels.disabled = json.disabled = result === null;
  });
  json.addEventListener('click', () => {
    const { result } = store.get();
    if (result !== null) save(new Blob([jsonOf(result)], { type: 'application/json' }), 'result.json');
  });
  labels.addEventListener('click', () => {
    const { result, look } = store.get();
    if (result === null) return;
    const { segmentation } = result;
    const { width, height } = segmentation;
    const seen = look.kind === 'groups' ? groupLabels(segmentation) : segmentation.labels;
    void pngFromLabels(seen, width, height).then((file) => save(file, 'labels.png'));
  });
}

/** The report as the command line prints it: everything but the labels, which have a file of their own. */
function jsonOf({ segmentation }: Result): string {
  const { labels: _, ...report } = segmentation;
  return `${JSON.stringify(report)}\n`;
}

function save(file: Blob, name: string): void {
  const link = document.createElement('a');
  link.href = URL.createObjectURL(file);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}
