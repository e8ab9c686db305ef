// The thread of the command line: one piece of work at a time, from files to files; what a batch finished before is only read.

import { parentPort } from 'node:worker_threads';
import type { Reply, Request } from '../calls/messages.js';
import { errorMessage, VeroneseError } from '../common/errors.js';
import { api } from '../entries/codecs.js';
import type { PointsCommand } from './arguments.js';
import { type OutputFile, readInput } from './files.js';
import { type InputFile, type PairSettings, segmentFiles } from './pair.js';
import { finished, jobOf, manifestFiles } from './store.js';

export interface PairTask {
  kind: 'pair';
  /** First and second; a frame without bytes is a file to read. */
  frames: { name: string; bytes?: Uint8Array }[];
  settings: PairSettings;
  withImages: boolean;
  /** In a batch whose results are kept: where the pair's belong. */
  folder?: string;
}

export interface PointsTask extends Pick<PointsCommand, 'file' | 'options'> {
  kind: 'points';
}

export type Task = PairTask | PointsTask;

export interface TaskResult {
  /** False where the result was there already. */
  done: boolean;
  /** The printed line; without times where nothing was done. */
  report: object;
  /** To be written. */
  files: OutputFile[];
}

parentPort?.on('message', (request: Request<Task>) => void answer(request));

async function answer({ task, module }: Request<Task>): Promise<void> {
  const post = (reply: Reply<TaskResult>) => parentPort?.postMessage(reply);
  try {
    if (module) await api.init(module);
    post({ kind: 'done', result: task.kind === 'pair' ? await pair(task) : await points(task) });
  } catch (thrown) {
    post({ kind: 'failed', error: errorMessage(thrown) });
  }
}

async function pair({ frames, settings, withImages, folder }: PairTask): Promise<TaskResult> {
  const inputs: InputFile[] = [];
  for (const { name, bytes } of frames) inputs.push({ name, bytes: bytes ?? (await readInput(name)) });
  if (folder === undefined) {
    const { report, images } = await segmentFiles(inputs, settings, withImages);
    return { done: true, report, files: images };
  }
  const job = jobOf(inputs, settings);
  const manifest = finished(folder, job, settings);
  if (manifest) return { done: false, report: manifest, files: [] };
  const { report, images } = await segmentFiles(inputs, settings, withImages);
  return { done: true, report, files: manifestFiles(report, job, inputs, images) };
}

async function points({ file, options }: PointsTask): Promise<TaskResult> {
  const { positions, derivatives } = parsedPoints(file, await readInput(file));
  const fit = await api.fitMotions(
    { positions: flat(file, 'positions', positions, ['x', 'y']), derivatives: flat(file, 'derivatives', derivatives, ['Ix', 'Iy', 'It']) },
    options,
  );
  return { done: true, report: { ...fit, labels: Array.from(fit.labels) }, files: [] };
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
    values.set(row, index * entries.length);
  });
  return values;
}
