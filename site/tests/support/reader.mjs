// A reader's folder: the package packed and installed by npm, and the frames of which the guide speaks.

import { cpSync, mkdirSync, mkdtempSync, rmSync, symlinkSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';

import { install } from '../../../pkg/test/packed/packed.mjs';
import { root } from '../../../scripts/lib/project.mjs';

const SAMPLES = join(root, 'www/public/samples');

/** The package, installed once for all pages. */
let installed;

/** Makes it, and removes it after the test. */
export function readersFolder(t) {
  const folder = mkdtempSync(join(tmpdir(), 'veronese-guide-'));
  t.after(() => rmSync(folder, { recursive: true, force: true }));
  if (!installed) {
    installed = install();
    process.once('exit', () => installed.remove());
  }
  cpSync(join(installed.app, 'node_modules/veronese'), join(folder, 'node_modules/veronese'), { recursive: true });
  symlinkSync(join(root, 'node_modules/@types'), join(folder, 'node_modules/@types'));
  for (const name of ['first.png', 'second.png']) cpSync(join(SAMPLES, 'intel-two-cars', name), join(folder, name));
  mkdirSync(join(folder, 'frames'));
  for (let frame = 20; frame <= 31; frame++) cpSync(join(SAMPLES, 'passing-cars/frames', `${frame}.webp`), join(folder, 'frames', `${frame}.webp`));
  return folder;
}

/** A folder of programs that come first on the path: `npx` without the network, and the Python that has the package. */
export function programs(folder, python) {
  const bin = join(folder, 'node_modules/.programs');
  mkdirSync(bin, { recursive: true });
  const program = (name, ...lines) => writeFileSync(join(bin, name), ['#!/bin/sh', ...lines, ''].join('\n'), { mode: 0o755 });
  const veronese = join(folder, 'node_modules/veronese/bin/veronese.js');
  program('npx', '[ "$1" = veronese ] || { echo "npx: the guide runs veronese alone" >&2; exit 1; }', 'shift', `exec '${process.execPath}' '${veronese}' "$@"`);
  program('node', `exec '${process.execPath}' "$@"`);
  if (python) program('python', `exec '${python}' "$@"`);
  return bin;
}
