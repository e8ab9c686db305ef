//! The pair: opening files, replacing one frame, swapping, and the two thumbnails.

import type { LoadedFrame } from '../frames.js';
import type { Session } from '../session.js';
import type { Slot, Store } from '../state.js';
import { strings } from '../strings.js';
import { contextOf, find } from './markup.js';

export function mountPicker(root: ParentNode, store: Store, session: Session): void {
  const listen = (input: HTMLInputElement, slot: Slot | null): void => {
    input.addEventListener('change', () => {
      const files = [...(input.files ?? [])];
      input.value = ''; // the same file may be chosen again
      if (files.length > 0) void session.openFiles(files, slot);
    });
  };
  listen(find(root, '#open-pair', HTMLInputElement), null);
  find(root, '#open-sample', HTMLButtonElement).addEventListener('click', () => void session.openSample());
  const swap = find(root, '#swap', HTMLButtonElement);
  swap.addEventListener('click', () => session.swap());

  const slots = (['first', 'second'] as const).map((slot) => {
    const element = find(root, `[data-slot=${slot}]`, HTMLElement);
    listen(find(element, 'input', HTMLInputElement), slot);
    const thumb = find(element, '.thumb', HTMLCanvasElement);
    const name = find(element, '.slot-name', HTMLElement);
    return (frame: LoadedFrame | null): void => {
      drawThumb(thumb, frame);
      name.textContent = frame === null ? strings.empty : `${frame.name}, ${strings.size(frame.width, frame.height)}`;
    };
  });

  store.subscribe(({ pair }, before) => {
    if (pair === before.pair) return;
    slots[0]?.(pair.first);
    slots[1]?.(pair.second);
    swap.disabled = pair.first === null && pair.second === null;
  });
}

/** The whole frame, as large as it fits, in the middle. */
function drawThumb(canvas: HTMLCanvasElement, frame: LoadedFrame | null): void {
  const context = contextOf(canvas);
  context.clearRect(0, 0, canvas.width, canvas.height);
  if (frame === null) return;
  const scale = Math.min(canvas.width / frame.width, canvas.height / frame.height);
  const [width, height] = [frame.width * scale, frame.height * scale];
  context.imageSmoothingQuality = 'high';
  context.drawImage(frame.bitmap, (canvas.width - width) / 2, (canvas.height - height) / 2, width, height);
}
