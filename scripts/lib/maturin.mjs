// Installs maturin, which builds the Python package, in an environment of its own under .tools.

import { join } from 'node:path';

import { isProgram, toolsFolder } from './project.mjs';
import { Stop, longStep, must, run } from './run.mjs';

const MATURIN = '1.16.0';
const FOLDER = join(toolsFolder, 'maturin');
const program = (name) => join(FOLDER, ...(process.platform === 'win32' ? ['Scripts', `${name}.exe`] : ['bin', name]));

/** Returns the paths of the programs `maturin` and `python`. */
export async function prepareMaturin() {
  const found = { maturin: program('maturin'), python: program('python') };
  if (isProgram(found.maturin)) {
    const { text } = await run(found.maturin, ['--version'], { output: 'collect' });
    if (text.trim() === `maturin ${MATURIN}`) return found;
  }
  const made = await run('python3', ['-m', 'venv', '--clear', FOLDER], { output: 'collect' });
  if (made.code !== 0) throw new Stop('The Python package is built with Python 3 and its module venv (Debian: apt-get install python3-venv).');
  await longStep(
    `Installing maturin ${MATURIN} into .tools`,
    `maturin ${MATURIN} could not be installed. See above; if it is the network, run the command again.`,
    found.python,
    ['-m', 'pip', 'install', '--quiet', '--disable-pip-version-check', `maturin==${MATURIN}`],
  );
  await must('maturin does not run.', found.maturin, ['--version'], { output: 'collect' });
  return found;
}
