// Results of many pairs in one folder: a folder for each pair, which is there as a whole or not at all, and names its inputs.

import { readdirSync, renameSync, rmSync, statSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { version } from '../calls/version.js';
import { makeFolder, type OutputFile, readWritten, sha256, writing } from './files.js';
import { Manifest } from './manifest.js';
import { idsOf, Output } from './output.js';
import { filesOfPair, isImageOfPair, possibleFiles, RESULT } from './pair-folder.js';
import { type InputFile, jsonLine, type PairSettings, type Report } from './pair.js';

/** The entries of a pair's result.json besides the report; the report's times are left out, since they differ between two runs. */
export interface Record extends Omit<Report, 'milliseconds'> {
  inputs: { name: string; sha256: string }[];
  /** Hash of everything that decides what the files hold. */
  job: string;
}

/** The hash of contents and settings that a result is recognised by. */
export function jobOf(inputs: readonly InputFile[], { options, grouped, overlay, maxSize }: PairSettings): string {
  const contents = inputs.map(({ bytes }) => sha256(bytes));
  return sha256(JSON.stringify({ software: `veronese ${version}`, options, grouped, overlay, maxSize, contents }));
}

/** The record in a pair's folder if it is of this job, and it and its images are as they were written. */
export function finished(folder: string, job: string, { options, grouped, overlay }: PairSettings): Record | undefined {
  try {
    const record = JSON.parse(readWritten(join(folder, RESULT))?.toString() ?? '') as Record;
    if (record.job !== job) return undefined;
    const labels = record.motions.map(({ label, group }) => (grouped ? group : label));
    const manifest = new Manifest(folder, false);
    const isWhole = filesOfPair(labels, { overlay, confidence: options.confidence }).every((name) => manifest.isCurrent(name));
    return isWhole ? record : undefined;
  } catch {
    return undefined; // Not there, or not ours: to be done.
  }
}

export function recordFiles(report: Report, job: string, inputs: readonly InputFile[], images: readonly OutputFile[]): OutputFile[] {
  const { milliseconds: _, ...lasting } = report;
  const names = inputs.map(({ name, bytes }) => ({ name: name.split(/[\\/]/).at(-1) ?? name, sha256: sha256(bytes) }));
  const record: Record = { ...lasting, inputs: names, job };
  return [...images, { name: RESULT, bytes: Buffer.from(jsonLine(record)) }];
}

/**
 * Writes a pair's folder. A new one gets its name when it is complete: it is there as a whole or not at all. Into one that is there,
 * perhaps with other people's files, the files go one by one, the report last. Either happens within one turn of the event loop, so a
 * signal comes before or after it.
 */
export async function writePair(out: Output, name: string, files: readonly OutputFile[], force: boolean): Promise<void> {
  const folder = join(out.folder, name);
  await writing(folder, () => {
    const part = join(out.begin(), name);
    const hashes = new Map(files.map(({ name, bytes }) => [name, sha256(bytes)]));
    makeFolder(part);
    for (const { name, bytes } of files) writeFileSync(join(part, name), bytes);
    const replace = () => {
      new Output(folder, { force }).place(part, hashes, isImageOfPair);
      rmSync(part, { recursive: true });
    };
    if (statSync(folder, { throwIfNoEntry: false })) return replace();
    const manifest = new Manifest(part, false);
    manifest.add(hashes);
    manifest.settle();
    try {
      renameSync(part, folder);
    } catch (thrown) {
      // Another run has just given its folder this name: that one is there now.
      if (!['ENOTEMPTY', 'EEXIST'].includes(String((thrown as NodeJS.ErrnoException).code))) throw thrown;
      replace();
    }
  });
}

/** Throws `file-exists` where the folder of a pair that is `mine` has a file of another in a place that may be needed. */
export async function checkPairs(out: string, mine: (name: string) => boolean, settings: PairSettings & { force: boolean }, inputs: readonly string[]): Promise<void> {
  if (!statSync(out, { throwIfNoEntry: false })) return;
  const ids = idsOf(inputs);
  for (const entry of readdirSync(out, { withFileTypes: true })) {
    if (mine(entry.name) && entry.isDirectory()) await new Output(join(out, entry.name), settings).check(possibleFiles(settings), ids);
  }
}
