//! Opening files, a folder or the camera.

import { strings } from '../common/strings.js';
import type { Session } from '../session/session.js';
import type { Store } from '../state/state.js';
import { find } from './markup.js';

export function mountPicker(root: ParentNode, store: Store, session: Session): void {
  const listen = (input: HTMLInputElement): void => {
    const open = (): void => {
      const files = [...(input.files ?? [])];
      input.value = ''; // so that choosing the same file again is a change
      if (files.length > 0) void session.open.files(files);
    };
    input.addEventListener('change', open);
    open(); // what was chosen before this code was there
  };
  listen(find(root, '#open-pair', HTMLInputElement));
  listen(find(root, '#open-folder', HTMLInputElement));
  const camera = find(root, '#open-camera', HTMLButtonElement);
  camera.addEventListener('click', () => void session.camera.toggle());
  camera.hidden = navigator.mediaDevices === undefined;
  store.subscribe(({ live }, before) => {
    if (live === before.live) return;
    camera.setAttribute('aria-pressed', String(live !== null));
    camera.textContent = live === null ? strings.openCamera : strings.closeCamera;
  });
}
