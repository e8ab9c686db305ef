// Label images as PNG files: indices in the palette of the DAVIS benchmark, and a mask for each label. Compressed by fflate and not by the
// host's CompressionStream: the same masks give the same bytes everywhere.

import { zlibSync } from 'fflate';
import { colourBytes, davisPalette } from '../common/palette.js';
import { type Encoder, lines, Stems } from './frames.js';
import { checkPath } from './file-names.js';
import type { Settings } from './metadata.js';
import { pngFile, rowsOf } from './png-writer.js';

/** Changes along the rows above which a picture is noise, if there is more than one in so many samples. */
const NOISE = { changes: 65_536, samplesPerChange: 16 };

/** The index is the label; all labels are written. */
export function davis({ one, clip }: Settings): Encoder {
  if (!one) checkPath(clip);
  const stems = new Stems();
  return {
    add: (frame) => [
      {
        name: one ? 'davis.png' : `davis/Annotations/480p/${clip}/${stems.of(frame)}.png`,
        content: davisPng(frame.labels, frame.width, frame.height),
      },
    ],
    finish: () => (one ? [] : [{ name: 'davis/ImageSets/2017/val.txt', content: lines([clip]) }]),
  };
}

export function davisPng(labels: Uint8Array, width: number, height: number): Uint8Array<ArrayBuffer> {
  return png(width, height, labels, colourBytes(davisPalette()));
}

/** 255 where the label is. */
export function masks(): Encoder {
  const stems = new Stems();
  return {
    add(frame) {
      const { labels, width, height, masks } = frame;
      const stem = stems.of(frame);
      return masks.map(({ label }) => ({
        name: `masks/${label}/${stem}.png`,
        content: png(
          width,
          height,
          labels.map((value) => (value === label ? 255 : 0)),
        ),
      }));
    },
    finish: () => [],
  };
}

/** `samples` row by row: indices of a palette, or grey levels. */
function png(width: number, height: number, samples: Uint8Array, palette?: Uint8Array): Uint8Array<ArrayBuffer> {
  return pngFile(width, height, zlibSync(rowsOf(samples, width, height), { level: levelFor(samples) }), palette);
}

/**
 * The search for repetitions of level 9 takes twenty times as long in noise as that of level 6 and finds a twentieth more; masks
 * with borders that somebody drew or found are hardly slower for it, and a third smaller.
 */
function levelFor(samples: Uint8Array): 6 | 9 {
  let changes = 0;
  for (let at = 1; at < samples.length; at++) if (samples[at] !== samples[at - 1]) changes++;
  return changes > NOISE.changes && changes * NOISE.samplesPerChange > samples.length ? 6 : 9;
}
