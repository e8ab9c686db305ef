// `veronese convert`: the folders of `pair`, `batch` and `clip`, in the forms that annotation tools read.

import { type Stats, statSync } from 'node:fs';
import { join } from 'node:path';
import type { Note } from '../../types/index.js';
import { VeroneseError } from '../common/errors.js';
import type { ConvertCommand } from './arguments.js';
import { openBatch, pairFolders } from './batch-folder.js';
import { LABELS, openClip, TRACKS } from './clip-folder.js';
import type { LabelFrame, Metadata } from '../../types/formats.js';
import { FORMATS, FrameEncoder } from '../formats/encode.js';
import { rateOf, USUAL_RATE } from '../formats/metadata.js';
import { notFound } from './files.js';
import type { Io } from './io.js';
import type { Output } from './output.js';
import { readPair } from './pair-folder.js';
import { note } from './terminal.js';

/** Writes the files; returns one line of JSON that names them. */
export async function convert(command: ConvertCommand, output: Output, io: Io): Promise<string> {
  const { folder, to, tolerance, shapes, video } = command;
  const kind = kindOf(folder);
  checkOptions(command, kind);
  const { frames, metadata, count } = await opened(command, kind);
  // Names that depend on frames are checked when they are written.
  if (kind !== 'pair') output.check(to.flatMap((name) => FORMATS[name].files));
  const files = await output.stage(async (write) => {
    for (const name of to) {
      const clip = name === 'cvat-video' ? (video ?? metadata.clip) : metadata.clip;
      const encoder = new FrameEncoder(name, { ...metadata, clip, tolerance, shape: shapes }, kind === 'pair');
      // Each is written before the next is read: all of them can be larger than the memory.
      for await (const frame of frames) for (const file of encoder.add(frame)) await write(file.name, file.content);
      for (const file of encoder.finish()) await write(file.name, file.content);
    }
  });
  const isAssumed = kind === 'clip' && to.some((name) => FORMATS[name].timed) && rateOf(metadata) === undefined;
  const message = `the frame rate of '${folder}' is not known: ${USUAL_RATE} frames per second are assumed; '--frame-rate' says another`;
  const notes: Note[] = isAssumed ? [{ code: 'frame-rate-assumed', message }] : [];
  for (const each of notes) note(io, each);
  return `${JSON.stringify({ version: 1, folder: output.folder, files, ...(kind !== 'pair' && { frames: count }), ...(isAssumed && { notes }) })}\n`;
}

type Kind = 'pair' | 'batch' | 'clip';

interface Source {
  frames: Iterable<LabelFrame> | AsyncIterable<LabelFrame>;
  metadata: Metadata;
  count: number;
}

/** Which command the folder is of. Throws `file-not-found`. */
function kindOf(folder: string): Kind {
  const has = (name: string) => statusOf(join(folder, name));
  if (has(TRACKS)) return 'clip';
  if (has('result.json') || has('labels.png')) return 'pair';
  if (has(LABELS)?.isDirectory()) {
    throw new VeroneseError(
      'invalid-input',
      `'${folder}' has no ${TRACKS}: the clip is not finished, run 'veronese clip' again to finish it`,
    );
  }
  if (!has('.')) throw notFound(join(folder, '.'));
  if (has('.')?.isDirectory() && pairFolders(folder).length > 0) return 'batch';
  throw new VeroneseError('file-not-found', `'${folder}' is not a folder of pair, batch or clip: it has no labels.png and no ${TRACKS}`);
}

function statusOf(path: string): Stats | undefined {
  try {
    return statSync(path);
  } catch {
    return undefined; // Reading it gives the error.
  }
}

/** Throws where an option or a format is not for this kind of folder. */
function checkOptions(command: ConvertCommand, kind: Kind): void {
  const { folder, to, grouped, image, range, shapes, video, frameRate } = command;
  const given: [name: string, given: boolean, kinds: readonly Kind[]][] = [
    ['grouped', grouped, ['pair', 'batch']],
    ['image', image !== undefined, ['pair']],
    ['from', range.from > 0, ['batch', 'clip']],
    ['until', range.until !== undefined, ['batch', 'clip']],
    ['shapes', shapes !== undefined, ['clip']],
    ['video', video !== undefined, ['clip']],
    ['frame-rate', frameRate !== undefined, ['clip']],
  ];
  for (const [name, isGiven, kinds] of given) {
    if (isGiven && !kinds.includes(kind))
      throw new VeroneseError('invalid-option', `option '--${name}' is not for '${folder}', a folder of '${kind}'`);
  }
  const tracks = kind === 'batch' && to.find((name) => FORMATS[name].tracks);
  if (!tracks) return;
  const sentence = `'${tracks}' holds tracks, and '${folder}' has none: a batch does not know an object again; use 'veronese clip'`;
  throw new VeroneseError('invalid-input', sentence);
}

async function opened({ folder, range, background, grouped, image, frameRate }: ConvertCommand, kind: Kind): Promise<Source> {
  if (kind !== 'pair') {
    const sequence =
      kind === 'batch' ? openBatch(folder, range, background, grouped) : await openClip(folder, range, background, frameRate);
    return { frames: sequence, metadata: sequence.meta, count: sequence.count };
  }
  const { labels, width, height, motions, ...pair } = await readPair(folder, grouped);
  const names = pair.grouped && { names: Object.fromEntries(motions.map(({ label }) => [label, `group-${label}`])) };
  const wanted = motions.map(({ label }) => label).filter((label) => label > 0 || background);
  return {
    frames: [{ labels, width, height, motions, ...(image !== undefined && { image }) }],
    metadata: { labels: wanted, ...names },
    count: 1,
  };
}
