// The environment with the tools' own decoders and CVAT's SDK. They are Python; set-up puts them into .tools/python where there is a Python
// (scripts/lib/python-packages.mjs says which).

import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { existsSync } from 'node:fs';
import { fileURLToPath } from 'node:url';

/** The program. */
export const python = fileURLToPath(
  new URL(process.platform === 'win32' ? '../../../.tools/python/Scripts/python.exe' : '../../../.tools/python/bin/python', import.meta.url),
);

/** Why what is Python cannot run, or false. */
export const skip = !existsSync(python) && "the annotation tools' Python packages are not installed: they need Python 3.10 or newer with venv, then `npm run soak -- formats`";

/** Runs a script of this folder on a folder; what it printed, as JSON. */
export function decoded(script, folder) {
  const path = fileURLToPath(new URL(script, import.meta.url));
  const { status, stdout, stderr } = spawnSync(python, ['-B', path, folder], { encoding: 'utf8', maxBuffer: 2 ** 26 });
  assert.equal(status, 0, stderr);
  return JSON.parse(stdout);
}
