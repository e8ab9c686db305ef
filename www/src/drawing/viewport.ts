//! Zoom and pan of the picture, as numbers.

export interface Viewport {
  /** 1 shows the whole picture. */
  readonly zoom: number;
  /** The point of the picture at the centre of the view, 0…1 in both directions. */
  readonly x: number;
  readonly y: number;
}

export const WHOLE: Viewport = { zoom: 1, x: 0.5, y: 0.5 };

/** Factor of the zoom buttons and keys. */
export const ZOOM_STEP = 1.5;

/** Largest size of a pixel of the picture, screen pixels. */
const LARGEST_PIXEL = 64;

/** Limits zoom and position so that the picture always fills the view. */
export function within({ zoom, x, y }: Viewport, fit: number): Viewport {
  const most = Math.max(1, LARGEST_PIXEL / fit);
  const z = Math.min(Math.max(zoom, 1), most);
  const half = 0.5 / z;
  const keep = (centre: number): number => Math.min(Math.max(centre, half), 1 - half);
  return { zoom: z, x: keep(x), y: keep(y) };
}

/**
 * Zooms around the point (u, v) of the view, 0…1. `fit`: size of a pixel of the picture at zoom 1, screen pixels.
 */
export function zoomedAt(viewport: Viewport, factor: number, [u, v]: readonly [number, number], fit: number): Viewport {
  const zoom = within({ ...viewport, zoom: viewport.zoom * factor }, fit).zoom;
  const shift = 1 / viewport.zoom - 1 / zoom;
  return within({ zoom, x: viewport.x + (u - 0.5) * shift, y: viewport.y + (v - 0.5) * shift }, fit);
}

/** Moves the picture by shares of the view: 1 is its whole width or height. */
export function panned(viewport: Viewport, right: number, down: number, fit: number): Viewport {
  return within({ ...viewport, x: viewport.x - right / viewport.zoom, y: viewport.y - down / viewport.zoom }, fit);
}

/** The point of the picture, 0…1, at a point of the view, 0…1. */
export function inPicture({ zoom, x, y }: Viewport, [u, v]: readonly [number, number]): [number, number] {
  return [x + (u - 0.5) / zoom, y + (v - 0.5) / zoom];
}
