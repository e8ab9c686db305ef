//! Opening files, a folder or the camera; replacing and swapping frames; the two thumbnails.

import { strings } from '../common/strings.js';
import type { Session } from '../session/session.js';
import type { LoadedFrame, Slot } from '../state/pair.js';
import type { Store } from '../state/state.js';
import { contextOf, find } from './markup.js';

export function mountPicker(root: ParentNode, store: Store, session: Session): void {
  const listen = (input: HTMLInputElement, slot: Slot | null): void => {
    const open = (): void => {
      const files = [...(input.files ?? [])];
      input.value = ''; // so that choosing the same file again is a change
      if (files.length > 0) void session.open.files(files, slot);
    };
    input.addEventListener('change', open);
    open(); // what was chosen before this code was there
  };
  listen(find(root, '#open-pair', HTMLInputElement), null);
  listen(find(root, '#open-folder', HTMLInputElement), null);
  const camera = find(root, '#open-camera', HTMLButtonElement);
  camera.addEventListener('click', () => void session.camera.toggle());
  camera.hidden = navigator.mediaDevices === undefined;
  const swap = find(root, '#swap', HTMLButtonElement);
  swap.addEventListener('click', () => session.frames.swap());

  const slots = (['first', 'second'] as const).map((slot) => {
    const box = find(root, `[data-slot=${slot}]`, HTMLElement);
    listen(find(box, 'input', HTMLInputElement), slot);
    const thumb = find(box, '.thumb', HTMLCanvasElement);
    const name = find(box, '.slot-name', HTMLElement);
    return (frame: LoadedFrame | null): void => {
      drawThumb(thumb, frame);
      name.textContent = frame === null ? strings.empty : strings.frameOf(frame.name, frame.full.width, frame.full.height);
    };
  });

  store.subscribe(({ pair, live }, before) => {
    if (live !== before.live) {
      camera.setAttribute('aria-pressed', String(live !== null));
      camera.textContent = live === null ? strings.openCamera : strings.closeCamera;
      swap.disabled = live !== null;
    }
    if (pair === before.pair) return;
    slots[0]?.(pair.first);
    slots[1]?.(pair.second);
    swap.disabled = live !== null || (pair.first === null && pair.second === null);
  });
}

/** Draws the whole frame, as large as fits, centred. */
function drawThumb(canvas: HTMLCanvasElement, frame: LoadedFrame | null): void {
  const context = contextOf(canvas);
  context.clearRect(0, 0, canvas.width, canvas.height);
  if (frame === null) return;
  const scale = Math.min(canvas.width / frame.width, canvas.height / frame.height);
  const [width, height] = [frame.width * scale, frame.height * scale];
  context.imageSmoothingQuality = 'high';
  context.drawImage(frame.bitmap, (canvas.width - width) / 2, (canvas.height - height) / 2, width, height);
}
