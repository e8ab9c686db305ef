//! The timeline of a clip: thumbnails, the current frame, buttons to step and play.

import { strings } from '../common/strings.js';
import type { Session } from '../session/session.js';
import type { Timeline } from '../state/pair.js';
import type { Store } from '../state/state.js';
import { contextOf, find } from './markup.js';

/** Smallest width of a thumbnail, screen pixels. */
const THUMB = 72;
/** Page keys move by this share of the clip. */
const PAGE = 0.1;
/** How many frames arrow keys step with Shift. */
export const FAR = 10;

export function mountTimeline(root: HTMLElement, store: Store, session: Session): void {
  const strip = find(root, '#strip', HTMLCanvasElement);
  const track = find(root, '#track', HTMLElement);
  const play = find(root, '#play', HTMLButtonElement);
  const speeds = find(root, '#speed', HTMLButtonElement);
  for (const button of root.querySelectorAll<HTMLButtonElement>('[data-step]')) {
    button.addEventListener('click', () => void session.frames.step(Number(button.dataset.step)));
  }
  play.addEventListener('click', () => void session.play.toggle());
  speeds.addEventListener('click', () => session.play.cycle());
  mountScrubbing(track, store, session);

  store.subscribe(({ timeline, playing, speed }, before) => {
    if (playing !== before.playing) {
      play.textContent = playing ? '❚❚' : '▶';
      play.setAttribute('aria-label', playing ? strings.pause : strings.play);
    }
    if (speed !== before.speed) {
      speeds.textContent = strings.speed(speed);
      speeds.setAttribute('aria-label', strings.speedIs(speed));
    }
    if (timeline === before.timeline) return;
    root.classList.toggle('empty', timeline === null);
    if (timeline === null) return;
    const { clip } = timeline;
    if (clip !== before.timeline?.clip) {
      track.setAttribute('aria-valuemax', String(clip.count - 1));
      void drawStrip(strip, timeline, () => store.get().timeline?.clip === clip);
    }
    const at = currentFrame(timeline);
    track.setAttribute('aria-valuenow', String(at));
    track.setAttribute('aria-valuetext', strings.frameSlider(at, clip.count, clip.times?.[at] ?? null));
    root.style.setProperty('--first', String((at + 0.5) / clip.count));
  });
}

/** A press or a drag anywhere on the track moves the frame, and so do the keys of a slider. */
function mountScrubbing(track: HTMLElement, store: Store, session: Session): void {
  const indexAt = ({ clientX }: PointerEvent): number => {
    const { left, width } = track.getBoundingClientRect();
    const count = store.get().timeline?.clip.count ?? 1;
    return Math.min(Math.max(Math.floor(((clientX - left) / width) * count), 0), count - 1);
  };
  track.addEventListener('pointerdown', (event) => {
    if (event.button !== 0) return;
    track.setPointerCapture(event.pointerId);
    void session.play.scrub(indexAt(event));
  });
  track.addEventListener('pointermove', (event) => {
    const index = indexAt(event);
    if (track.hasPointerCapture(event.pointerId) && index !== currentFrame(store.get().timeline)) void session.play.scrub(index);
  });
  track.addEventListener('keydown', (event) => {
    const { timeline } = store.get();
    if (timeline === null || event.ctrlKey || event.metaKey || event.altKey) return;
    const [at, last] = [currentFrame(timeline), timeline.clip.count - 1];
    const page = Math.max(1, Math.round(last * PAGE));
    const step = event.shiftKey ? FAR : 1;
    const places: Readonly<Record<string, number>> = {
      ArrowLeft: at - step,
      ArrowDown: at - step,
      ArrowRight: at + step,
      ArrowUp: at + step,
      PageDown: at - page,
      PageUp: at + page,
      Home: 0,
      End: last,
    };
    const to = places[event.key];
    if (to === undefined) return;
    event.preventDefault();
    void session.frames.goTo(to);
  });
}

/** The index of the frame on screen. */
export function currentFrame(timeline: Timeline | null): number {
  return timeline?.first ?? 0;
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
