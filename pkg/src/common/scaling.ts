// Pictures scaled down so that their longest side has a given number of pixels. Each pixel is the mean of the area that it covers.

import type { Pixels } from '../../types/index.js';

/** The picture itself where it is not larger. It may have any number of channels. */
export function scaled(frame: Pixels, longest: number | undefined): Pixels {
  const { data, width: w, height: h } = frame;
  const { width, height } = scaledSize(frame, longest);
  if (width === w && height === h) return frame;
  const channels = data.length / (w * h);
  const [out, row, sums] = [
    new Uint8Array(channels * width * height),
    new Float64Array(channels * width),
    new Float64Array(channels * width),
  ];
  const area = (w / width) * (h / height);
  for (let y = 0, to = 0; y < h; y++) {
    row.fill(0);
    for (let x = 0; x < width; x++) {
      const [begin, end] = [(x * w) / width, ((x + 1) * w) / width];
      for (let from = Math.floor(begin); from < end; from++) {
        const part = Math.min(from + 1, end) - Math.max(from, begin);
        for (let channel = 0; channel < channels; channel++)
          (row[channels * x + channel] as number) += part * (data[channels * (y * w + from) + channel] as number);
      }
    }
    // Scaled down, a row of the frame belongs to two rows at most.
    for (let top = y; top < y + 1;) {
      const end = ((to + 1) * h) / height;
      const bottom = Math.min(y + 1, end);
      for (let at = 0; at < row.length; at++) (sums[at] as number) += (bottom - top) * (row[at] as number);
      top = bottom;
      if (bottom < end) continue;
      for (let at = 0; at < sums.length; at++) out[to * sums.length + at] = Math.round((sums[at] as number) / area);
      sums.fill(0);
      to++;
    }
  }
  return { data: out, width, height };
}

export function scaledSize({ width, height }: Pick<Pixels, 'width' | 'height'>, longest = Infinity): { width: number; height: number } {
  const factor = Math.min(1, longest / Math.max(width, height));
  return { width: Math.max(1, Math.round(factor * width)), height: Math.max(1, Math.round(factor * height)) };
}

/** Labels scaled as frames are: each pixel has the label in its middle. */
export function scaledLabels(
  image: { labels: Uint8Array; width: number; height: number },
  longest: number | undefined,
): { labels: Uint8Array; width: number; height: number } {
  const { labels, width: w, height: h } = image;
  const { width, height } = scaledSize(image, longest);
  if (width === w && height === h) return image;
  const from = (at: number, side: number, of: number) => Math.floor(((at + 0.5) * of) / side);
  const columns = Array.from({ length: width }, (_, x) => from(x, width, w));
  const scaled = new Uint8Array(width * height);
  for (let y = 0, at = 0; y < height; y++) for (const column of columns) scaled[at++] = labels[from(y, height, h) * w + column] as number;
  return { labels: scaled, width, height };
}
