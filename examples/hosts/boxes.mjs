// Boxes on a video, counted as Label Studio counts frames.

import { readFile } from 'node:fs/promises';
import { join } from 'node:path';
import { encode, readMask } from 'veronese/formats';
import { Refusal } from './http.mjs';

/** Frames per second of a `<Video>` that does not say. */
const USUAL = 24;
/** Most frames of an answer: a configuration may say any rate. */
const LONGEST = 100_000;

/** `frameRate` of `<Video>`, a number or a key of the task's data, as Label Studio understands it. */
export function rateOf(text, data) {
  const rate = Number(text?.startsWith('$') ? data?.[text.slice(1)] : text);
  if (!(rate > 0 && rate < Infinity)) return USUAL;
  return rate < 1 ? 1 / rate : rate;
}

/** Label Studio's player seeks a little beyond the border between two frames, seconds. */
const STEP = 0.002;

/**
 * A prediction of a clip's objects. Label Studio does not count the frames of the file: its frame L is what is on screen at
 * (L − 1) / `rate` seconds. Objects take the labels in order, and those that come after, the last one.
 */
export async function boxesOf({ folder, tracks, frameRate }, rate, { fromName, toName, labels, modelVersion }) {
  const length = Math.max(1, Math.round((tracks.frames.length / frameRate) * rate));
  if (length > LONGEST) {
    throw new Refusal(422, 'invalid-input', `at ${rate} per second the video has ${length} frames: at most ${LONGEST} are possible`);
  }
  const names = Object.fromEntries(tracks.objects.map(({ id }, index) => [id, labels[Math.min(index, labels.length - 1)]]));
  const metadata = { clip: 'video', names, labels: tracks.objects.map(({ id }) => id), frameRate: rate, fromName, toName, modelVersion };
  const [{ content }] = await encode('label-studio-video', shown(), metadata);
  return { result: JSON.parse(content)[0].predictions[0].result, score: scoreOf(tracks) };

  async function* shown() {
    let [last, frame] = [-1];
    for (let index = 0; index < length; index++) {
      const now = Math.min(tracks.frames.length - 1, Math.floor((index / rate + STEP) * frameRate));
      if (now !== last) frame = await read(tracks.frames[now]);
      last = now;
      yield frame;
    }
  }

  async function read(name) {
    return { ...readMask({ png: await readFile(join(folder, 'labels', `${name}.png`)) }), image: name };
  }
}

/** How sure the objects are on average, from 0 to 1. */
function scoreOf({ objects }) {
  const all = objects.flatMap(({ frames }) => frames.map(({ confidence }) => confidence));
  return all.reduce((sum, value) => sum + value, 0) / Math.max(1, all.length);
}
