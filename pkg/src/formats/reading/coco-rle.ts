// The ASCII form of COCO's run lengths, read: what `compressed` in ../coco-rle.ts writes.

import { invalidInput } from '../../common/checks.js';

/** Groups of five bits in the longest number that fits. */
const LONGEST = 6;

/** Throws `invalid-input`. Whether the counts are those of a mask is for others to see. */
export function decompressed(text: string): number[] {
  const counts: number[] = [];
  for (let at = 0; at < text.length;) {
    let value = 0;
    for (let group = 0; ; group++) {
      const bits = text.charCodeAt(at++) - 48;
      if (!(bits >= 0 && bits < 64) || group >= LONGEST) throw invalidInput('the text of run lengths is damaged');
      value |= (bits & 31) << (5 * group);
      if (bits & 32) continue;
      if (bits & 16) value |= -1 << (5 * (group + 1));
      break;
    }
    counts.push(counts.length > 2 ? value + (counts[counts.length - 2] as number) : value);
  }
  return counts;
}
