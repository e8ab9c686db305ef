// The Python package, built as it is published.

import { copyFileSync, mkdirSync, readdirSync, rmSync } from 'node:fs';
import { basename, join } from 'node:path';

import { buildWheel } from '../builds.mjs';
import { OWN, preparePython } from '../python-packages.mjs';
import { Stop, must } from '../run.mjs';

/** Builds the wheel for this machine: its path and the files in it. */
export async function makeWheel(out) {
  const { problem } = await preparePython(OWN);
  if (problem) throw new Stop(`The wheel was not built. ${problem}`);
  mkdirSync(out, { recursive: true });
  for (const name of readdirSync(out)) if (name.endsWith('.whl')) rmSync(join(out, name));
  const built = await buildWheel(OWN.python);
  const wheel = join(out, basename(built));
  copyFileSync(built, wheel);
  const list = 'import sys, zipfile; print("\\n".join(zipfile.ZipFile(sys.argv[1]).namelist()))';
  const { stdout } = await must(`${wheel} could not be read.`, OWN.python, ['-c', list, wheel], { output: 'collect' });
  return { wheel, files: stdout.split('\n').filter(Boolean).sort() };
}
