// COCO's run lengths of one mask, written and read: column by column over the whole image.

import { invalidInput } from '../common/checks.js';
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

/** Groups of five bits in the longest number that fits. */
const LONGEST = 6;

/** The counts in that form, or in a list. Throws `invalid-input`; whether they are those of a mask is for others to see. */
export function countsOf(counts: unknown): unknown[] {
  if (typeof counts === 'string') return decompressed(counts);
  if (Array.isArray(counts)) return counts;
  throw invalidInput('run lengths must be text or a list');
}

function decompressed(text: string): number[] {
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
