//! Run-length encoded labels: they store corrections in little memory and compare two labellings quickly.

/** Row-major; run k covers the pixels from `ends[k - 1]` up to, but not including, `ends[k]`. */
export interface Runs {
  readonly width: number;
  readonly height: number;
  readonly ends: Uint32Array;
  readonly labels: Uint8Array;
}

export function packed(labels: Uint8Array, width: number, height: number): Runs {
  let count = Math.min(1, labels.length);
  for (let p = 1; p < labels.length; p++) if (labels[p] !== labels[p - 1]) count += 1;
  const runs = { width, height, ends: new Uint32Array(count), labels: new Uint8Array(count) };
  for (let p = 1, k = 0; p <= labels.length; p++) {
    if (p < labels.length && labels[p] === labels[p - 1]) continue;
    runs.ends[k] = p;
    runs.labels[k++] = labels[p - 1]!;
  }
  return runs;
}

export function unpacked({ width, height, ends, labels }: Runs): Uint8Array<ArrayBuffer> {
  const pixels = new Uint8Array(width * height);
  for (let k = 0, from = 0; k < ends.length; from = ends[k++]!) pixels.fill(labels[k]!, from, ends[k]);
  return pixels;
}

/** The number of pixels whose labels differ; all of the first if the sizes do. */
export function differingPixels(one: Runs, other: Runs): number {
  if (one.width !== other.width || one.height !== other.height) return one.width * one.height;
  let [count, from, k, l] = [0, 0, 0, 0];
  while (k < one.ends.length && l < other.ends.length) {
    const [end, last] = [one.ends[k]!, other.ends[l]!];
    const to = Math.min(end, last);
    if (one.labels[k] !== other.labels[l]) count += to - from;
    from = to;
    if (end === to) k += 1;
    if (last === to) l += 1;
  }
  return count;
}

/** How many pixels a label has, and the box around them: x, y, width, height. */
export interface Extent {
  readonly pixels: number;
  readonly bbox: [number, number, number, number];
}

export function extentsOf({ width, ends, labels }: Runs): Map<number, Extent> {
  const extents = new Map<number, Extent>();
  for (let k = 0, from = 0; k < ends.length; from = ends[k++]!) {
    const last = ends[k]! - 1;
    const [top, bottom] = [Math.floor(from / width), Math.floor(last / width)];
    // A run that goes on in the next row touches both sides.
    const [left, right] = top === bottom ? [from % width, last % width] : [0, width - 1];
    const { pixels, bbox: [x, y, across, down] } = extents.get(labels[k]!) ?? { pixels: 0, bbox: [left, top, 0, 0] };
    const x0 = Math.min(x, left);
    const bbox: Extent['bbox'] = [x0, y, Math.max(x + across, right + 1) - x0, Math.max(y + down, bottom + 1) - y];
    extents.set(labels[k]!, { pixels: pixels + last + 1 - from, bbox });
  }
  return extents;
}

/** The labels at another size, by nearest neighbour. */
export function resized(runs: Runs, { width, height }: Pick<Runs, 'width' | 'height'>): Runs {
  if (runs.width === width && runs.height === height) return runs;
  const [labels, sx, sy] = [unpacked(runs), runs.width / width, runs.height / height];
  const pixels = new Uint8Array(width * height);
  for (let y = 0, p = 0; y < height; y++) {
    const row = Math.floor((y + 0.5) * sy) * runs.width;
    for (let x = 0; x < width; x++) pixels[p++] = labels[row + Math.floor((x + 0.5) * sx)]!;
  }
  return packed(pixels, width, height);
}
