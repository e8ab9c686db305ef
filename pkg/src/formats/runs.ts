// Run lengths of a mask, alternating 0s and 1s, the first of 0s: it is 0 where the first pixel is set.

import type { Mask } from './masks.js';

/** Row by row over the mask's own box. */
export function rowRuns(pixels: Uint8Array): number[] {
  const runs: number[] = [];
  let value = 0;
  let start = 0;
  for (let at = 0; at < pixels.length; at++) {
    if (pixels[at] === value) continue;
    runs.push(at - start);
    value = 1 - value;
    start = at;
  }
  runs.push(pixels.length - start);
  return runs;
}

/** Column by column over an image of the given size. */
export function columnRuns({ left, top, width, height, pixels }: Mask, imageWidth: number, imageHeight: number): number[] {
  const runs: number[] = [];
  let value = 0;
  let start = 0;
  for (let x = 0; x < width; x++) {
    const column = (left + x) * imageHeight;
    for (let y = 0; y <= height; y++) {
      const pixel = y < height ? (pixels[y * width + x] as number) : 0;
      // Where the box is as high as the image, the pixel after a column is the top of the next one, which has its turn then.
      if (pixel === value || (y === height && height === imageHeight && x + 1 < width)) continue;
      const at = column + top + y;
      if (at === start && runs.length > 0) {
        start = at - (runs.pop() as number);
      } else {
        runs.push(at - start);
        start = at;
      }
      value = 1 - value;
    }
  }
  const end = imageWidth * imageHeight;
  if (end > start) runs.push(end - start);
  return runs;
}
