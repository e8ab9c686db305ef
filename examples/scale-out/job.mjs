// One job: what it is called, where its result is, how it is done. The same input and settings are the same job, so doing it
// twice changes nothing.

import { createHash, randomUUID } from 'node:crypto';
import { mkdir, readFile, rename, rm, writeFile } from 'node:fs/promises';
import { dirname, join } from 'node:path';
import { davisPalette, version } from 'veronese';
import { decodeImage, encodePng } from 'veronese/codecs';

export const QUEUE = 'veronese-pairs';

export const sha256 = (content) => createHash('sha256').update(content).digest('hex');

/** The name of a job: contents of the frames, settings, version. */
export function jobOf(hashes, options) {
  return `pair-${sha256(JSON.stringify({ software: `veronese ${version}`, options, hashes }))}`;
}

/** `OUT/ab/pair-ab….json` and `.png`: a folder holds a 256th of the results. */
export function placeOf(out, job) {
  const stem = join(out, job.slice(5, 7), job);
  return { json: `${stem}.json`, png: `${stem}.png` };
}

/**
 * The result of a job, or undefined where it is not done, or where its files are no longer what was written. The JSON is written
 * last: where it is, the PNG is too.
 */
export async function resultOf(out, job) {
  const place = placeOf(out, job);
  try {
    const text = await readFile(place.json, 'utf8');
    const { seal: _, ...sealed } = JSON.parse(text);
    if (text !== recordOf(job, sealed)) return undefined;
    const { image, ...report } = sealed;
    return image === undefined || sha256(await readFile(place.png)) === image ? report : undefined;
  } catch (error) {
    if (error.code === 'ENOENT' || error instanceof SyntaxError || error instanceof TypeError) return undefined;
    throw error;
  }
}

/** The text of a result, with a hash of job and text at its end. */
export function recordOf(job, content) {
  return JSON.stringify({ ...content, seal: sha256(job + JSON.stringify(content)) });
}

/** Errors that lie in the frames: another attempt would find the same, so they are the result. */
export const FINAL = new Set(['unreadable-image', 'frame-size-mismatch', 'frame-size-unsupported', 'too-few-frames', 'invalid-option']);

/** Does a job unless it is done. Returns whether there was something to do. */
export async function perform(segmenter, { job, first, second, out, options }) {
  if (await resultOf(out, job)) return false;
  const files = await Promise.all([first, second].map((path) => readFile(path)));
  if (jobOf(files.map(sha256), options) !== job) throw new Error(`${first} or ${second} has changed since the job was made`);
  const place = placeOf(out, job);
  try {
    const [one, two] = await Promise.all(files.map((file) => decodeImage(file)));
    const { labels, confidence: _, milliseconds: __, ...report } = await segmenter.segmentPair(one, two, options);
    const image = await encodePng(report.width, report.height, labels, { palette: davisPalette() });
    await writeWhole(place.png, image);
    await writeWhole(place.json, recordOf(job, { ...report, image: sha256(image) }));
  } catch (error) {
    if (!FINAL.has(error.code)) throw error;
    await writeWhole(place.json, recordOf(job, { error: { code: error.code, message: error.message } }));
  }
  return true;
}

/** Under another name first: a reader sees a whole file or none, whenever the writer ends. */
export async function writeWhole(path, content) {
  await mkdir(dirname(path), { recursive: true });
  const part = `${path}.${randomUUID()}.part`;
  try {
    await writeFile(part, content);
    await rename(part, path);
  } finally {
    await rm(part, { force: true });
  }
}
