// The thread of `batch` and `video`: one pair at a time, from files to files; what was finished before is only read.

import { parentPort } from 'node:worker_threads';
import type { Reply, Request } from '../calls/messages.js';
import { errorMessage } from '../common/errors.js';
import { api } from '../entries/codecs.js';
import { type OutputFile, readInput } from './files.js';
import { type InputFile, type PairSettings, segmentFiles } from './pair.js';
import { finished, jobOf, recordFiles } from './store.js';

export interface BatchTask {
  /** First and second; a frame without bytes is a file to read. */
  frames: { name: string; bytes?: Uint8Array }[];
  settings: PairSettings;
  /** Where the pair's results belong, if they are kept. */
  folder: string | undefined;
}

export interface BatchResult {
  /** False where the result was there already. */
  done: boolean;
  /** The JSON of `pair`; without times where nothing was done. */
  report: object;
  /** To be written. */
  files: OutputFile[];
}

parentPort?.on('message', (request: Request<BatchTask>) => void answer(request));

async function answer({ task, module }: Request<BatchTask>): Promise<void> {
  const post = (reply: Reply<BatchResult>) => parentPort?.postMessage(reply);
  try {
    if (module) await api.init(module);
    post({ kind: 'done', result: await perform(task) });
  } catch (thrown) {
    post({ kind: 'failed', error: errorMessage(thrown) });
  }
}

async function perform({ frames, settings, folder }: BatchTask): Promise<BatchResult> {
  const inputs: InputFile[] = [];
  for (const { name, bytes } of frames) inputs.push({ name, bytes: bytes ?? (await readInput(name)) });
  if (folder === undefined) return { done: true, report: (await segmentFiles(inputs, settings, false)).report, files: [] };
  const job = jobOf(inputs, settings);
  const record = await finished(folder, job);
  if (record) return { done: false, report: record, files: [] };
  const { report, images } = await segmentFiles(inputs, settings, true);
  return { done: true, report, files: recordFiles(report, job, inputs, images) };
}
