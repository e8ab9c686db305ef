//! Results at the full size of frames that were scaled down.

import type { Segmentation } from 'veronese';

interface Size {
  readonly width: number;
  readonly height: number;
}

/** The segmentation at this size: labels by nearest neighbour, motions and boxes scaled. */
export function atSize(segmentation: Segmentation, full: Size): Segmentation {
  const { width, height } = segmentation;
  if (full.width === width && full.height === height) return segmentation;
  const [sx, sy] = [full.width / width, full.height / height];
  const columns = Uint32Array.from({ length: full.width }, (_, x) => Math.min(width - 1, Math.floor((x + 0.5) / sx)));
  const labels = new Uint8Array(full.width * full.height);
  const counts = new Uint32Array(256);
  for (let y = 0, i = 0; y < full.height; y++) {
    const row = Math.min(height - 1, Math.floor((y + 0.5) / sy)) * width;
    for (let x = 0; x < full.width; x++, i++) {
      const label = segmentation.labels[row + columns[x]!]!;
      labels[i] = label;
      counts[label]! += 1;
    }
  }
  const motions = segmentation.motions.map((motion) => ({
    ...motion,
    matrix: scaled(motion.matrix, sx, sy),
    pixels: counts[motion.label]!,
    share: counts[motion.label]! / labels.length,
    bbox: scaledBox(motion.bbox, sx, sy, full),
  }));
  return { ...segmentation, ...full, motions, labels, unlabelled: counts[255]! };
}

type Motion = Segmentation['motions'][number];

/** Pixel centres have integer coordinates at both sizes: x = (X + ½) / s − ½. */
function scaled([a11, a12, a13, a21, a22, a23]: Motion['matrix'], sx: number, sy: number): Motion['matrix'] {
  const [kx, ky] = [0.5 / sx - 0.5, 0.5 / sy - 0.5];
  return [a11, (a12 * sx) / sy, sx * (a13 + a11 * kx + a12 * ky), (a21 * sy) / sx, a22, sy * (a23 + a21 * kx + a22 * ky)];
}

function scaledBox([x, y, width, height]: Motion['bbox'], sx: number, sy: number, full: Size): Motion['bbox'] {
  // The first pixel whose centre is inside the box, and the first beyond it.
  const start = (value: number, s: number): number => Math.max(0, Math.ceil(value * s - 0.5));
  const [left, top] = [start(x, sx), start(y, sy)];
  return [left, top, Math.min(full.width, start(x + width, sx)) - left, Math.min(full.height, start(y + height, sy)) - top];
}
