// A block of a clip as a job: the pairs of some consecutive frames. The evidence of a pair follows from its two frames and the settings
// alone, so the clip's own job takes it as if it had solved the pair itself.

import { readFile, readdir } from 'node:fs/promises';
import { join } from 'node:path';
import { decodeImage } from 'veronese/codecs';
import { clipResultOf, framesOf, hashesOf, pairsPlaceOf } from './clip.mjs';
import { FINAL, sha256, writeWhole } from './job.mjs';

/** The name of a block's job: its clip, names and contents of its frames. */
export function blockJobOf(clip, hashes) {
  return `block-${sha256(JSON.stringify({ clip, hashes }))}`;
}

/**
 * The blocks of which some pairs are missing, as the first and the last of their frames. Each has `size` pairs, and one frame more;
 * pair k is that of frame k and the frame before.
 */
export async function missingBlocks(out, clip, frames, size) {
  const blocks = [];
  for (let from = 0; from < frames - 1; from += size) blocks.push({ from, to: Math.min(from + size, frames - 1) });
  const missing = await Promise.all(blocks.map((block) => missingPairs(out, clip, block)));
  return blocks.filter((_, position) => missing[position].size > 0);
}

/** The pairs of a block that nobody has solved. Whether files are what was written is left to the clip's job, which does not trust them. */
async function missingPairs(out, clip, { from, to }) {
  const files = new Set(await readdir(pairsPlaceOf(out, clip)).catch(() => []));
  const pairs = Array.from({ length: to - from }, (_, k) => from + 1 + k);
  return new Set(pairs.filter((pair) => !files.has(String(pair))));
}

/** Solves the pairs of a block that are missing. Returns whether there were any, and how many were there already. */
export async function performBlock(segmenter, { job, clip, folder, from, to, out, options }) {
  if (await clipResultOf(out, clip)) return { did: false, known: to - from };
  const names = (await framesOf(folder)).slice(from, to + 1);
  if (blockJobOf(clip, await hashesOf(folder, names)) !== job) throw new Error(`${folder} has changed since the job was made`);
  const missing = await missingPairs(out, clip, { from, to });
  const known = to - from - missing.size;
  if (missing.size === 0) return { did: false, known };
  const pairs = (index) => join(pairsPlaceOf(out, clip), String(index));
  const first = Math.min(...missing) - 1;
  const source = { length: to - first + 1, read: async (k) => decodeImage(await readFile(join(folder, names[first - from + k]))) };
  const ending = new AbortController();
  const clipOfBlock = segmenter.segmentClip(source, {
    ...options,
    signal: ending.signal,
    // The first frame has no pair in this block.
    knownPairs: (k) => (k === 0 ? undefined : readFile(pairs(first + k)).catch(() => undefined)),
    onPairs: async (k, bytes) => {
      if (k === 0) return;
      await writeWhole(pairs(first + k), bytes);
      missing.delete(first + k);
      // Objects and labels are for the clip's job.
      if (missing.size === 0) ending.abort();
    },
  });
  try {
    for await (const _ of clipOfBlock);
  } catch (error) {
    // Errors of the frames themselves are reported by the clip's job.
    if (!ending.signal.aborted && !FINAL.has(error.code)) throw error;
  }
  return { did: true, known };
}
