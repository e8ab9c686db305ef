// `batch`: every pair of consecutive frames, by several threads, one line of JSON for each pair in their order.

import { existsSync } from 'node:fs';
import { basename, extname, join } from 'node:path';
import { errorMessage, VeroneseError } from '../common/errors.js';
import { inOrder } from '../calls/ordered.js';
import type { BatchCommand } from './arguments.js';
import { pairFolders } from './batch-folder.js';
import { findFrames, type Frame, leftOutNotes, readList, videoIn } from './frames.js';
import type { Io } from './io.js';
import { Output } from './output.js';
import { possibleFiles } from './pair-folder.js';
import { jsonLine, type Report } from './pair.js';
import { writePair } from './store.js';
import { complain, note, print, progressBar, type Tally } from './terminal.js';
import { threads } from './threads.js';
import { notesOnVideo, videoFrames, type VideoInfo } from './video.js';
import type { PairTask, TaskResult } from './work.js';

interface Pair {
  /** Position among all pairs, also those of other shards. */
  index: number;
  name: string;
  frames: [Frame, Frame];
}

/** Throws `pairs-failed` at the end where some did, or at once what concerns all pairs. */
export async function batch(command: BatchCommand, io: Io): Promise<void> {
  const { out, shard, jobs, force } = command;
  const output = out === undefined ? undefined : new Output(out, { force, signal: io.signal });
  const video = await videoIn(command);
  const paths = video === undefined ? findFrames(command.frames, await readList(command.list, io.stdin)) : undefined;
  if (paths) checkCount(Math.ceil(paths.length / command.every));
  if (output) checkPlaces(output, command, paths ?? []);

  const about: VideoInfo = { times: [] };
  const frames = video === undefined ? (paths ?? []).map((name) => ({ name })) : videoFrames({ ...command, file: video }, io, about);
  const pairs = pairsOf(frames, paths ? command.every : 1, command);
  const bar = progressBar(paths && count(Math.ceil(paths.length / command.every) - 1, shard), io.stderr);
  const tally: Tally = { done: 0, skipped: 0, failed: 0 };
  const failures: VeroneseError[] = [];
  const work = (pair: Pair) => perform(pair, command, output);
  try {
    for await (const { pair, result, error } of inOrder(pairs, work, { room: 2 * jobs, stop: () => undefined })) {
      const [first, second] = pair.frames.map(({ name }) => name);
      bar.clear();
      const line = { index: pair.index, name: pair.name, first, second };
      const named = (message: string) => `pair ${pair.index} (${first}, ${second}): ${message}`;
      if (result) {
        const { done, report } = result;
        // Why a pair has one motion is in its line: of many pairs that is nothing out of the ordinary.
        for (const { message } of ((report as Report).notes ?? []).filter(({ code }) => OF_FILES.includes(code)))
          note(io, { message: named(message) });
        tally[done ? 'done' : 'skipped'] += 1;
        await print(io, jsonLine({ ...line, status: done ? 'done' : 'skipped', ...report }));
      } else {
        const failure = errorMessage(error);
        tally.failed += 1;
        failures.push(new VeroneseError(failure.code, named(failure.message)));
        await print(io, jsonLine({ ...line, status: 'failed', error: failure }));
      }
      bar.update(tally);
    }
  } catch (thrown) {
    threads(jobs).close();
    throw thrown;
  } finally {
    output?.discard();
    bar.clear();
    for (const each of video === undefined ? leftOutNotes(command.frames) : notesOnVideo(video, about)) note(io, each);
    for (const failure of failures) complain(io, failure);
  }
  if (failures.length === 0) return;
  const all = tally.done + tally.skipped + tally.failed;
  throw new VeroneseError('pairs-failed', `${failures.length} of ${all} pairs failed, listed above`);
}

/** Throws `file-exists` where a file of another is in the way, in the folder or in that of a pair. */
function checkPlaces(output: Output, command: BatchCommand, paths: readonly string[]): void {
  output.check([]);
  for (const { index, name } of existsSync(output.folder) ? pairFolders(output.folder) : []) {
    if (ofShard(index, command.shard)) new Output(join(output.folder, name), command).check(possibleFiles(command), paths);
  }
  output.removeLeftovers();
}

/** Never rejects: one bad pair is not the end of the others. What it found is on the disk when it answers. */
async function perform(
  pair: Pair,
  command: BatchCommand,
  out: Output | undefined,
): Promise<{ pair: Pair; result?: TaskResult; error?: unknown }> {
  const { options, grouped, overlay, allowDamaged, maxSize, jobs, force } = command;
  try {
    const settings = { options, grouped, overlay, allowDamaged, maxSize };
    const task: PairTask = { kind: 'pair', frames: pair.frames, settings, withImages: out !== undefined };
    const result = await threads(jobs).run({ ...task, ...(out && { folder: join(out.folder, pair.name) }) });
    if (out && result.done) await writePair(out, pair.name, result.files, force);
    return { pair, result: { ...result, files: [] } };
  } catch (error) {
    return { pair, error };
  }
}

/** Pairs of consecutive frames that belong to the shard, out of every K-th frame. */
async function* pairsOf(
  frames: Iterable<Frame> | AsyncIterable<Frame>,
  every: number,
  { shard }: BatchCommand,
): AsyncGenerator<Pair, void, undefined> {
  let first: Frame | undefined;
  let [position, used] = [0, 0];
  for await (const second of frames) {
    if (position++ % every !== 0) continue;
    used += 1;
    if (first && ofShard(used - 2, shard)) {
      const index = used - 2;
      yield { index, name: nameOf(index, first), frames: [first, second] };
    }
    first = second;
  }
  checkCount(used);
}

function checkCount(frames: number): void {
  if (frames >= 2) return;
  throw new VeroneseError('too-few-frames', `a pair needs two frames, found ${frames === 0 ? 'none' : 'one'}`);
}

function ofShard(index: number, shard: BatchCommand['shard']): boolean {
  return index % shard.of === shard.index;
}

/** How many of the numbers from 0 belong to the shard. */
function count(pairs: number, { index, of }: BatchCommand['shard']): number {
  return Math.max(0, Math.ceil((pairs - index) / of));
}

/** Codes of notes on what was assumed of files. */
const OF_FILES = ['damaged-image', 'range-stretched'];
/** Characters of a frame's name in that of its pair: with what is added while a folder is written, file systems take it. */
const LONGEST_STEM = 200;

/** The pair's number, and its first frame for people who look for it. */
function nameOf(index: number, { name, stem = basename(name, extname(name)) }: Frame): string {
  return `${String(index).padStart(6, '0')}-${stem.slice(0, LONGEST_STEM).replace(/[^\w.-]/g, '_')}`;
}
