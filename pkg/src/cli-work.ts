// The command line's work, in a thread of its own so that Ctrl-C is heard at once.

import { parentPort, workerData } from 'node:worker_threads';
import type { Picture } from '../types/codecs.js';
import type { MotionFit, Segmentation } from '../types/index.js';
import { filesOf, type PairCommand, type PointsCommand, type WorkCommand } from './cli-arguments.js';
import type { OutputFile } from './cli-files.js';
import { api, decodeImage, encodeColourPng, encodeGreyPng, encodeIndexedPng } from './codecs.js';
import { type ErrorMessage, errorMessage, VeroneseError, veroneseError } from './errors.js';
import { groupLabels, maskOf, overlay } from './labels.js';
import { davisPalette } from './palette.js';

/** The command with the contents of its files, in the order of {@link filesOf}. */
export type Work = { command: WorkCommand; contents: Uint8Array[] };

export type Outcome = { json: string; files: OutputFile[] } | { error: ErrorMessage };

async function run({ command, contents }: Work): Promise<Outcome> {
  try {
    return command.name === 'pair' ? await pair(command, contents) : await points(command, contents);
  } catch (thrown) {
    return { error: errorMessage(thrown) };
  }
}

async function pair(command: PairCommand, contents: Uint8Array[]): Promise<Outcome> {
  const paths = filesOf(command);
  const pictures: Picture[] = [];
  for (const [index, bytes] of contents.entries()) pictures.push(await decoded(paths[index] ?? '', bytes));
  const [first, second, before] = pictures as [Picture, Picture, Picture | undefined];
  const segmentation = await api.segmentPair(first, second, { ...command.options, before });
  const { labels: _, confidence: __, ...report } = segmentation;
  const json = jsonLine(report);
  if (command.out === undefined) return { json, files: [] };
  return { json, files: [...(await images(command, segmentation, first)), { name: 'result.json', bytes: Buffer.from(json) }] };
}

async function images(command: PairCommand, segmentation: Segmentation, first: Picture): Promise<OutputFile[]> {
  const { width, height, motions } = segmentation;
  const labels = command.grouped ? groupLabels(segmentation) : segmentation.labels;
  const numbers = new Set(motions.map(({ label, group }) => (command.grouped ? group : label)));
  const files = [{ name: 'labels.png', bytes: await encodeIndexedPng(width, height, labels, davisPalette()) }];
  for (const number of numbers) {
    files.push({ name: `mask-${number}.png`, bytes: await encodeGreyPng(width, height, maskOf(labels, number)) });
  }
  if (segmentation.confidence) {
    files.push({ name: 'confidence.png', bytes: await encodeGreyPng(width, height, segmentation.confidence) });
  }
  if (command.overlay) {
    const rgb = overlay(first.data, labels);
    files.push({ name: 'overlay.png', bytes: await encodeColourPng(width, height, rgb) });
  }
  return files;
}

async function points({ file, options }: PointsCommand, [bytes]: Uint8Array[]): Promise<Outcome> {
  const { positions, derivatives } = parsedPoints(file, bytes ?? new Uint8Array());
  const fit: MotionFit = await api.fitMotions(
    { positions: flat(file, 'positions', positions, ['x', 'y']), derivatives: flat(file, 'derivatives', derivatives, ['Ix', 'Iy', 'It']) },
    options,
  );
  return { json: jsonLine({ ...fit, labels: Array.from(fit.labels) }), files: [] };
}

async function decoded(path: string, bytes: Uint8Array): Promise<Picture> {
  try {
    return await decodeImage(bytes);
  } catch (thrown) {
    const { code, message } = veroneseError(thrown);
    throw new VeroneseError(code, `${path}: ${message}`);
  }
}

function parsedPoints(file: string, bytes: Uint8Array): { positions?: unknown; derivatives?: unknown } {
  const text = new TextDecoder().decode(bytes);
  if (text.trim() === '') throw new VeroneseError('invalid-json', `${file} is empty`);
  let value: unknown;
  try {
    value = JSON.parse(text);
  } catch (thrown) {
    const reason = (thrown as Error).message.slice(0, 160);
    throw new VeroneseError('invalid-json', `${file} is not JSON (which has no NaN and no Infinity): ${reason}`);
  }
  if (typeof value === 'object' && value !== null && 'positions' in value && 'derivatives' in value) return value;
  throw new VeroneseError('invalid-input', `${file} must hold {"positions": [[x, y], ...], "derivatives": [[Ix, Iy, It], ...]}`);
}

/** Rows of numbers, one after another. */
function flat(file: string, name: string, rows: unknown, entries: readonly string[]): Float64Array {
  if (!Array.isArray(rows)) throw new VeroneseError('invalid-input', `${file}: "${name}" must be a list of rows`);
  const values = new Float64Array(rows.length * entries.length);
  rows.forEach((row: unknown, index) => {
    if (!Array.isArray(row) || row.length !== entries.length || !row.every((entry) => typeof entry === 'number')) {
      const wanted = `[${entries.join(', ')}], ${entries.length} numbers`;
      throw new VeroneseError('invalid-input', `${file}: row ${index} of "${name}" must be ${wanted}`);
    }
    values.set(row as number[], index * entries.length);
  });
  return values;
}

/** One line of JSON. What is no number in JSON would become null without a word: that is a mistake of ours. */
function jsonLine(report: object): string {
  const text = JSON.stringify(report, (key, value: unknown) => {
    if (typeof value !== 'number' || Number.isFinite(value)) return value;
    throw new VeroneseError('internal', `the result's '${key}' is ${value}`);
  });
  return `${text}\n`;
}

parentPort?.postMessage(await run(workerData as Work));
