// The program `veronese`: reads files, has the work done in a thread, writes files and one line of JSON.

import { version } from '../calls/version.js';
import { VeroneseError } from '../common/errors.js';
import { type ClipCommand, type Command, HELP, type PairCommand, parseCommand, type SequenceCommand } from './arguments.js';
import { batch } from './batch.js';
import { checkFolder } from './files.js';
import type { Io } from './io.js';
import { idsOf, Ledger } from './ledger.js';
import { Output } from './output.js';
import { isImageOfPair, possibleFiles } from './pair-folder.js';
import { jsonLine } from './pair.js';
import { complain, print, warn } from './terminal.js';
import { threads } from './threads.js';

const EXIT = { done: 0, failed: 1, usage: 2 } as const;

/** Returns the exit code; never rejects. */
export async function main(args: string[], io: Io): Promise<number> {
  let command: Command;
  try {
    const { command: asked, warnings } = parseCommand(args);
    warnings.forEach((sentence) => warn(io, sentence));
    command = asked;
  } catch (thrown) {
    complain(io, thrown);
    return EXIT.usage;
  }
  const output = new Output();
  io.signal.addEventListener('abort', () => {
    output.discard();
    complain(io, new VeroneseError('cancelled', 'stopped by a signal'));
  });
  try {
    if (command.name === 'batch' || command.name === 'video') await batch(command, io);
    else if (command.name === 'clip') await (await import('./clip.js')).clip(command, io);
    else await print(io, await answer(command, output));
    return EXIT.done;
  } catch (thrown) {
    complain(io, thrown);
    return EXIT.failed;
  }
}

async function answer(command: Exclude<Command, SequenceCommand | ClipCommand>, output: Output): Promise<string> {
  if (command.name === 'help') return HELP;
  if (command.name === 'version') return `veronese ${version}\n`;
  if (command.name === 'convert') return (await import('./convert.js')).convert(command, output);
  if (command.name === 'corrections') return (await import('./corrections-folder.js')).convertBack(command, output);
  if (command.name === 'pair') return pair(command, output);
  return jsonLine((await threads(1).run({ kind: 'points', file: command.file, options: command.options })).report);
}

async function pair({ first, second, out, ...settings }: PairCommand, output: Output): Promise<string> {
  const inputs = [first, second];
  if (out !== undefined) {
    checkFolder(out);
    await (await Ledger.open(out)).check(possibleFiles(settings), idsOf(inputs));
  }
  const frames = inputs.map((name) => ({ name }));
  const { report, files } = await threads(1).run({ kind: 'pair', frames, settings, withImages: out !== undefined });
  const json = jsonLine(report);
  if (out !== undefined) await output.write(out, [...files, { name: 'result.json', bytes: Buffer.from(json) }], isImageOfPair);
  return json;
}
