// Results of many pairs in one folder: a folder for each pair, which is there as a whole or not at all, and says what it was made of.

import { readdirSync, renameSync, rmSync, statSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { version } from '../calls/version.js';
import { makeFolder, type OutputFile, readWritten, sha256, writing } from './files.js';
import { enter, HOST, idsOf, isUnchanged, Ledger, temporary } from './ledger.js';
import { isImageOfPair, possibleFiles, RESULT } from './pair-folder.js';
import { type InputFile, jsonLine, type PairSettings, type Report } from './pair.js';

/** What a pair's result.json has besides the report; the report's times are left out, since they differ between two runs. */
export interface Record extends Omit<Report, 'milliseconds'> {
  inputs: { name: string; sha256: string }[];
  /** Names and hashes of the images beside result.json. */
  files: { [name: string]: string };
  /** Hash of everything that decides what the files hold, and of the rest of this record. */
  job: string;
}

/** The hash of contents and settings that a result is recognised by. */
export function jobOf(inputs: readonly InputFile[], { options, grouped, overlay }: PairSettings): string {
  const contents = inputs.map(({ bytes }) => sha256(bytes));
  return sha256(JSON.stringify({ software: `veronese ${version}`, options, grouped, overlay, contents }));
}

/** The record in a pair's folder if it is of this job and nothing of it or of its files has changed. */
export async function finished(folder: string, job: string): Promise<Record | undefined> {
  try {
    const text = readWritten(join(folder, RESULT))?.toString() ?? '';
    const { job: _, ...content } = JSON.parse(text) as Record;
    const record = sealed(content, job);
    if (jsonLine(record) !== text) return undefined;
    for (const [name, hash] of Object.entries(record.files)) if (!(await isUnchanged(join(folder, name), hash))) return undefined;
    return record;
  } catch {
    return undefined; // Not there, or not ours: to be done.
  }
}

/** The text of a record tells by itself whether it is still what was written. */
function sealed(content: Omit<Record, 'job'>, job: string): Record {
  return { ...content, job: sha256(job + jsonLine(content)) };
}

export function recordFiles(report: Report, job: string, inputs: readonly InputFile[], images: readonly OutputFile[]): OutputFile[] {
  const { milliseconds: _, ...lasting } = report;
  const content = {
    ...lasting,
    inputs: inputs.map(({ name, bytes }) => ({ name: name.split(/[\\/]/).at(-1) ?? name, sha256: sha256(bytes) })),
    files: Object.fromEntries(images.map(({ name, bytes }) => [name, sha256(bytes)])),
  };
  return [...images, { name: RESULT, bytes: Buffer.from(jsonLine(sealed(content, job))) }];
}

/**
 * Writes a pair's folder. A new one gets its name when it is complete: it is there as a whole or not at all. Into one that is there,
 * perhaps with other people's files, the files go one by one, the report last. Either happens between two turns of the event loop, so a
 * signal comes before or after it.
 */
export async function writePair(out: string, name: string, files: readonly OutputFile[]): Promise<void> {
  const [part, folder] = [join(out, temporary(name)), join(out, name)];
  const hashes = new Map(files.map(({ name, bytes }) => [name, sha256(bytes)]));
  const write = async (): Promise<void> => {
    const there = statSync(folder, { throwIfNoEntry: false });
    const replace = there && (await (await Ledger.open(folder)).replacing(hashes.keys(), isImageOfPair));
    try {
      rmSync(part, { recursive: true, force: true });
      makeFolder(part);
      for (const { name, bytes } of files) writeFileSync(join(part, name), bytes);
      if (replace) return replace(part, hashes);
      enter(part, hashes);
      renameSync(part, folder);
    } finally {
      rmSync(part, { recursive: true, force: true });
    }
  };
  await writing(folder, () =>
    write().catch((thrown: NodeJS.ErrnoException) => {
      // Another run has just given its folder this name: that one is there now.
      if (thrown.code === 'ENOTEMPTY' || thrown.code === 'EEXIST') return write();
      throw thrown;
    }),
  );
}

/** Throws `file-exists` where the folder of a pair that is `mine` has a file of another in a place that may be needed. */
export async function checkPairs(out: string, mine: (name: string) => boolean, settings: PairSettings, inputs: readonly string[]): Promise<void> {
  if (!statSync(out, { throwIfNoEntry: false })) return;
  const ids = idsOf(inputs);
  for (const entry of readdirSync(out, { withFileTypes: true })) {
    if (!mine(entry.name) || !entry.isDirectory()) continue;
    await (await Ledger.open(join(out, entry.name))).check(possibleFiles(settings), ids);
  }
}

/** Writing one pair takes milliseconds: whatever is older than this, milliseconds, was left, though its number be taken again. */
const LONGEST_WRITE = 600_000;

/**
 * Removes what a run that was killed left behind. Only leftovers of pairs that are `mine` are touched, because another part of
 * the work may be under way on another machine, and none of a process that still runs here.
 */
export function removeLeftovers(out: string, mine: (name: string) => boolean): void {
  let names: string[];
  try {
    names = readdirSync(out);
  } catch {
    return; // Nothing there yet.
  }
  for (const entry of names) {
    const [, name, host, pid] = /^\.(.+)\.([0-9a-f]{8})-(\d+)\.part$/.exec(entry) ?? [];
    if (name === undefined || !mine(name)) continue;
    const age = Date.now() - (statSync(join(out, entry), { throwIfNoEntry: false })?.mtimeMs ?? 0);
    if (host === HOST && Number(pid) !== process.pid && alive(Number(pid)) && age < LONGEST_WRITE) continue;
    rmSync(join(out, entry), { recursive: true, force: true });
  }
}

function alive(pid: number): boolean {
  try {
    process.kill(pid, 0);
    return true;
  } catch (thrown) {
    return (thrown as NodeJS.ErrnoException).code === 'EPERM';
  }
}
