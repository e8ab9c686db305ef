// A video that somebody else chose: what is in it is known before it is decoded, and its objects are followed in a process of its own.

import { execFile, spawn } from 'node:child_process';
import { mkdtemp, readFile, rm, writeFile } from 'node:fs/promises';
import { createRequire } from 'node:module';
import { tmpdir } from 'node:os';
import { dirname, join } from 'node:path';
import { promisify } from 'node:util';
import { Refusal } from './http.mjs';
import { PIXELS, checkSize } from './segment.mjs';

/** Most frames, and how long a clip may take, seconds: Label Studio itself gives up after 100. */
const FRAMES = 1000;
const SECONDS = 90;
/** A process that does not end when asked to is killed after so many milliseconds. */
const GRACE = 2000;
/** Containers. Other formats that ffmpeg knows are lists of files, and of this computer's as well. */
const CONTAINERS = 'mov,mp4,m4a,3gp,3g2,mj2,matroska,webm,avi,ogg,mpegts,mpeg,flv,asf';
/** Errors that are not the video's fault. */
const OURS = ['internal', 'worker-failed', 'wasm-load-failed', 'ffmpeg-missing', 'write-failed'];

const program = join(dirname(createRequire(import.meta.url).resolve('veronese/package.json')), 'bin', 'veronese.js');

/**
 * A function that follows the objects of a video by `veronese clip`, and gives what `use` makes of the result: the folder that
 * was written, the content of `tracks.json`, and the video's frames per second. Nothing stays on the disk.
 */
export function createFollow({ frames = FRAMES, seconds = SECONDS, pixels = PIXELS } = {}) {
  return async function follow(bytes, use, signal) {
    signal?.throwIfAborted();
    const folder = await mkdtemp(join(tmpdir(), 'veronese-video-'));
    const limit = new AbortController();
    const timer = setTimeout(() => limit.abort(tooLong(seconds)), seconds * 1000);
    const stop = () => limit.abort(signal.reason);
    signal?.addEventListener('abort', stop);
    try {
      const video = join(folder, 'video.mp4');
      await writeFile(video, bytes);
      const { width, height, count, frameRate } = await probed(video, limit.signal);
      checkSize({ width, height }, pixels);
      if (count > frames) throw new Refusal(422, 'too-many-frames', `the video has ${count} frames: this server takes ${frames} at most`);
      const out = join(folder, 'clip');
      await run(['clip', video, '--out', out, '--quality', 'fast', '--jobs', '1'], folder, limit.signal);
      const tracks = JSON.parse(await readFile(join(out, 'tracks.json'), 'utf8'));
      return await use({ folder: out, tracks, frameRate });
    } catch (error) {
      throw limit.signal.aborted ? limit.signal.reason : error;
    } finally {
      clearTimeout(timer);
      signal?.removeEventListener('abort', stop);
      await rm(folder, { recursive: true, force: true, maxRetries: 3 });
    }
  };
}

/** Size, rate and number of frames, counted without decoding: a header may be wrong. */
async function probed(video, signal) {
  const options = ['-v', 'error', '-protocol_whitelist', 'file', '-format_whitelist', CONTAINERS, '-select_streams', 'v:0', '-count_packets'];
  const wanted = ['-show_entries', 'stream=width,height,nb_read_packets,avg_frame_rate', '-of', 'json'];
  const { stdout } = await promisify(execFile)('ffprobe', [...options, ...wanted, `file:${video}`], { signal, env: environment() }).catch((error) => {
    if (error.code === 'ENOENT') throw new Refusal(500, 'ffmpeg-missing', 'videos are read by the program ffmpeg, which this server cannot start');
    throw new Refusal(422, 'unreadable-video', 'the file is no video of a format that this server takes');
  });
  const [stream] = JSON.parse(stdout).streams ?? [];
  const [numerator, denominator = 1] = String(stream?.avg_frame_rate).split('/').map(Number);
  const frameRate = numerator / denominator;
  if (!(stream?.width > 0 && stream.height > 0)) throw new Refusal(422, 'unreadable-video', 'the file has no pictures');
  return { width: stream.width, height: stream.height, count: Number(stream.nb_read_packets), frameRate: frameRate > 0 ? frameRate : 25 };
}

/** Runs `veronese` to its end; throws its error. */
function run(args, folder, signal) {
  return new Promise((resolve, reject) => {
    if (signal.aborted) return reject(signal.reason);
    const child = spawn(process.execPath, [program, ...args], { stdio: ['ignore', 'ignore', 'pipe'], env: environment() });
    let said = '';
    let kill;
    const stop = () => {
      child.kill();
      kill = setTimeout(() => child.kill('SIGKILL'), GRACE);
    };
    signal.addEventListener('abort', stop);
    child.stderr.setEncoding('utf8').on('data', (text) => (said = (said + text).slice(-4000)));
    child.once('error', reject);
    return child.once('close', (status) => {
      clearTimeout(kill);
      signal.removeEventListener('abort', stop);
      if (status === 0) resolve();
      else reject(problem(said, folder, status));
    });
  });
}

function problem(said, folder, status) {
  const [, code, sentence] = /^veronese: error: ([a-z-]+): (.*)$/m.exec(said) ?? [];
  if (code === undefined) return new Error(`veronese ended with ${status}: ${said}`);
  return new Refusal(OURS.includes(code) ? 500 : 422, code, sentence.replaceAll(`${folder}/`, ''));
}

function tooLong(seconds) {
  return new Refusal(422, 'too-slow', `the video takes longer than ${seconds} s: run 'veronese clip' and import what 'veronese convert' makes of it`);
}

/** The environment of programs that read a stranger's video: without the token. */
function environment() {
  const { LABEL_STUDIO_API_KEY: _, ...rest } = process.env;
  return rest;
}
