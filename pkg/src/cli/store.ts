// Results of many pairs in one folder: a folder for each pair, which is there as a whole or not at all, and names its inputs.

import { renameSync, rmSync, statSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { version } from '../calls/version.js';
import { lookAt, makeFolder, type OutputFile, parsedJson, sha256, writing } from './files.js';
import { Output } from './output.js';
import { filesOfPair, isImageOfPair, RESULT } from './pair-folder.js';
import { type InputFile, jsonLine, type PairSettings, type Report } from './pair.js';

/** The content of a pair's result.json: the report without its times, since they differ between two runs, and what it was made from. */
export interface PairManifest extends Omit<Report, 'milliseconds'> {
  inputs: { name: string; sha256: string }[];
  /** Hash of everything that decides what the files hold. */
  job: string;
}

/** The hash of contents and settings that a result is recognised by. */
export function jobOf(inputs: readonly InputFile[], { options, grouped, overlay, maxSize }: PairSettings): string {
  const contents = inputs.map(({ bytes }) => sha256(bytes));
  return sha256(JSON.stringify({ software: `veronese ${version}`, options, grouped, overlay, maxSize, contents }));
}

/** The manifest in a pair's folder if it is of this job, and all images are there. */
export function finished(folder: string, job: string, { options, grouped, overlay }: PairSettings): PairManifest | undefined {
  const manifest = parsedJson(join(folder, RESULT)) as PairManifest | undefined;
  if (manifest?.job !== job) return undefined;
  const labels = manifest.motions.map(({ label, group }) => (grouped ? group : label));
  const files = filesOfPair(labels, { overlay, confidence: options.confidence });
  return files.every((name) => lookAt(join(folder, name))?.isFile()) ? manifest : undefined;
}

export function manifestFiles(report: Report, job: string, inputs: readonly InputFile[], images: readonly OutputFile[]): OutputFile[] {
  const { milliseconds: _, ...lasting } = report;
  const names = inputs.map(({ name, bytes }) => ({ name: name.split(/[\\/]/).at(-1) ?? name, sha256: sha256(bytes) }));
  const manifest: PairManifest = { ...lasting, inputs: names, job };
  return [...images, { name: RESULT, bytes: Buffer.from(jsonLine(manifest)) }];
}

/**
 * Writes a pair's folder. A new one gets its name when it is complete: it is there as a whole or not at all. Into one that is there,
 * perhaps with other people's files, the files go one by one, the report last. Either happens within one turn of the event loop, so a
 * signal comes before or after it.
 */
export async function writePair(out: Output, name: string, files: readonly OutputFile[], force: boolean): Promise<void> {
  const folder = join(out.folder, name);
  await writing(folder, () => {
    out.add([]);
    const part = join(out.begin(), name);
    const names = files.map(({ name }) => name);
    makeFolder(part);
    for (const { name, bytes } of files) writeFileSync(join(part, name), bytes);
    if (!statSync(folder, { throwIfNoEntry: false })) {
      const whole = new Output(part, { force });
      whole.add(names);
      whole.settle();
      try {
        return renameSync(part, folder);
      } catch (thrown) {
        // Another run has just given its folder this name.
        if (!['ENOTEMPTY', 'EEXIST'].includes(String((thrown as NodeJS.ErrnoException).code))) throw thrown;
      }
    }
    new Output(folder, { force }).place(part, names, isImageOfPair);
    rmSync(part, { recursive: true });
  });
}
