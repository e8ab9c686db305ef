// Installs Python packages in separate environments under .tools: the annotation tools' own decoders and CVAT's SDK, which only the tests of
// formats and of the examples use, FiftyOne, and what builds and tests the Python package.

import { rmSync } from 'node:fs';
import { join } from 'node:path';

import { inProject, projectText, root } from './project.mjs';
import { longStep, must, run } from './run.mjs';

/** The Python versions that the pinned packages support. */
const SUITS = 'import sys, venv, ensurepip; sys.exit(0 if (3, 10) <= sys.version_info < (3, 14) else 1)';
const NEEDED = 'that takes Python 3.10 to 3.13 with venv (Debian: apt-get install python3-venv).';

export const DECODERS = environment({
  folder: '.tools/python',
  list: 'pkg/test/support/requirements.txt',
  what: "the annotation tools' decoders",
  problem: `The formats are not read by the tools themselves, and cvat-clip.py does not run: ${NEEDED}`,
});

export const FIFTYONE = environment({
  folder: '.tools/fiftyone',
  list: 'pkg/test/support/requirements-fiftyone.txt',
  what: 'FiftyOne, one gigabyte',
  problem: `The formats are not read by FiftyOne: ${NEEDED}`,
  complete: true,
});

export const OWN = environment({
  folder: '.tools/python-package',
  list: 'python/tests/requirements.txt',
  what: 'what builds and tests the Python package',
  problem: `The Python package is not tested: ${NEEDED}`,
});

/** `list` names all packages of the environment with their versions; where it is `complete`, what they depend on follows. */
function environment(parts) {
  const inside = process.platform === 'win32' ? ['Scripts', 'python.exe'] : ['bin', 'python'];
  return { ...parts, python: join(root, parts.folder, ...inside) };
}

/** Returns `{ problem }` if there is no suitable Python; the tests that need it are then skipped. */
export async function preparePython({ folder, list, what, problem, complete, python }) {
  if (inProject(folder) && (await isInstalled(python, list))) return {};
  const program = await suitable(process.platform === 'win32' ? ['python', 'python3'] : ['python3', 'python']);
  if (!program) return { problem };
  rmSync(join(root, folder), { recursive: true, force: true });
  await must(`Python could not make an environment in ${folder}.`, program, ['-m', 'venv', join(root, folder)], { output: 'collect' });
  await longStep(
    `Installing ${what} (about a minute)`,
    'The Python packages could not be installed. See above; if it is the network, run the command again.',
    python,
    [...PIP, ...(complete ? [] : ALONE), '--requirement', join(root, list)],
  );
  return {};
}

/** Installs a wheel, in the place of what was built before. */
export async function installWheel({ python }, wheel) {
  await must('The wheel could not be installed.', python, [...PIP, ...ALONE, '--force-reinstall', wheel], { output: 'collect' });
}

const PIP = ['-m', 'pip', 'install', '--quiet', '--disable-pip-version-check'];
const ALONE = ['--no-deps'];

async function suitable(programs) {
  for (const program of programs) {
    if ((await run(program, ['-c', SUITS], { output: 'collect' })).code === 0) return program;
  }
  return undefined;
}

/** Whether every version of the list is installed, according to Python's own records, which are quick to read. */
async function isInstalled(python, list) {
  const wanted = projectText(list)
    .split('\n')
    .filter((line) => line.includes('=='));
  const check = `import importlib.metadata as m; [exit(1) for p in ${JSON.stringify(wanted)} if m.version(p.split('==')[0]) != p.split('==')[1]]`;
  return (await run(python, ['-c', check], { output: 'collect' })).code === 0;
}
