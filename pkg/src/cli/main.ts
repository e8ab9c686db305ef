// The program `veronese`: reads files, has the work done in a thread, writes files and one line of JSON.

import { Worker } from 'node:worker_threads';
import { version } from '../calls/version.js';
import { VeroneseError } from '../common/errors.js';
import { type ClipCommand, type Command, filesOf, HELP, parseCommand, type SequenceCommand } from './arguments.js';
import { batch } from './batch.js';
import { checkFolder, readInput } from './files.js';
import { idsOf, Ledger } from './ledger.js';
import { Output } from './output.js';
import { isImageOfPair, possibleFiles } from './pair-folder.js';
import { complain, print, warn } from './terminal.js';
import type { Outcome, Work } from './work.js';

const EXIT = { failed: 1, usage: 2, interrupted: 130, terminated: 143 } as const;

/** Sets the process's exit code; never rejects. */
export async function main(args: string[]): Promise<void> {
  let command: Command;
  try {
    const { command: asked, warnings } = parseCommand(args);
    warnings.forEach(warn);
    command = asked;
  } catch (thrown) {
    complain(thrown);
    process.exitCode = EXIT.usage;
    return;
  }
  // Every thread adds listeners of its own.
  process.stdout.setMaxListeners(0);
  process.stderr.setMaxListeners(0);
  const output = new Output();
  process.on('SIGINT', () => stop(output, EXIT.interrupted));
  process.on('SIGTERM', () => stop(output, EXIT.terminated));
  try {
    if (command.name === 'batch' || command.name === 'video') await batch(command);
    else if (command.name === 'clip') await (await import('./clip.js')).clip(command);
    else await print(await answer(command, output));
  } catch (thrown) {
    complain(thrown);
    process.exitCode = EXIT.failed;
  }
}

async function answer(command: Exclude<Command, SequenceCommand | ClipCommand>, output: Output): Promise<string> {
  if (command.name === 'help') return HELP;
  if (command.name === 'version') return `veronese ${version}\n`;
  if (command.name === 'convert') return (await import('./convert.js')).convert(command, output);
  if (command.name === 'corrections') return (await import('./corrections-folder.js')).convertBack(command, output);
  const folder = command.name === 'pair' ? command.out : undefined;
  if (command.name === 'pair' && folder !== undefined) {
    checkFolder(folder);
    await (await Ledger.open(folder)).check(possibleFiles(command), idsOf(filesOf(command)));
  }
  const contents: Uint8Array[] = [];
  for (const path of filesOf(command)) contents.push(await readInput(path));
  const { json, files } = await inThread({ command, contents });
  if (folder !== undefined) await output.write(folder, files, isImageOfPair);
  return json;
}

function inThread(work: Work): Promise<Exclude<Outcome, { error: unknown }>> {
  return new Promise((resolve, reject) => {
    const transferList = work.contents.map(({ buffer }) => buffer as ArrayBuffer);
    const worker = new Worker(new URL('./cli-work.js', import.meta.url), { workerData: work, transferList });
    worker.once('message', (outcome: Outcome) => {
      if ('error' in outcome) reject(new VeroneseError(outcome.error.code, outcome.error.message));
      else resolve(outcome);
    });
    worker.once('error', reject);
    worker.once('exit', (code) => reject(new VeroneseError('internal', `the work ended early (${code})`)));
  });
}

/** Ctrl-C: at once, and nothing half-written stays. */
function stop(output: Output, code: number): never {
  output.discard();
  complain(new VeroneseError('cancelled', 'stopped by a signal'));
  process.exit(code);
}
