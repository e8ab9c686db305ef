// Installs the annotation tools' own decoders and CVAT's SDK (Python) in a separate environment under .tools. Only the tests of formats
// and of the examples use it.

import { rmSync } from 'node:fs';
import { join } from 'node:path';

import { inProject, projectText, root, toolsFolder } from './project.mjs';
import { longStep, must, run } from './run.mjs';

const LIST = 'pkg/test/support/requirements.txt';
const FOLDER = join(toolsFolder, 'python');
const PYTHON = join(FOLDER, ...(process.platform === 'win32' ? ['Scripts', 'python.exe'] : ['bin', 'python']));
/** The Python versions that the pinned packages support. */
const SUITS = 'import sys, venv, ensurepip; sys.exit(0 if (3, 10) <= sys.version_info < (3, 14) else 1)';

/** Returns `{ problem }` if there is no suitable Python; the tests that need it are then skipped. */
export async function preparePython() {
  if (inProject('.tools/python') && (await isInstalled())) return {};
  const program = await suitable(process.platform === 'win32' ? ['python', 'python3'] : ['python3', 'python']);
  if (!program) {
    return { problem: 'The formats are not read by the tools themselves, and cvat-clip.py does not run: that takes Python 3.10 to 3.13 with venv (Debian: apt-get install python3-venv).' };
  }
  rmSync(FOLDER, { recursive: true, force: true });
  await must('Python could not make an environment in .tools/python.', program, ['-m', 'venv', FOLDER], { output: 'collect' });
  await longStep(
    "Installing the annotation tools' decoders (about a minute)",
    'The Python packages could not be installed. See above; if it is the network, run the command again.',
    PYTHON,
    ['-m', 'pip', 'install', '--quiet', '--disable-pip-version-check', '--no-deps', '--requirement', join(root, LIST)],
  );
  return {};
}

async function suitable(programs) {
  for (const program of programs) {
    if ((await run(program, ['-c', SUITS], { output: 'collect' })).code === 0) return program;
  }
  return undefined;
}

/** Whether every version of the list is installed, according to Python's own records, which are quick to read. */
async function isInstalled() {
  const wanted = projectText(LIST).split('\n').filter((line) => line.includes('=='));
  const check = `import importlib.metadata as m; [exit(1) for p in ${JSON.stringify(wanted)} if m.version(p.split('==')[0]) != p.split('==')[1]]`;
  return (await run(PYTHON, ['-c', check], { output: 'collect' })).code === 0;
}
