// The archives that are published, made as the registries' own programs make them, and what is in them.

import { existsSync, mkdirSync, readdirSync, rmSync } from 'node:fs';
import { join } from 'node:path';

import { root } from '../project.mjs';
import { must } from '../run.mjs';

/** Packs the npm package and returns the path of the archive. */
export async function packNpm(out) {
  removeOld(out, '.tgz');
  const args = ['pack', '--json', '--ignore-scripts', '--pack-destination', out];
  const { stdout } = await must('The npm package could not be packed.', 'npm', args, { cwd: join(root, 'pkg'), output: 'collect' });
  return join(out, JSON.parse(stdout)[0].filename);
}

/** Packs the crate, compiles what is in the archive, and returns its path. */
export async function packCrate(out, crate, { dirty }) {
  removeOld(out, '.crate');
  const target = join(root, 'target', 'release-package');
  const args = ['package', '--locked', '--package', crate, '--target-dir', target, ...(dirty ? ['--allow-dirty'] : [])];
  await must('The crate could not be packed.', 'cargo', args, { output: 'collect' });
  const made = readdirSync(join(target, 'package')).filter((name) => name.startsWith(`${crate}-`) && name.endsWith('.crate'));
  await must('The crate could not be kept.', 'cp', [...made.map((name) => join(target, 'package', name)), out], { output: 'collect' });
  rmSync(join(target, 'package'), { recursive: true, force: true });
  return join(out, made[0]);
}

/** The files in an archive of npm or Cargo, without the folder that all of them are in. */
export async function filesIn(archive) {
  const { stdout } = await must(`${archive} could not be read.`, 'tar', ['-tzf', archive], { output: 'collect' });
  return stdout.split('\n').filter(Boolean).map((path) => path.replace(/^[^/]+\//, '')).sort();
}

function removeOld(out, ending) {
  mkdirSync(out, { recursive: true });
  for (const name of existsSync(out) ? readdirSync(out) : []) if (name.endsWith(ending)) rmSync(join(out, name));
}
