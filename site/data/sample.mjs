// The start page's lines of code, run while the site is made: their output is what they printed.

import { execFileSync } from 'node:child_process';
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import { join } from 'node:path';

const PAIR = fileURLToPath(new URL('../../www/public/samples/intel-two-cars/', import.meta.url));

/** Reads the two frames, as anything does that gives RGBA bytes: a canvas in a browser. */
const before = `import { decodeImage } from 'veronese/codecs';
import { readFile } from 'node:fs/promises';
const [first, second] = await Promise.all(['first.png', 'second.png'].map(async (name) => decodeImage(await readFile(name))));`;

const code = `import { segmentPair } from 'veronese';
const { motions, labels } = await segmentPair(first, second);
console.table(motions, ['group', 'pixels']);`;

export default function run() {
  // Below the project's folder, so that Node finds `veronese` in its node_modules.
  const folder = mkdtempSync(join(fileURLToPath(new URL('../../out/', import.meta.url)), 'sample-'));
  try {
    const file = join(folder, 'sample.mjs');
    writeFileSync(file, `${before}\n${code}`);
    return { code, output: execFileSync(process.execPath, [file], { cwd: PAIR, encoding: 'utf8' }).trim() };
  } finally {
    rmSync(folder, { recursive: true });
  }
}
