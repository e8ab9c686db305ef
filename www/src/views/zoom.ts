//! Zoom and pan: the transform of the picture, the pixel grid, the buttons.

import { strings } from '../common/strings.js';
import { WHOLE, ZOOM_STEP, type Viewport, panned, within, zoomedAt } from '../drawing/viewport.js';
import type { Store } from '../state/state.js';
import { find } from './markup.js';

/** Pixels are drawn as squares from the first size on, and with a grid from the second, screen pixels. */
const SQUARES_FROM = 3;
const GRID_FROM = 10;

/** Changes to the viewport by buttons, keys, wheel and fingers. */
export class Zoom {
  constructor(
    readonly store: Store,
    readonly layers: HTMLElement,
  ) {}

  /** Screen pixels per pixel of the frame at zoom 1. */
  fit(): number {
    const { pair } = this.store.get();
    const frame = pair.first;
    return frame === null ? 1 : Math.max(1e-3, this.layers.offsetWidth / frame.width);
  }

  by(factor: number, at: readonly [number, number] = [0.5, 0.5]): void {
    this.#set(zoomedAt(this.store.get().viewport, factor, at, this.fit()));
  }

  pan(right: number, down: number): void {
    this.#set(panned(this.store.get().viewport, right, down, this.fit()));
  }

  whole(): void {
    this.#set(WHOLE);
  }

  /** Shows one pixel of the frame as one pixel of the screen. */
  actual(): void {
    const { viewport } = this.store.get();
    this.#set(within({ ...viewport, zoom: 1 / this.fit() }, this.fit()));
  }

  #set(viewport: Viewport): void {
    const { viewport: now } = this.store.get();
    if (viewport.zoom !== now.zoom || viewport.x !== now.x || viewport.y !== now.y) this.store.set({ viewport });
  }
}

export function mountZoom(stage: HTMLElement, store: Store): Zoom {
  const layers = find(stage, '.layers', HTMLElement);
  const content = find(stage, '.content', HTMLElement);
  const grid = find(stage, '#grid', HTMLElement);
  const value = find(stage, '#zoom-value', HTMLButtonElement);
  const out = find(stage, '#zoom-out', HTMLButtonElement);
  const zoom = new Zoom(store, layers);

  find(stage, '#zoom-in', HTMLButtonElement).addEventListener('click', () => zoom.by(ZOOM_STEP));
  out.addEventListener('click', () => zoom.by(1 / ZOOM_STEP));
  find(stage, '#zoom-fit', HTMLButtonElement).addEventListener('click', () => zoom.whole());
  value.addEventListener('click', () => zoom.actual());

  const render = (): void => {
    const { viewport, pair } = store.get();
    const frame = pair.first;
    if (frame === null) return;
    const scale = viewport.zoom * zoom.fit();
    const [left, top] = [0.5 - viewport.x * viewport.zoom, 0.5 - viewport.y * viewport.zoom];
    content.style.transform = viewport.zoom === 1 ? 'none' : `translate(${left * 100}%, ${top * 100}%) scale(${viewport.zoom})`;
    stage.style.setProperty('--scale', String(viewport.zoom));
    stage.classList.toggle('squares', scale >= SQUARES_FROM);
    stage.classList.toggle('zoomed', viewport.zoom > 1);
    grid.hidden = scale < GRID_FROM;
    if (!grid.hidden) {
      const { offsetWidth: width, offsetHeight: height } = layers;
      grid.style.backgroundSize = `${scale}px ${scale}px`;
      grid.style.backgroundPosition = `${left * width}px ${top * height}px`;
    }
    out.disabled = viewport.zoom <= 1;
    value.textContent = strings.percent(Math.round(scale * 100) / 100);
    value.setAttribute('aria-label', strings.zoomValue(value.textContent));
  };
  store.subscribe((now, before) => {
    if (now.viewport !== before.viewport || now.pair !== before.pair) render();
  });
  new ResizeObserver(render).observe(layers);
  return zoom;
}
