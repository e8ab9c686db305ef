// The command line's work, in a thread of its own so that Ctrl-C is heard at once.

import { parentPort, workerData } from 'node:worker_threads';
import type { MotionFit } from '../../types/index.js';
import { type ErrorMessage, errorMessage, VeroneseError } from '../common/errors.js';
import { api } from '../entries/codecs.js';
import { filesOf, type PairCommand, type PointsCommand, type WorkCommand } from './arguments.js';
import type { OutputFile } from './files.js';
import { jsonLine, segmentFiles } from './pair.js';

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
  const inputs = filesOf(command).map((name, index) => ({ name, bytes: contents[index] ?? new Uint8Array() }));
  const { report, images } = await segmentFiles(inputs, command, command.out !== undefined);
  const json = jsonLine(report);
  return { json, files: images.length > 0 ? [...images, { name: 'result.json', bytes: Buffer.from(json) }] : [] };
}

async function points({ file, options }: PointsCommand, [bytes]: Uint8Array[]): Promise<Outcome> {
  const { positions, derivatives } = parsedPoints(file, bytes ?? new Uint8Array());
  const fit: MotionFit = await api.fitMotions(
    { positions: flat(file, 'positions', positions, ['x', 'y']), derivatives: flat(file, 'derivatives', derivatives, ['Ix', 'Iy', 'It']) },
    options,
  );
  return { json: jsonLine({ ...fit, labels: Array.from(fit.labels) }), files: [] };
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

parentPort?.postMessage(await run(workerData as Work));
