// The references: of the package from its types, by typedoc; of the crate, by rustdoc.

import { cpSync, rmSync } from 'node:fs';
import { join } from 'node:path';

import { HOSTS, prepareNpmPackages } from './npm-packages.mjs';
import { inProject, root } from './project.mjs';
import { must } from './run.mjs';

/** The hand-written types, one file per entry of the package. */
const ENTRIES = ['index', 'slim', 'codecs', 'colours', 'formats', 'element-class', 'element'].map((name) => `pkg/types/${name}.d.ts`);

export async function referenceOfPackage(folder) {
  await prepareNpmPackages(HOSTS);
  rmSync(folder, { recursive: true, force: true });
  const typedoc = join(root, HOSTS, 'node_modules', '.bin', 'typedoc');
  const entries = ENTRIES.filter(inProject).flatMap((file) => ['--entryPoints', file]);
  await must('The reference of the package could not be made.', typedoc, [...entries, '--options', 'pkg/typedoc.json', '--out', folder]);
}

export async function referenceOfCrate(folder) {
  // A folder of its own: others document other crates at the same time.
  const target = join(root, 'target', 'reference');
  const made = join(target, 'doc');
  rmSync(made, { recursive: true, force: true });
  const args = ['doc', '--quiet', '--target-dir', target, '--locked', '--no-deps', '--lib', '--features', 'codecs'];
  await must('The reference of the crate could not be made.', 'cargo', args);
  rmSync(folder, { recursive: true, force: true });
  cpSync(made, folder, { recursive: true });
}
