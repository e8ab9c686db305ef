// How far a process of the program has come, so that a signal meets it at work.

import { existsSync } from 'node:fs';
import { setTimeout } from 'node:timers/promises';

/** Two frames as files: decoding them alone takes longer than a signal. */
export function largeFrames({ file }) {
  return ['texture', 'another texture'].map((text, k) => file(`large${k}.pgm`, Buffer.concat([Buffer.from('P5 4096 4096 255\n'), Buffer.alloc(4096 * 4096, text)])));
}

/**
 * `env` for a process that marks, in whichever thread it happens, that it has read a file, which it is to work on then; `seen(child)` waits
 * for the mark.
 */
export function markedReading({ file, path }, read) {
  const mark = path('read');
  const preload = file('mark.cjs', `
    const fs = require('fs'), { readFile } = fs.promises;
    fs.promises.readFile = async (path, ...rest) => {
      const bytes = await readFile(path, ...rest);
      if (path === ${JSON.stringify(read)}) fs.writeFileSync(${JSON.stringify(mark)}, '');
      return bytes;
    };
    require('module').syncBuiltinESMExports();`);
  return { env: { NODE_OPTIONS: `--require "${preload}"` }, seen: (child) => there(mark, child) };
}

/** Waits until a file is there, or the process is no more. */
export async function there(path, child) {
  while (!existsSync(path) && child.exitCode === null) await setTimeout(5);
}
