//! The residual: the intensity difference between a pixel and the position to which its motion moves it.

import type { Pixels, Segmentation } from 'veronese';

/** The difference drawn as white, grey levels. */
const FULL = 48;
const UNKNOWN = 0xff60_3010; // little-endian RGBA: dark blue
const OUTSIDE = 0xff28_2420;

const grey = (data: Pixels['data'], i: number): number => 0.299 * data[i]! + 0.587 * data[i + 1]! + 0.114 * data[i + 2]!;

/** Rows `from` to `to` of the picture: black, red, yellow, white by residual; blue without a label; dark grey outside the frame. */
export function residualOf(segmentation: Segmentation, first: Pixels, second: Pixels, from: number, to: number): Uint32Array<ArrayBuffer> {
  const { labels, width, height, motions } = segmentation;
  const pixels = new Uint32Array((to - from) * width);
  const byLabel = new Map(motions.map((motion) => [motion.label, motion]));
  for (let y = from, i = 0; y < to; y++) {
    for (let x = 0; x < width; x++, i++) {
      const p = y * width + x;
      const motion = byLabel.get(labels[p]!);
      if (motion === undefined) {
        pixels[i] = UNKNOWN;
        continue;
      }
      const [a11, a12, a13, a21, a22, a23] = motion.matrix;
      const [u, v] = [x + a11 * x + a12 * y + a13, y + a21 * x + a22 * y + a23];
      const inside = u >= 0 && v >= 0 && u <= width - 1 && v <= height - 1;
      pixels[i] = inside ? heat(Math.abs(sample(second, u, v) - grey(first.data, 4 * p)) / FULL) : OUTSIDE;
    }
  }
  return pixels;
}

/** Grey level by bilinear interpolation. */
function sample({ data, width, height }: Pixels, x: number, y: number): number {
  const [left, top] = [Math.min(Math.floor(x), width - 2), Math.min(Math.floor(y), height - 2)];
  const [fx, fy] = [x - left, y - top];
  const i = 4 * (top * width + left);
  const upper = grey(data, i) + fx * (grey(data, i + 4) - grey(data, i));
  const j = i + 4 * width;
  const lower = grey(data, j) + fx * (grey(data, j + 4) - grey(data, j));
  return upper + fy * (lower - upper);
}

/** 0 black, 1/3 red, 2/3 yellow, 1 white. */
function heat(share: number): number {
  const channel = (start: number): number => Math.max(0, Math.min(255, Math.round(255 * (3 * share - start))));
  return ((255 << 24) | (channel(2) << 16) | (channel(1) << 8) | channel(0)) >>> 0;
}
