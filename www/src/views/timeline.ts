//! The timeline of a clip: thumbnails, the two chosen frames, buttons to step.

import { strings } from '../common/strings.js';
import type { Session } from '../session/session.js';
import type { Slot, Timeline } from '../state/pair.js';
import type { Store } from '../state/state.js';
import { contextOf, find } from './markup.js';

/** Smallest width of a thumbnail, screen pixels. */
const THUMB = 72;
/** Position of a hidden mark, share of the strip. */
const OUTSIDE = '-1';

export function mountTimeline(root: HTMLElement, store: Store, session: Session): void {
  const strip = find(root, '#strip', HTMLCanvasElement);
  const label = find(root, '#clip-name', HTMLElement);
  const note = find(root, '#clip-note', HTMLElement);
  const sliders = (['first', 'second'] as const).map((slot) => {
    const input = find(root, `[name=clip-${slot}]`, HTMLInputElement);
    const readout = find(root, `#clip-${slot}-at`, HTMLElement);
    input.addEventListener('input', () => (readout.textContent = placeOf(store.get().timeline, input.valueAsNumber)));
    input.addEventListener('change', () => void session.choose(slot, input.valueAsNumber));
    return { slot, input, readout };
  });
  for (const button of root.querySelectorAll<HTMLButtonElement>('[data-step]')) {
    const [slot, by] = (button.dataset.step ?? '').split(' ');
    button.addEventListener('click', () => stepOne(store, session, slot as Slot | 'both', Number(by)));
  }
  strip.addEventListener('click', (event) => {
    const { timeline } = store.get();
    if (timeline === null) return;
    const index = Math.floor((event.offsetX / strip.clientWidth) * timeline.clip.count);
    void session.choose(event.shiftKey ? 'second' : 'first', index);
  });

  store.subscribe(({ timeline }, before) => {
    if (timeline === before.timeline) return;
    root.hidden = timeline === null;
    if (timeline === null) return;
    const { clip } = timeline;
    if (clip !== before.timeline?.clip) {
      label.textContent = strings.clip(clip.name, clip.count, clip.width, clip.height);
      note.hidden = clip.exact;
      void drawStrip(strip, timeline, () => store.get().timeline?.clip === clip);
    }
    for (const { slot, input, readout } of sliders) {
      const index = timeline[slot];
      root.style.setProperty(`--${slot}`, index === null ? OUTSIDE : String((index + 0.5) / clip.count));
      input.max = String(clip.count - 1);
      if (index !== null) input.value = String(index);
      readout.textContent = placeOf(timeline, index);
    }
  });
}

/** Steps one frame or both. A frame that is not of the clip starts from the position of the other. */
export function stepOne(store: Store, session: Session, which: Slot | 'both', by: number): void {
  const { timeline } = store.get();
  if (timeline === null) return;
  if (which === 'both') void session.step(by);
  else void session.choose(which, (timeline[which] ?? timeline.first ?? timeline.second ?? 0) + by);
}

function placeOf(timeline: Timeline | null, index: number | null): string {
  if (timeline === null) return '';
  if (index === null) return strings.anotherFile;
  return strings.frameAt(index, timeline.clip.times?.[index] ?? null);
}

async function drawStrip(canvas: HTMLCanvasElement, { clip }: Timeline, current: () => boolean): Promise<void> {
  const dense = Math.min(2, devicePixelRatio);
  const [across, height] = [canvas.clientWidth || 640, canvas.clientHeight || 48];
  const count = Math.max(1, Math.min(clip.count, Math.floor(across / THUMB)));
  canvas.width = across * dense;
  canvas.height = height * dense;
  const context = contextOf(canvas);
  const cell = canvas.width / count;
  const indices = Array.from({ length: count }, (_, k) => Math.floor(((k + 0.5) * clip.count) / count));
  let k = 0;
  try {
    await clip.thumbnails(indices, (_, picture) => {
      const left = k++ * cell;
      if (!current()) return;
      // The frame covers the cell and is cropped at the sides.
      const scale = Math.max(cell / clip.width, canvas.height / clip.height);
      const [width, tall] = [clip.width * scale, clip.height * scale];
      context.save();
      context.beginPath();
      context.rect(left, 0, cell, canvas.height);
      context.clip();
      picture(context, left + (cell - width) / 2, (canvas.height - tall) / 2, width, tall);
      context.restore();
    });
  } catch {
    // Thumbnails are optional; choosing a frame reports the error.
  }
}
