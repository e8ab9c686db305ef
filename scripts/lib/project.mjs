// Paths of the project, and the environment of the programs it starts.

import { accessSync, constants, existsSync, readFileSync, statSync } from 'node:fs';
import { homedir } from 'node:os';
import { delimiter, join } from 'node:path';
import { fileURLToPath } from 'node:url';

/** The checkout, without a slash at the end. */
export const root = fileURLToPath(new URL('../..', import.meta.url)).replace(/[\\/]$/, '');

/** Programs and records of this checkout; ignored by git, safe to delete. */
export const toolsFolder = join(root, '.tools');

/** Cargo's own folder, where it keeps the sources of packages. */
export const cargoHome = process.env.CARGO_HOME || join(homedir(), '.cargo');

/**
 * The environment of every program started here. npm's programs come first: wasm-pack takes any `wasm-opt` on the path,
 * and those of Linux distributions may be too old for the instructions the compiler writes. Cargo's folder comes last,
 * for a shell that was opened before rustup was installed.
 */
export const environment = {
  ...process.env,
  PATH: [
    join(root, 'node_modules', '.bin'),
    join(toolsFolder, 'bin'),
    process.env.PATH ?? '',
    join(cargoHome, 'bin'),
    join(homedir(), '.cargo', 'bin'),
  ].join(delimiter),
};

/** The full path of a program found on PATH, or undefined. */
export function which(program) {
  for (const folder of environment.PATH.split(delimiter)) {
    if (folder === '') continue;
    const path = join(folder, program);
    if (isProgram(path)) return path;
  }
  return undefined;
}

/** Whether a path is an executable file. */
export function isProgram(path) {
  try {
    accessSync(path, constants.X_OK);
    return statSync(path).isFile();
  } catch {
    return false;
  }
}

/** The text of a file of the project. */
export function projectText(path) {
  return readFileSync(join(root, path), 'utf8');
}

/** Whether a file or folder of the project exists. */
export function inProject(path) {
  return existsSync(join(root, path));
}

/** Whether version `found` ("1.95.0") is at least `needed` ("1.89"), compared number by number. */
export function atLeast(found, needed) {
  const left = found.split('.').map(Number);
  const right = needed.split('.').map(Number);
  for (let i = 0; i < right.length; i += 1) {
    const difference = (left[i] ?? 0) - right[i];
    if (difference !== 0) return difference > 0;
  }
  return true;
}
