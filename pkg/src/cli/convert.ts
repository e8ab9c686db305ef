// `veronese convert`: the folders of `pair`, `batch` and `clip`, in the forms that annotation tools read.

import { type Stats, statSync } from 'node:fs';
import { join } from 'node:path';
import type { Note } from '../../types/index.js';
import { VeroneseError } from '../common/errors.js';
import type { ConvertCommand } from './arguments.js';
import { openBatch, pairFolders } from './batch-folder.js';
import { LABELS, openClip, TRACKS } from './clip-folder.js';
import { rateOf, USUAL_RATE } from '../formats/frames.js';
import { notFound, type OutputFile } from './files.js';
import { FORMATS, isFormatName, type Masks } from './formats.js';
import type { Io } from './io.js';
import type { Output } from './output.js';
import { readPair } from './pair-folder.js';
import { SEQUENCE_FORMATS } from './sequence-formats.js';
import { note } from './terminal.js';

/** Writes the files; returns one line of JSON that names them. */
export async function convert(command: ConvertCommand, output: Output, io: Io): Promise<string> {
  const kind = kindOf(command.folder);
  checkOptions(command, kind);
  const written = kind === 'pair' ? await convertPair(command, output) : await convertSequence(command, kind, output);
  for (const each of written.notes ?? []) note(io, each);
  return `${JSON.stringify({ version: 1, folder: output.folder, ...written })}\n`;
}

type Kind = 'pair' | 'batch' | 'clip';

interface Written {
  files: string[];
  frames?: number;
  notes?: Note[];
}

/** Which command the folder is of. Throws `file-not-found`. */
function kindOf(folder: string): Kind {
  const has = (name: string) => statusOf(join(folder, name));
  if (has(TRACKS)) return 'clip';
  if (has('result.json') || has('labels.png')) return 'pair';
  if (has(LABELS)?.isDirectory()) {
    throw new VeroneseError('invalid-input', `'${folder}' has no ${TRACKS}: the clip is not finished, run 'veronese clip' again to finish it`);
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
    if (isGiven && !kinds.includes(kind)) throw new VeroneseError('invalid-option', `option '--${name}' is not for '${folder}', a folder of '${kind}'`);
  }
  for (const name of to) {
    if (kind === 'batch' && SEQUENCE_FORMATS[name].tracks) {
      const sentence = `'${name}' holds tracks, and '${folder}' has none: a batch does not know an object again; use 'veronese clip'`;
      throw new VeroneseError('invalid-input', sentence);
    }
    if (kind === 'pair' && !isFormatName(name)) {
      throw new VeroneseError('invalid-input', `'${name}' is for many frames, and '${folder}' is a folder of 'pair'; use 'veronese clip'`);
    }
  }
}

async function convertPair(command: ConvertCommand, output: Output): Promise<Written> {
  const { folder, to, grouped, image, background, tolerance } = command;
  const { labels, width, height, motions, ...pair } = await readPair(folder, grouped);
  const names = pair.grouped && { names: Object.fromEntries(motions.map(({ label }) => [label, `group-${label}`])) };
  const wanted = motions.map(({ label }) => label).filter((label) => label > 0 || background);
  const masks: Masks = { labels, width, height, meta: { ...(image !== undefined && { image }), motions, labels: wanted, ...names } };
  const files: OutputFile[] = to.filter(isFormatName).flatMap((name) => FORMATS[name](masks, tolerance));
  await output.writeAll(files);
  return { files: files.map(({ name }) => name) };
}

async function convertSequence(command: ConvertCommand, kind: 'batch' | 'clip', output: Output): Promise<Written> {
  const { folder, to, range, background, grouped, frameRate, shapes = 'polygon', tolerance, video } = command;
  const sequence = kind === 'batch' ? openBatch(folder, range, background, grouped) : await openClip(folder, range, background, frameRate);
  // Names that depend on frames are checked when they are written.
  output.check(to.flatMap((name) => SEQUENCE_FORMATS[name].files));
  const settings = { shapes, tolerance, ...(video !== undefined && { video }) };
  const files = await output.stage(async (write) => {
    for (const name of to) await SEQUENCE_FORMATS[name].convert(sequence, settings, write);
  });
  const isAssumed = to.some((name) => SEQUENCE_FORMATS[name].timed) && rateOf(sequence.meta) === undefined;
  const message = `the frame rate of '${folder}' is not known: ${USUAL_RATE} frames per second are assumed; '--frame-rate' says another`;
  return { files, frames: sequence.count, ...(isAssumed && { notes: [{ code: 'frame-rate-assumed', message }] }) };
}
