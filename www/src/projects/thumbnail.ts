//! The picture of a project: the frame on screen with its masks, small, as a `data:` address.

import { type Painting, wordsByLabel } from '../drawing/paint.js';
import type { Result, State } from '../state/state.js';

const [WIDTH, HEIGHT] = [144, 96];
/** Opacity of the masks: they must be seen in little. */
const OPACITY = 0.55;

/** `null` if there is nothing to see, or this browser cannot draw it. */
export async function thumbnailOf({ pair, result, look }: State): Promise<string | null> {
  const frame = result?.frame ?? pair.first;
  const canvas = new OffscreenCanvas(WIDTH, HEIGHT);
  const context = canvas.getContext('2d', { willReadFrequently: true });
  if (frame === null || context === null) return null;
  // The frame covers the picture and is cropped at two sides.
  const scale = Math.min(frame.width / WIDTH, frame.height / HEIGHT);
  const left = (frame.width - WIDTH * scale) / 2;
  const top = (frame.height - HEIGHT * scale) / 2;
  context.imageSmoothingQuality = 'high';
  context.drawImage(frame.bitmap, left, top, WIDTH * scale, HEIGHT * scale, 0, 0, WIDTH, HEIGHT);
  if (result !== null) {
    const image = context.getImageData(0, 0, WIDTH, HEIGHT);
    paint(image.data, result, look, (x, y) => [Math.floor(left + (x + 0.5) * scale), Math.floor(top + (y + 0.5) * scale)]);
    context.putImageData(image, 0, 0);
  }
  // Some browsers may write another format than they are asked for.
  const file = await canvas.convertToBlob({ type: 'image/jpeg', quality: 0.75 });
  if (file.type !== 'image/jpeg') return null;
  return `data:${file.type};base64,${btoa(String.fromCharCode(...new Uint8Array(await file.arrayBuffer())))}`;
}

/** `from`: where in the frame a pixel of the picture comes from. */
function paint(data: Uint8ClampedArray, { masks }: Result, painting: Painting, from: (x: number, y: number) => readonly [number, number]): void {
  const words = wordsByLabel(painting);
  for (let y = 0, i = 0; y < HEIGHT; y++) {
    for (let x = 0; x < WIDTH; x++, i += 4) {
      const [column, row] = from(x, y);
      const word = words[masks.labels[row * masks.width + column]!]!;
      if (word === 0) continue;
      for (let k = 0; k < 3; k++) data[i + k] = data[i + k]! * (1 - OPACITY) + ((word >>> (8 * k)) & 255) * OPACITY;
    }
  }
}
