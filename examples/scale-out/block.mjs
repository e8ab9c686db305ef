// A block of a clip as a job: the pairs of some consecutive frames. What is solved follows from the two frames of a pair and the settings
// alone, so the clip's own job takes it as if it had solved the pair itself.

import { clipResultOf, framesOf, hashesOf, missingPairs, solveMissing } from './clip.mjs';
import { sha256 } from './job.mjs';

/** The name of a block's job: its clip, names and contents of its frames. */
export function blockJobOf(clip, hashes) {
  return `block-${sha256(JSON.stringify({ clip, hashes }))}`;
}

/** The blocks of which some pairs are missing, as the first and the last of their frames. Each has `size` pairs, and one frame more. */
export async function missingBlocks(out, clip, frames, size) {
  const blocks = [];
  for (let from = 0; from < frames - 1; from += size) blocks.push({ from, to: Math.min(from + size, frames - 1) });
  const missing = await Promise.all(blocks.map((block) => missingPairs(out, clip, block)));
  return blocks.filter((_, position) => missing[position].length > 0);
}

/** Solves the pairs of a block that are missing. Returns whether there were any, and how many were there already. */
export async function performBlock(segmenter, { job, clip, folder, from, to, out, options }) {
  if (await clipResultOf(out, clip)) return { did: false, known: to - from };
  const names = await framesOf(folder);
  if (blockJobOf(clip, await hashesOf(folder, names.slice(from, to + 1))) !== job)
    throw new Error(`${folder} has changed since the job was made`);
  const solved = await solveMissing(segmenter, { job: clip, folder, names, out, options }, { from, to });
  return { did: solved > 0, known: to - from - solved };
}
