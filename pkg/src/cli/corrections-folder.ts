// `veronese convert SOURCE --to corrections`: annotations, read back into a folder for `clip`.

import { join } from 'node:path';
import type { AnnotationFile } from '../../types/formats.js';
import { davisPng } from '../formats/pictures.js';
import { readAnnotations } from '../formats/reading/annotations.js';
import type { CorrectionsCommand } from './arguments.js';
import { EDITS } from './clip-corrections.js';
import { TRACKS, tracksOf } from './clip-folder.js';
import { entriesOf, isFolder, readInput } from './files.js';
import { readJson } from './label-files.js';
import type { Io } from './io.js';
import type { Output } from './output.js';
import { note } from './terminal.js';

/** Of files in a folder those that can be annotations, or name their classes. */
const POSSIBLE = /\.(json|xml|png|jpe?g|txt|ya?ml|names|labels|zip)$/i;
/** Of a JPEG the size alone is wanted, which is near its beginning, bytes. */
const HEAD = 2 ** 18;

/** Writes NAME.png for each frame that is annotated, and edits.json; returns one line of JSON. */
export async function convertBack({ source, clip, levels, firstFrame }: CorrectionsCommand, output: Output, io: Io): Promise<string> {
  output.check([EDITS]);
  const known = clip === undefined ? undefined : await framesOf(clip);
  const files: AnnotationFile[] = [];
  for (const path of pathsOf(source))
    files.push({ name: path.replaceAll('\\', '/'), bytes: await readInput(path, /\.jpe?g$/i.test(path) ? HEAD : undefined) });
  const {
    format,
    frames: annotated,
    names,
    boxes,
    size,
    notes,
  } = readAnnotations(files, { ...known, ...(levels !== undefined && { levels }), ...(firstFrame !== undefined && { firstFrame }) });
  for (const each of notes) note(io, each);
  const written = await output.stage(
    async (write) => {
      for (const [name, frame] of annotated) await write(`${name}.png`, davisPng(frame.read(), frame.width, frame.height));
      await write(EDITS, `${JSON.stringify({ names, ...(boxes.length > 0 && { prompts: boxes, size: [size.width, size.height] }) })}\n`);
    },
    (path) => /^[^/]+\.png$/.test(path),
  );
  return `${JSON.stringify({ version: 1, folder: output.folder, format, files: written, frames: annotated.size, ...(boxes.length > 0 && { boxes: boxes.length }), ...(notes.length > 0 && { notes }) })}\n`;
}

/** The names of a clip's frames, and their size. */
async function framesOf(folder: string): Promise<{ frames: string[]; size: { width: number; height: number } }> {
  const path = join(folder, TRACKS);
  const { frames, width, height } = tracksOf(await readJson(path), path);
  return { frames, size: { width, height } };
}

/** The file, or those in the folder and the folders in it, by name. */
function pathsOf(source: string): string[] {
  if (!isFolder(source)) return [source];
  return entriesOf(source)
    .filter(({ name }) => !name.startsWith('.'))
    .flatMap((entry) => {
      const path = join(source, entry.name);
      if (entry.isDirectory()) return pathsOf(path);
      return POSSIBLE.test(entry.name) ? [path] : [];
    });
}
