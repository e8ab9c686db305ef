// The Python package, built as it is published.

import { mkdirSync, readdirSync, rmSync } from 'node:fs';
import { join } from 'node:path';

import { prepareMaturin } from '../maturin.mjs';
import { inProject } from '../project.mjs';
import { must } from '../run.mjs';

const MANIFEST = 'python/Cargo.toml';

/** Builds the wheel for this machine: its path and the files in it, or undefined if there is no Python package. */
export async function buildWheel(out) {
  if (!inProject(MANIFEST)) return undefined;
  const { maturin, python } = await prepareMaturin();
  mkdirSync(out, { recursive: true });
  for (const name of readdirSync(out)) if (name.endsWith('.whl')) rmSync(join(out, name));
  await must('The wheel could not be built.', maturin, ['build', '--release', '--strip', '--locked', '-m', MANIFEST, '--out', out], { output: 'collect' });
  const wheel = join(out, readdirSync(out).find((name) => name.endsWith('.whl')));
  const list = 'import sys, zipfile; print("\\n".join(zipfile.ZipFile(sys.argv[1]).namelist()))';
  const { stdout } = await must(`${wheel} could not be read.`, python, ['-c', list, wheel], { output: 'collect' });
  return { wheel, files: stdout.split('\n').filter(Boolean).sort() };
}
