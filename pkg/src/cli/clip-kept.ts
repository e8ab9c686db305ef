// The clip of an output folder: its journal, and beside it what the journal does not have: the frames and settings that it is of, and the
// annotations that it has. A journal of another clip, or one that cannot be read, is begun anew.

import { rmSync } from 'node:fs';
import { join } from 'node:path';
import type { Clip, ClipChange, Segmenter } from '../../types/index.js';
import { VeroneseError } from '../common/errors.js';
import { openFile } from '../entries/journal-file.js';
import { HIDDEN } from './clip-folder.js';
import type { ClipFrames } from './clip-frames.js';
import { lookAt, makeFolder, parsedJson, sha256, writeFailed, writing } from './files.js';
import type { Output } from './output.js';

const KEY = `${HIDDEN}/key`;
const LOG = `${HIDDEN}/log`;

/** The content of the file beside the journal. */
interface Key {
  /** Hash of the frames and the settings of the masks. */
  clip: string;
  /** Hash of the annotations, and of the clip with them. */
  annotated?: string;
  /** What they have changed. */
  changes?: readonly ClipChange[];
}

export type KeptClip = Awaited<ReturnType<typeof keptClip>>;

/** `settings`: what decides about the masks. */
export async function keptClip(segmenter: Segmenter, output: Output, frames: ClipFrames, settings: object, markUnknown: boolean) {
  const own: Key = { clip: sha256(JSON.stringify({ settings, frames: frames.files.map(({ sha256 }) => sha256) })) };
  const log = join(output.folder, LOG);
  await writing(output.folder, () => {
    output.add([HIDDEN]);
    makeFolder(join(output.folder, HIDDEN));
    // A link would lead elsewhere.
    if (lookAt(log)?.isFile() === false) rmSync(log);
  });
  const known = parsedJson(join(output.folder, KEY)) as Key | undefined;
  for (let isNew = known?.clip !== own.clip || !lookAt(log); ; isNew = true) {
    const journal = await openFile(log).catch((thrown: unknown) => {
      const isLocked = thrown instanceof VeroneseError && thrown.code === 'invalid-option';
      throw isLocked ? writeFailed(output.folder, 'another run is writing there') : thrown;
    });
    if (isNew) {
      await journal.replace(new Uint8Array());
      await write(output, own);
    }
    const clip = await segmenter.openClip(frames, { journal, markUnknown }).catch((thrown: unknown) => {
      if (isNew) throw thrown;
      return undefined;
    });
    rmSync(`${log}.damaged`, { force: true });
    const masks = clip?.frames.filter(({ hasMasks }) => hasMasks).length;
    if (clip && (masks === 0 || masks === frames.length)) return withKey(clip, output, isNew ? own : { ...own, ...known });
    // The range of a frame that could not be read.
    await clip?.close();
  }
}

function withKey(clip: Clip, output: Output, own: Key) {
  let key = own;
  const hash = (annotations: unknown) => sha256(JSON.stringify({ annotations, frames: clip.frames, objects: clip.objects }));
  return {
    clip,
    /** What these annotations have changed; undefined unless the clip has them, and no others. */
    changes: (annotations: unknown): readonly ClipChange[] | undefined =>
      key.annotated === hash(annotations) ? (key.changes ?? []) : undefined,
    /** The clip has these annotations now. */
    async annotated(annotations: unknown, changes: readonly ClipChange[]): Promise<void> {
      key = { ...key, annotated: hash(annotations), changes };
      await write(output, key);
    },
  };
}

/** Removes what is kept. */
export function clearKept(output: Output): Promise<void> {
  const names = [KEY, ...['', '.veronese-lock', '.new', '.damaged'].map((ending) => LOG + ending)];
  return writing(output.folder, () => names.forEach((name) => rmSync(join(output.folder, name), { force: true })));
}

function write(output: Output, key: Key): Promise<void> {
  return writing(output.folder, () => output.write(KEY, JSON.stringify(key), HIDDEN));
}
