// Boxes on a video that somebody else chose: the number of its frames is known before it is decoded, and its objects are followed in a
// process of its own.

import { execFile } from 'node:child_process';
import { mkdtemp, readFile, rm, writeFile } from 'node:fs/promises';
import { createRequire } from 'node:module';
import { tmpdir } from 'node:os';
import { dirname, join } from 'node:path';
import { promisify } from 'node:util';
import { encode, readAnnotations } from 'veronese/formats';
import { Refusal } from './http.mjs';

/** Most frames, and how long a clip may take, seconds: Label Studio itself gives up after 100. */
const FRAMES = 1000;
const SECONDS = 90;
/** Most pixels of a frame: 4K in every shape. */
const PIXELS = 4096 * 2304;
/** Containers. Other formats that ffmpeg knows are lists of files, and of this computer's as well. */
const CONTAINERS = 'mov,mp4,m4a,3gp,3g2,mj2,matroska,webm,avi,ogg,mpegts,mpeg,flv,asf';
/** Frames per second of a `<Video>` that does not say, and most frames of an answer: a configuration may say any rate. */
const USUAL = 24;
const LONGEST = 100_000;
/** Label Studio's player seeks a little beyond the border between two frames, seconds. */
const STEP = 0.002;

const program = join(dirname(createRequire(import.meta.url).resolve('veronese/package.json')), 'bin', 'veronese.js');

/** What `use` makes of a video's objects: the folder that `veronese clip` wrote, its `tracks.json`, frames per second. Nothing stays on the disk. */
export async function follow(bytes, use, signal, { frames = FRAMES, seconds = SECONDS } = {}) {
  const folder = await mkdtemp(join(tmpdir(), 'veronese-video-'));
  const limit = AbortSignal.timeout(seconds * 1000);
  try {
    const video = join(folder, 'video.mp4');
    await writeFile(video, bytes);
    const options = { signal: AbortSignal.any([signal, limit]), env: environment() };
    const { width, height, count, frameRate } = await probed(video, options);
    if (width * height > PIXELS) throw new Refusal(422, 'frame-size-unsupported', `frames of ${width}×${height} pixels are too large`);
    if (count > frames) throw new Refusal(422, 'too-many-frames', `the video has ${count} frames: this server takes ${frames} at most`);
    const out = join(folder, 'clip');
    await promisify(execFile)(process.execPath, [program, 'clip', video, '--out', out, '--quality', 'fast', '--jobs', '1'], options);
    return await use({ folder: out, tracks: JSON.parse(await readFile(join(out, 'tracks.json'), 'utf8')), frameRate });
  } catch (error) {
    signal.throwIfAborted();
    if (limit.aborted)
      throw new Refusal(
        422,
        'too-slow',
        `the video takes longer than ${seconds} s: import what 'veronese clip' and 'veronese convert' make of it`,
      );
    const [, code, sentence] = /^veronese: error: ([a-z-]+): (.*)$/m.exec(error.stderr) ?? [];
    throw code === undefined ? error : new Refusal(422, code, sentence.replaceAll(`${folder}/`, ''));
  } finally {
    await rm(folder, { recursive: true, force: true, maxRetries: 3 });
  }
}

/** Size, rate and number of frames, counted without decoding: a header may be wrong. */
async function probed(video, options) {
  const args = ['-v', 'error', '-protocol_whitelist', 'file', '-format_whitelist', CONTAINERS, '-select_streams', 'v:0', '-count_packets'];
  const wanted = ['-show_entries', 'stream=width,height,nb_read_packets,avg_frame_rate', '-of', 'json'];
  const { stdout } = await promisify(execFile)('ffprobe', [...args, ...wanted, `file:${video}`], options).catch((error) => {
    if (error.code === 'ENOENT')
      throw new Refusal(500, 'ffmpeg-missing', 'videos are read by the program ffmpeg, which this server cannot start');
    throw new Refusal(422, 'unreadable-video', 'the file is no video of a format that this server takes');
  });
  const [stream] = JSON.parse(stdout).streams ?? [];
  if (!(stream?.width > 0 && stream.height > 0)) throw new Refusal(422, 'unreadable-video', 'the file has no pictures');
  const [numerator, denominator = 1] = stream.avg_frame_rate.split('/').map(Number);
  return { width: stream.width, height: stream.height, count: Number(stream.nb_read_packets), frameRate: numerator / denominator || 25 };
}

/** The environment of programs that read a stranger's video: without the token. */
function environment() {
  const { LABEL_STUDIO_API_KEY: _, ...rest } = process.env;
  return rest;
}

/** `frameRate` of `<Video>`, a number or a key of the task's data, as Label Studio understands it. */
export function rateOf(text, data) {
  const rate = Number(text?.startsWith('$') ? data?.[text.slice(1)] : text);
  if (!(rate > 0 && rate < Infinity)) return USUAL;
  return rate < 1 ? 1 / rate : rate;
}

/**
 * A prediction of a clip's objects. Label Studio does not count the frames of the file: its frame L is what is on screen at
 * (L − 1) / `rate` seconds. Objects take the labels in order, and those that come after, the last one.
 */
export async function boxesOf({ folder, tracks: { frames, objects }, frameRate }, rate, { fromName, toName, labels, modelVersion }) {
  const length = Math.max(1, Math.round((frames.length / frameRate) * rate));
  if (length > LONGEST)
    throw new Refusal(422, 'invalid-input', `at ${rate} per second the video has ${length} frames: at most ${LONGEST} are possible`);
  const names = Object.fromEntries(objects.map(({ id }, index) => [id, labels[Math.min(index, labels.length - 1)]]));
  const metadata = { clip: 'video', names, labels: objects.map(({ id }) => id), frameRate: rate, fromName, toName, modelVersion };
  const [{ content }] = await encode('label-studio-video', shown(), metadata);
  const {
    predictions: [{ result }],
  } = JSON.parse(content);
  const sure = objects.flatMap((object) => object.frames.map(({ confidence }) => confidence));
  return { result, score: sure.reduce((sum, value) => sum + value, 0) / Math.max(1, sure.length) };

  async function* shown() {
    let [last, frame] = [-1];
    for (let index = 0; index < length; index++) {
      const now = Math.min(frames.length - 1, Math.floor((index / rate + STEP) * frameRate));
      if (now !== last) frame = await read(frames[now]);
      last = now;
      yield frame;
    }
  }

  async function read(name) {
    const bytes = await readFile(join(folder, 'labels', `${name}.png`));
    const found = readAnnotations([{ name: `${name}.png`, bytes }]).frames.get(name);
    return { labels: found.read(), width: found.width, height: found.height, image: name };
  }
}
