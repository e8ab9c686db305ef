// One clip as a job: what it is called, where its result is, how it is done. Solved pairs are files until the clip is done: blocks of the clip
// write them beforehand, and a worker that takes over from another one goes on after the last pair.

import { readFile, readdir, rm } from 'node:fs/promises';
import { join } from 'node:path';
import { davisPalette, version } from 'veronese';
import { decodeImage, encodePng } from 'veronese/codecs';
import { FINAL, recordOf, sha256, writeWhole } from './job.mjs';

/** The names of the frames in a folder, in order. */
export async function framesOf(folder) {
  return (await readdir(folder)).filter((name) => /\.(png|jpe?g|webp|bmp|p[bgpn]m)$/i.test(name)).sort();
}

/** Names and hashes of the contents of some frames. */
export async function hashesOf(folder, names) {
  const hashes = [];
  for (const name of names) hashes.push([name, sha256(await readFile(join(folder, name)))]);
  return hashes;
}

/** The name of a clip's job: names and contents of the frames, settings, version. */
export function clipJobOf(hashes, options) {
  return `clip-${sha256(JSON.stringify({ software: `veronese ${version}`, options, hashes }))}`;
}

/** `OUT/ab/clip-ab…`: the folder of a clip's result. */
export function clipPlaceOf(out, job) {
  return join(out, job.slice(5, 7), job);
}

/** The folder of solved pairs, until the clip is done. The file of a pair is named by the index of its second frame. */
export function pairsPlaceOf(out, job) {
  return join(clipPlaceOf(out, job), 'pairs');
}

/** The tracks that a job found, or undefined where it is not done, or where its files are no longer what was written. */
export async function clipResultOf(out, job) {
  const place = clipPlaceOf(out, job);
  try {
    const text = await readFile(join(place, 'clip.json'), 'utf8');
    const { seal: _, ...sealed } = JSON.parse(text);
    if (text !== recordOf(job, sealed)) return undefined;
    const { images = {}, ...result } = sealed;
    for (const [name, hash] of Object.entries(images)) {
      if (sha256(await readFile(join(place, name))) !== hash) return undefined;
    }
    return result;
  } catch (error) {
    if (error.code === 'ENOENT' || error instanceof SyntaxError || error instanceof TypeError) return undefined;
    throw error;
  }
}

/** The pairs of the frames `from` to `to` that nobody has solved. The clip itself checks the files. */
export async function missingPairs(out, job, { from, to }) {
  const files = new Set(await readdir(pairsPlaceOf(out, job)).catch(() => []));
  return Array.from({ length: to - from }, (_, k) => from + 1 + k).filter((index) => !files.has(String(index)));
}

/** Solves the pairs of the frames `from` to `to` that are missing, and writes each when it is solved. Returns how many there were. */
export async function solveMissing(segmenter, { job, folder, names, out, options }, { from, to }) {
  const missing = await missingPairs(out, job, { from, to });
  const read = async (index) => decodeImage(await readFile(join(folder, names[index])));
  let last = {};
  try {
    for (const index of missing) {
      const before = last.index === index - 1 ? last.frame : await read(index - 1);
      const frame = await read(index);
      await writeWhole(join(pairsPlaceOf(out, job), String(index)), await segmenter.solvePair(before, frame, options));
      last = { index, frame };
    }
  } catch (error) {
    // The clip itself ends at a frame that is no frame, and says so.
    if (!FINAL.has(error.code)) throw error;
  }
  return missing.length;
}

/** Does a clip unless it is done. Returns whether there was something to do, and how many of its pairs were known or had to be solved. */
export async function performClip(segmenter, { job, folder, out, options }) {
  if (await clipResultOf(out, job)) return { did: false, known: 0, solved: 0 };
  const [place, names] = [clipPlaceOf(out, job), await framesOf(folder)];
  if (clipJobOf(await hashesOf(folder, names), options) !== job) throw new Error(`${folder} has changed since the job was made`);
  const solved = await solveMissing(segmenter, { job, folder, names, out, options }, { from: 0, to: names.length - 1 });
  const clip = await segmenter.openClip(names.map((name) => join(folder, name)));
  try {
    // Pairs that are damaged or of other frames are solved here.
    const pairs = (index) => readFile(join(pairsPlaceOf(out, job), String(index))).catch(() => undefined);
    const images = {};
    for await (const { index, labels, width, height } of clip.segment({ ...options, pairs })) {
      const image = await encodePng(width, height, labels, { palette: davisPalette() });
      const name = `${names[index]}.png`;
      await writeWhole(join(place, name), image);
      images[name] = sha256(image);
    }
    await writeWhole(join(place, 'clip.json'), recordOf(job, { frames: names, ...(await clip.tracks()), images }));
  } catch (error) {
    if (!FINAL.has(error.code)) throw error;
    await writeWhole(join(place, 'clip.json'), recordOf(job, { error: { code: error.code, message: error.message } }));
  } finally {
    await clip.close();
  }
  await rm(pairsPlaceOf(out, job), { recursive: true, force: true });
  return { did: true, known: Math.max(0, names.length - 1 - solved), solved };
}
