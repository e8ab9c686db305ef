// The packed npm package, looked at by publint and Are The Types Wrong?, which the tests of the package's hosts use too.

import { readFileSync } from 'node:fs';
import { join } from 'node:path';

import { HOSTS, prepareNpmPackages } from '../npm-packages.mjs';
import { root } from '../project.mjs';
import { must } from '../run.mjs';

/** Throws with what they found, if they found something. */
export async function checkNpmArchive(archive) {
  await prepareNpmPackages(HOSTS);
  const program = (name) => join(root, HOSTS, 'node_modules', '.bin', name);
  await must('publint found what is above.', program('publint'), ['run', archive, '--strict', '--level', 'suggestion'], { output: 'collect' });
  // A module's file is for bundlers to copy; there is nothing in it that types could describe.
  const { exports } = JSON.parse(readFileSync(join(root, 'pkg/package.json'), 'utf8'));
  const untyped = Object.keys(exports).filter((name) => name.endsWith('.wasm'));
  const args = [archive, '--exclude-entrypoints', ...untyped, '--profile', 'esm-only', '--format', 'ascii', '--no-emoji', '--no-color'];
  await must('Are The Types Wrong? found what is above.', program('attw'), args, { output: 'collect' });
}
