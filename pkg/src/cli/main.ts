// The program `veronese`: reads files, has the work done in a thread, writes files and one line of JSON.

import { resolve } from 'node:path';
import { version } from '../calls/version.js';
import { VeroneseError } from '../common/errors.js';
import { type BatchCommand, type ClipCommand, type Command, type PairCommand, parseCommand } from './arguments.js';
import type { Io } from './io.js';
import { Output } from './output.js';
import { isImageOfPair, possibleFiles, RESULT } from './pair-folder.js';
import { jsonLine, type Report } from './pair.js';
import { ClosedPipe, complain, heading, note, print } from './terminal.js';
import { threads } from './threads.js';

const EXIT = { done: 0, failed: 1, usage: 2 } as const;

/** Returns the exit code; never rejects. */
export async function main(args: string[], io: Io): Promise<number> {
  let command: Command;
  try {
    command = parseCommand(args);
    io.stderr.quiet = command.quiet === true;
  } catch (thrown) {
    complain(io, thrown);
    return EXIT.usage;
  }
  io.signal.addEventListener('abort', () => complain(io, new VeroneseError('cancelled', 'stopped by a signal')));
  try {
    if (command.name === 'batch') await (await import('./batch.js')).batch(command, io);
    else if (command.name === 'clip') await (await import('./clip.js')).clip(command, io);
    else await print(io, await answer(command, io));
    return EXIT.done;
  } catch (thrown) {
    if (thrown instanceof ClosedPipe) return EXIT.done;
    complain(io, thrown);
    return EXIT.failed;
  }
}

async function answer(command: Exclude<Command, BatchCommand | ClipCommand>, io: Io): Promise<string> {
  const outputIn = (folder: string, { force }: { force: boolean }, isInput = false) =>
    new Output(folder, { force, isInput, signal: io.signal });
  if (command.name === 'help') return (await import('./help.js')).help(command.topic, heading(io));
  if (command.name === 'version') return `veronese ${version}\n`;
  if (command.name === 'convert') {
    const folder = command.out ?? command.folder;
    return (await import('./convert.js')).convert(command, outputIn(folder, command, resolve(folder) === resolve(command.folder)), io);
  }
  if (command.name === 'corrections')
    return (await import('./corrections-folder.js')).convertBack(command, outputIn(command.out, command), io);
  if (command.name === 'pair') return pair(command, command.out === undefined ? undefined : outputIn(command.out, command), io);
  return jsonLine((await threads(1).run({ kind: 'points', file: command.file, options: command.options })).report);
}

async function pair({ first, second, ...settings }: PairCommand, output: Output | undefined, io: Io): Promise<string> {
  const inputs = [first, second];
  output?.check(possibleFiles(settings), inputs);
  const frames = inputs.map((name) => ({ name }));
  const { report, files } = await threads(1).run({ kind: 'pair', frames, settings, withImages: output !== undefined });
  for (const each of (report as Report).notes ?? []) note(io, each);
  const json = jsonLine(report);
  await output?.writeAll([...files, { name: RESULT, bytes: Buffer.from(json) }], isImageOfPair);
  return json;
}
