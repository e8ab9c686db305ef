// The environment with the tools' own decoders and CVAT's SDK. They are Python; set-up puts them into .tools/python where there is a Python
// (scripts/lib/python-packages.mjs says which).

import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { existsSync } from 'node:fs';
import { fileURLToPath } from 'node:url';

const programOf = (environment) => fileURLToPath(
  new URL(`../../../.tools/${environment}/${process.platform === 'win32' ? 'Scripts/python.exe' : 'bin/python'}`, import.meta.url),
);
const missing = (program, what) => !existsSync(program) && `${what} not installed: this needs Python 3.10 or newer with venv, then \`npm run soak -- formats\``;

/** The program. */
export const python = programOf('python');

/** Why what is Python cannot run, or false. */
export const skip = missing(python, "the annotation tools' Python packages are");

/** The program that has FiftyOne, which has an environment to itself, and why it cannot run. */
export const fiftyone = programOf('fiftyone');
export const withoutFiftyone = missing(fiftyone, 'FiftyOne is');

/** Runs a script of this folder on a folder; what it printed, as JSON. */
export function decoded(script, folder, program = python) {
  const path = fileURLToPath(new URL(script, import.meta.url));
  const { status, stdout, stderr } = spawnSync(program, ['-B', path, folder], { encoding: 'utf8', maxBuffer: 2 ** 26 });
  assert.equal(status, 0, stderr);
  return JSON.parse(stdout);
}
