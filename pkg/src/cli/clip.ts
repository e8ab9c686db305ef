// `clip`: writes the labels of each frame, prints a line of JSON for each, and writes the tracks at the end.

import { basename, extname } from 'node:path';
import type { Picture } from '../../types/codecs.js';
import { overlay } from '../calls/labels.js';
import { version } from '../calls/version.js';
import { VeroneseError } from '../common/errors.js';
import { davisPalette } from '../common/palette.js';
import { encodeColourPng, encodeIndexedPng } from '../entries/codecs.js';
import { Segmenter } from '../entries/node.js';
import type { ClipCommand } from './arguments.js';
import { ClipStore, type FrameFile, type Record } from './clip-store.js';
import { checkFolder, readInput } from './files.js';
import { findFrames, type Frame, isVideo } from './frames.js';
import { decoded, jsonLine } from './pair.js';
import { sha256 } from './store.js';
import { print, ProgressBar } from './terminal.js';
import { videoFrames } from './video.js';

/** A frame of the clip with the name of its results. */
type Named = Frame & { stem: string };

/** A frame that was read. It has its pixels until its labels are written. */
type Taken = FrameFile & { width: number; height: number; picture?: Picture | undefined };

/** If a frame is bad, writes the labels of the frames before it and throws. */
export async function clip(command: ClipCommand): Promise<void> {
  const { out, options, every, overlay: wanted } = command;
  checkFolder(out);
  const { frames, count } = framesOf(command);
  const store = new ClipStore(out, { ...options, every, overlay: wanted, software: `veronese ${version}` });
  const record = await store.finished(() => contents(frames()));
  if (record) return report(record);

  store.begin();
  const taken: Taken[] = [];
  const segmenter = new Segmenter();
  const bar = new ProgressBar(count, undefined, undefined, 'frames');
  try {
    const segmented = segmenter.segmentClip(pictures(frames(), taken), options);
    for await (const { index, labels, objects } of segmented) {
      const frame = taken[index] as Taken;
      store.write(frame.stem, await images(frame.picture as Picture, labels, wanted));
      frame.picture = undefined;
      bar.clear();
      await print(jsonLine({ frame: index, name: frame.stem, objects: objects.map(({ id }) => id) }));
      bar.update({ done: index + 1, skipped: 0, failed: 0 });
    }
    const tracks = segmented.tracks();
    store.end(taken, tracks);
    bar.clear();
    if (tracks.dropped > 0) warn(tracks.dropped);
    await print(lastLine(tracks.objects));
  } finally {
    bar.clear();
    segmenter.close();
  }
}

/** Reads the frames on each call; `count` is their number, if known in advance. */
function framesOf({ frames: names, list, every }: ClipCommand): { frames: () => Iterable<Named> | AsyncIterable<Named>; count: number | undefined } {
  const [name = ''] = names;
  if (names.length === 1 && list === undefined && isVideo(name)) return { frames: () => ofVideo(name, every), count: undefined };
  const paths = findFrames(names, list).filter((_, index) => index % every === 0);
  checkCount(paths.length);
  const frames = paths.map((path) => ({ name: path, stem: basename(path, extname(path)) }));
  const stems = new Map<string, string>();
  for (const { name, stem } of frames) {
    const other = stems.get(stem.toLowerCase());
    if (other !== undefined) throw new VeroneseError('invalid-input', `'${other}' and '${name}' would both be written to '${stem}.png'`);
    stems.set(stem.toLowerCase(), name);
  }
  return { frames: () => frames, count: frames.length };
}

/** Frames of a video. Throws before the first frame if there is only one. */
async function* ofVideo(file: string, every: number): AsyncGenerator<Named, void, undefined> {
  let last: Named | undefined;
  let count = 0;
  for await (const frame of videoFrames(file, every)) {
    if (last) yield last;
    last = { ...frame, stem: String(frame.number).padStart(5, '0') };
    count += 1;
  }
  checkCount(count);
  if (last) yield last;
}

function checkCount(frames: number): void {
  if (frames >= 2) return;
  throw new VeroneseError('too-few-frames', `a clip needs two frames, found ${frames === 0 ? 'none' : 'one'}`);
}

/** Names and contents. */
async function contents(frames: Iterable<Named> | AsyncIterable<Named>): Promise<FrameFile[]> {
  const files: FrameFile[] = [];
  for await (const { name, stem, bytes } of frames) {
    files.push({ stem, file: basename(name), sha256: sha256(bytes ?? (await readInput(name))) });
  }
  return files;
}

/** Reads and decodes; errors name the frame. */
async function* pictures(frames: Iterable<Named> | AsyncIterable<Named>, taken: Taken[]): AsyncGenerator<Picture, void, undefined> {
  let first: { name: string; width: number; height: number } | undefined;
  for await (const { name, stem, bytes } of frames) {
    const input = { name, bytes: bytes ?? (await readInput(name)) };
    const picture = await decoded(input);
    const { width, height } = picture;
    first ??= { name, width, height };
    if (width !== first.width || height !== first.height) {
      const sizes = `${width}×${height} pixels, ${first.name} has ${first.width}×${first.height}`;
      throw new VeroneseError('frame-size-mismatch', `${name} has ${sizes}`);
    }
    taken.push({ stem, file: basename(name), sha256: sha256(input.bytes), width, height, picture });
    yield picture;
  }
}

async function images({ data, width, height }: Picture, labels: Uint8Array, withOverlay: boolean): Promise<{ [folder: string]: Uint8Array }> {
  const files = { labels: await encodeIndexedPng(width, height, labels, davisPalette()) };
  return withOverlay ? { ...files, overlay: await encodeColourPng(width, height, overlay(data, labels)) } : files;
}

function warn(dropped: number): void {
  process.stderr.write(`veronese: warning: ${dropped} more objects were seen when all 254 numbers had been given; they count as background\n`);
}

/** Prints what the run that wrote the record printed. */
async function report({ frames, objects }: Record): Promise<void> {
  for (const [frame, name] of frames.entries()) {
    const seen = objects.filter((object) => object.frames.some((entry) => entry.frame === frame));
    await print(jsonLine({ frame, name, objects: seen.map(({ id }) => id) }));
  }
  await print(lastLine(objects));
}

function lastLine(objects: Record['objects']): string {
  return jsonLine({ done: true, objects: objects.length });
}
