//! Files and folders dropped on the page or pasted.

import { filesOf } from '../frames/dropped.js';
import type { Session } from '../session/session.js';

export function mountDrop(root: HTMLElement, session: Session): void {
  // Entering a child leaves its parent, so a count shows when the files have left the page.
  let inside = 0;
  const show = (): void => void root.classList.toggle('dropping', inside > 0);
  const carriesFiles = (event: DragEvent): boolean => event.dataTransfer?.types.includes('Files') ?? false;

  root.addEventListener('dragenter', (event) => {
    if (!carriesFiles(event)) return;
    event.preventDefault();
    inside += 1;
    show();
  });
  root.addEventListener('dragover', (event) => {
    if (carriesFiles(event)) event.preventDefault();
  });
  root.addEventListener('dragleave', (event) => {
    if (!carriesFiles(event)) return;
    inside = Math.max(0, inside - 1);
    show();
  });
  root.addEventListener('drop', (event) => {
    inside = 0;
    show();
    if (event.dataTransfer === null || !carriesFiles(event)) return;
    event.preventDefault();
    void session.open.files(filesOf(event.dataTransfer));
  });
  document.addEventListener('paste', (event) => {
    const { clipboardData } = event;
    if (clipboardData === null || clipboardData.files.length === 0) return; // text for an input
    event.preventDefault();
    void session.open.files(filesOf(clipboardData));
  });
}
