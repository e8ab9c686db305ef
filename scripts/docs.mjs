// npm run docs: builds the reference of the package from its types, and of the crate with rustdoc, in out/docs.

import { cpSync, existsSync, rmSync } from 'node:fs';
import { join } from 'node:path';

import { HOSTS, prepareNpmPackages } from './lib/npm-packages.mjs';
import { prepare } from './lib/prepare.mjs';
import { inProject, root } from './lib/project.mjs';
import { command, must } from './lib/run.mjs';

const OUT = join(root, 'out', 'docs');
/** The hand-written types, one file per entry of the package. */
const ENTRIES = ['index', 'slim', 'codecs', 'formats', 'element-class', 'element'].map((name) => `pkg/types/${name}.d.ts`);

await command(async () => {
  await prepare();
  await prepareNpmPackages(HOSTS);
  rmSync(OUT, { recursive: true, force: true });
  const typedoc = join(root, HOSTS, 'node_modules', '.bin', 'typedoc');
  const entries = ENTRIES.filter(inProject).flatMap((file) => ['--entryPoints', file]);
  const settings = ['--options', 'pkg/typedoc.json', '--out', join(OUT, 'package')];
  await must('The reference of the package could not be made.', typedoc, [...entries, ...settings]);
  const doc = ['doc', '--locked', '--no-deps', '--lib', '--features', 'codecs,stages'];
  await must('The reference of the crate could not be made.', 'cargo', doc, { env: { CARGO_TARGET_DIR: undefined } });
  const made = join(root, 'target', 'doc');
  if (existsSync(made)) cpSync(made, join(OUT, 'crate'), { recursive: true });
  console.log('\nout/docs/package/index.html and out/docs/crate/veronese/index.html');
});
