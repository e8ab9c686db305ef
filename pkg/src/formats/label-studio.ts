// A Label Studio task with predictions. A brush stroke is the mask as RGBA, every pixel four times its 0 or 255, packed as
// @thi.ng/rle-pack does. That library comes with three others and walks over each of the four bytes: ours goes from run to run.

import type { Encoder } from './frames.js';
import type { Mask } from './masks.js';
import type { Settings } from './metadata.js';
import { Outlines, points, type Ring } from './outline.js';
import { rowRuns } from './runs.js';

/** A task for each frame. */
export function labelStudio(file: string, shape: 'brush' | 'polygon') {
  return ({ tolerance, fromName = 'tag', toName = 'image', modelVersion }: Settings): Encoder => {
    const tasks: string[] = [];
    return {
      add(frame) {
        const { image, width, height, masks } = frame;
        const shared = { from_name: fromName, to_name: toName, original_width: width, original_height: height, image_rotation: 0 };
        const polygons = shape === 'polygon' ? new Outlines(tolerance).bridged(frame) : [];
        const result = masks.flatMap((mask, at): object[] => {
          const id = `motion-${mask.label}`;
          if (shape === 'brush') {
            const value = { format: 'rle', rle: packed(mask, width, height), brushlabels: [mask.name] };
            return [{ id, type: 'brushlabels', ...shared, value }];
          }
          return (polygons[at] as Ring[]).map((ring, part) => {
            const value = { points: percentages(ring, width, height), closed: true, polygonlabels: [mask.name] };
            return { id: `${id}-${part}`, type: 'polygonlabels', ...shared, value };
          });
        });
        // As text: the numbers of run lengths take several times as much memory.
        tasks.push(JSON.stringify({ data: { image }, predictions: [{ model_version: modelVersion, result }] }));
      },
      finish: () => [{ name: file, content: `[${tasks.join(',\n')}]\n` }],
    };
  };
}

function percentages(ring: Ring, width: number, height: number): [number, number][] {
  return points(ring).map(([x, y]) => [(100 * x) / width, (100 * y) / height]);
}

/** Bits of a run's length less one, by the two bits that choose; the ones Label Studio writes. */
const LENGTH_BITS = [3, 4, 8, 16];
const LONGEST = 1 << 16;

function packed(mask: Mask, width: number, height: number): number[] {
  const bytes: number[] = [];
  // Bits one after another from the highest of each byte.
  let free = 0;
  const write = (value: number, count: number) => {
    for (let bit = count - 1; bit >= 0; bit--) {
      if (free === 0) {
        bytes.push(0);
        free = 8;
      }
      (bytes[bytes.length - 1] as number) |= ((value >>> bit) & 1) << --free;
    }
  };
  write(width * height * 4, 32);
  write(8 - 1, 5);
  for (const length of LENGTH_BITS) write(length - 1, 4);
  for (const [at, length] of rowRuns(placed(mask, width, height)).entries()) {
    for (let left = length * 4; left > 0; left -= LONGEST) {
      const count = Math.min(left, LONGEST) - 1;
      const size = LENGTH_BITS.findIndex((length) => count < 1 << length);
      write(1, 1);
      write(size, 2);
      write(count, LENGTH_BITS[size] as number);
      write(at % 2 === 0 ? 0 : 255, 8);
    }
  }
  return bytes;
}

/** The mask in the whole image. */
function placed({ left, top, width, height, pixels }: Mask, imageWidth: number, imageHeight: number): Uint8Array {
  const all = new Uint8Array(imageWidth * imageHeight);
  for (let y = 0; y < height; y++) all.set(pixels.subarray(y * width, (y + 1) * width), (top + y) * imageWidth + left);
  return all;
}
