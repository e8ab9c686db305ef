// COCO's run lengths of one mask: column by column over the whole image.

import type { Mask } from './masks.js';
import { columnRuns } from './runs.js';

export interface CocoRle {
  size: [height: number, width: number];
  counts: string;
}

export function cocoRle(mask: Mask, { width, height }: { width: number; height: number }): CocoRle {
  return { size: [height, width], counts: compressed(columnRuns(mask, width, height)) };
}

/**
 * The ASCII form of maskApi.c: from the fourth count on the difference to the one two before, in groups of five bits from the
 * lowest; bit 5 says that more follow, and 48 is added to make a character. The last group's highest bit is the sign.
 */
export function compressed(counts: readonly number[]): string {
  const characters: string[] = [];
  counts.forEach((count, at) => {
    let value = at > 2 ? count - (counts[at - 2] as number) : count;
    for (let more = true; more;) {
      let group = value & 31;
      value >>= 5;
      more = group & 16 ? value !== -1 : value !== 0;
      if (more) group |= 32;
      characters.push(String.fromCharCode(group + 48));
    }
  });
  return characters.join('');
}
