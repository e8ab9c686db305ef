// A small PNG writer: 8-bit indexed, 8- and 16-bit grey. Compressed by fflate and not by the host's CompressionStream: the same
// mask must give the same bytes everywhere, the call must not be asynchronous, and archives need fflate anyway.

import { zlibSync } from 'fflate';
import { pngFile, type PngOptions } from './png-file.js';

/** Changes along the rows above which a picture is noise, if there is more than one in so many samples. */
const NOISE = { changes: 65_536, samplesPerChange: 16 };

/** `samples` row by row, one or two bytes each. */
export function png(width: number, height: number, samples: Uint8Array, options: PngOptions = {}): Uint8Array {
  const { depth = 8 } = options;
  const stride = (width * depth) / 8;
  const rows = new Uint8Array((stride + 1) * height);
  // Filter 0, "none", before every row: the others gain nothing on indices.
  for (let y = 0; y < height; y++) rows.set(samples.subarray(y * stride, (y + 1) * stride), y * (stride + 1) + 1);
  return pngFile(width, height, zlibSync(rows, { level: levelFor(samples, depth / 8) }), options);
}

/**
 * The search for repetitions of level 9 takes twenty times as long in noise as that of level 6 and finds a twentieth more; masks
 * with borders that somebody drew or found are hardly slower for it, and a third smaller.
 */
function levelFor(samples: Uint8Array, bytes: number): 6 | 9 {
  let changes = 0;
  for (let at = bytes; at < samples.length; at++) if (samples[at] !== samples[at - bytes]) changes++;
  return changes > NOISE.changes && changes * NOISE.samplesPerChange > samples.length ? 6 : 9;
}
