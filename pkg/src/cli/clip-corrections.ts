// A folder of corrections: NAME.png for some frames, edits.json for whole objects. Checked before anything is written.

import { readdirSync } from 'node:fs';
import { extname, join } from 'node:path';
import type { ClipCorrection, ClipEdits } from '../../types/index.js';
import { editsOf } from '../calls/clip/edits.js';
import { VeroneseError } from '../common/errors.js';
import type { ClipFrames } from './clip-frames.js';
import { readJson, readLabels } from './label-files.js';
import { sha256 } from './files.js';

export const EDITS = 'edits.json';

export interface Corrections {
  corrections: ClipCorrection[];
  edits: ClipEdits;
  /** The files of both. */
  paths: string[];
  /** Hash of both. */
  sha256: string;
}

/** Undefined if nothing is corrected. Throws an error that names the file. */
export async function readCorrections(folder: string, frames: ClipFrames): Promise<Corrections | undefined> {
  const names = namesIn(folder).sort();
  const corrections: ClipCorrection[] = [];
  for (const name of names.filter((name) => extname(name).toLowerCase() === '.png' && !name.startsWith('.'))) {
    const path = join(folder, name);
    const stem = name.slice(0, -extname(name).length);
    const frame = frames.files.findIndex((file) => file.stem === stem);
    if (frame < 0) throw new VeroneseError('invalid-input', `'${path}' has the name of no frame of the clip`);
    if (corrections.some((other) => other.frame === frame)) throw new VeroneseError('invalid-input', `'${path}' corrects a frame for the second time`);
    const { labels, width, height } = await readLabels(path, { foreign: true });
    const size = frames.size ?? (await frames.read(0));
    if (width !== size.width || height !== size.height) {
      throw new VeroneseError('frame-size-mismatch', `'${path}' has ${width}×${height} pixels, the frames have ${size.width}×${size.height}`);
    }
    corrections.push({ frame, labels });
  }
  corrections.sort((one, other) => one.frame - other.frame);
  const edits = names.includes(EDITS) ? await readEdits(join(folder, EDITS)) : {};
  if (corrections.length === 0 && Object.keys(edits).length === 0) return undefined;
  const hashes = corrections.map(({ frame, labels }) => [frame, sha256(labels)]);
  return { corrections, edits, paths: names.map((name) => join(folder, name)), sha256: sha256(JSON.stringify([hashes, edits])) };
}

function namesIn(folder: string): string[] {
  try {
    return readdirSync(folder);
  } catch (thrown) {
    const { code, message } = thrown as NodeJS.ErrnoException;
    if (code === 'ENOENT') throw new VeroneseError('file-not-found', `there is no folder '${folder}'`);
    if (code === 'ENOTDIR') throw new VeroneseError('unreadable-file', `'${folder}' is not a folder`);
    throw new VeroneseError('unreadable-file', `'${folder}' cannot be read: ${message}`);
  }
}

async function readEdits(path: string): Promise<ClipEdits> {
  const edits = await readJson(path);
  editsOf(edits, (reason) => new VeroneseError('invalid-input', `'${path}': ${reason}`));
  return edits as ClipEdits;
}
