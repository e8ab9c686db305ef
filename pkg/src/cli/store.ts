// Results of many pairs in one folder: a folder for each pair, which is there as a whole or not at all, and says what it was made of.

import { createHash } from 'node:crypto';
import { mkdirSync, readdirSync, readFileSync, renameSync, rmdirSync, rmSync, statSync, writeFileSync } from 'node:fs';
import { hostname } from 'node:os';
import { join } from 'node:path';
import { version } from '../calls/version.js';
import { OURS, type OutputFile, writeFailed } from './files.js';
import { type InputFile, jsonLine, type PairSettings, type Report } from './pair.js';

/** What a pair's result.json has besides the report; the report's times are left out, since they differ between two runs. */
export interface Record extends Omit<Report, 'milliseconds'> {
  inputs: { name: string; sha256: string }[];
  /** Names and hashes of the images beside result.json. */
  files: { [name: string]: string };
  /** Hash of everything that decides what the files hold, and of the rest of this record. */
  job: string;
}

const RESULT = 'result.json';

export const sha256 = (bytes: Uint8Array | string): string => createHash('sha256').update(bytes).digest('hex');

/** The hash of contents and settings that a result is recognised by. */
export function jobOf(inputs: readonly InputFile[], { options, grouped, overlay }: PairSettings): string {
  const contents = inputs.map(({ bytes }) => sha256(bytes));
  return sha256(JSON.stringify({ software: `veronese ${version}`, options, grouped, overlay, contents }));
}

/** The record in a pair's folder if it is of this job and nothing of it or of its files has changed. */
export function finished(folder: string, job: string): Record | undefined {
  try {
    const text = readFileSync(join(folder, RESULT), 'utf8');
    const { job: _, ...content } = JSON.parse(text) as Record;
    const record = sealed(content, job);
    if (jsonLine(record) !== text) return undefined;
    const whole = Object.entries(record.files).every(([name, hash]) => sha256(readFileSync(join(folder, name))) === hash);
    return whole ? record : undefined;
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

/** A mark of this machine, so that two of them may write into one shared folder. */
const HOST = sha256(hostname()).slice(0, 8);

/** What something is called while it is written. */
export const temporary = (name: string): string => `.${name}.${HOST}-${process.pid}.part`;

/** Writes a file, whole or not at all. Synchronous, so that no signal is handled in the middle. */
export function writeFile(folder: string, name: string, content: Uint8Array | string): void {
  const part = join(folder, temporary(name));
  try {
    writeFileSync(part, content);
    renameSync(part, join(folder, name));
  } catch (thrown) {
    rmSync(part, { force: true });
    throw thrown;
  }
}

/** Throws `write-failed` where `write` throws. */
export function writing(folder: string, write: () => void): void {
  try {
    write();
  } catch (thrown) {
    throw writeFailed(folder, thrown instanceof Error ? thrown.message : String(thrown));
  }
}

/**
 * Writes a pair's folder. All of it happens between two turns of the event loop, so a signal comes before or after it; and since
 * the folder gets its name when it is complete, so does the end of the process.
 */
export function writePair(out: string, name: string, files: readonly OutputFile[]): void {
  const part = join(out, temporary(name));
  const folder = join(out, name);
  try {
    rmSync(part, { recursive: true, force: true });
    mkdirSync(part, { recursive: true });
    for (const { name, bytes } of files) writeFileSync(join(part, name), bytes);
    if (statSync(folder, { throwIfNoEntry: false })) replaceFiles(part, folder, files);
    else renameSync(part, folder);
  } catch (thrown) {
    rmSync(part, { recursive: true, force: true });
    throw writeFailed(folder, thrown instanceof Error ? thrown.message : String(thrown));
  }
}

/** Into a folder that is there, perhaps with other people's files: without a result while it is mixed. */
function replaceFiles(part: string, folder: string, files: readonly OutputFile[]): void {
  rmSync(join(folder, RESULT), { force: true });
  const names = new Set(files.map(({ name }) => name));
  for (const name of readdirSync(folder)) if (OURS.test(name) && !names.has(name)) rmSync(join(folder, name));
  for (const { name } of files) renameSync(join(part, name), join(folder, name));
  rmdirSync(part);
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
