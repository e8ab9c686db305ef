// One clip as a job: what it is called, where its result is, how it is done. The evidence of its pairs is kept until the clip is done:
// blocks of the clip write it beforehand, and a worker that takes over from another one continues at the last frame solved.

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

/** The folder of the evidence of pairs, until the clip is done: a file for each frame, named by its index. */
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

/** Does a clip unless it is done. Returns whether there was something to do, and how many frames were known or had to be solved. */
export async function performClip(segmenter, { job, folder, out, options }) {
  if (await clipResultOf(out, job)) return { did: false, known: 0, solved: 0 };
  const [place, names] = [clipPlaceOf(out, job), await framesOf(folder)];
  if (clipJobOf(await hashesOf(folder, names), options) !== job) throw new Error(`${folder} has changed since the job was made`);
  const pairs = (index) => join(pairsPlaceOf(out, job), String(index));
  let [solved, size] = [0, { width: 0, height: 0 }];
  try {
    const source = { length: names.length, read: async (index) => (size = await decodeImage(await readFile(join(folder, names[index])))) };
    const clip = segmenter.segmentClip(source, {
      ...options,
      // Pairs that are missing, damaged or of other frames are solved here.
      knownPairs: (index) => readFile(pairs(index)).catch(() => undefined),
      onPairs: async (index, bytes) => {
        solved += 1;
        await writeWhole(pairs(index), bytes);
      },
    });
    const images = {};
    for await (const { index, labels } of clip) {
      const image = await encodePng(size.width, size.height, labels, { palette: davisPalette() });
      const name = `${names[index]}.png`;
      await writeWhole(join(place, name), image);
      images[name] = sha256(image);
    }
    await writeWhole(join(place, 'clip.json'), recordOf(job, { frames: names, ...clip.tracks(), images }));
  } catch (error) {
    if (!FINAL.has(error.code)) throw error;
    await writeWhole(join(place, 'clip.json'), recordOf(job, { error: { code: error.code, message: error.message } }));
  }
  await rm(pairsPlaceOf(out, job), { recursive: true, force: true });
  return { did: true, known: names.length - solved, solved };
}
