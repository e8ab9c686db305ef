// Which parts of the tests need not run again: since they passed, nothing has changed that they depend on.

import { existsSync, lstatSync, mkdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';

import { fingerprint } from './fingerprint.mjs';
import { root, toolsFolder } from './project.mjs';
import { run } from './run.mjs';

const FOLDER = join(toolsFolder, 'passed');

/**
 * What a part depends on, as one text: the contents of all files of the project but those below `apart`, of what `build` builds, and the
 * `versions` of programs. Undefined where git does not say which files belong to the project: then everything runs.
 */
export async function stateOf({ apart, build, built = [] }, versions) {
  await build?.();
  const { code, stdout } = await run('git', ['ls-files', '-z', '--cached', '--others', '--exclude-standard'], { output: 'collect' });
  if (code !== 0) return undefined;
  const isApart = (path) =>
    apart.some((other) => (other.startsWith('*') ? path.endsWith(other.slice(1)) : path === other || path.startsWith(`${other}/`)));
  const files = stdout.split('\0').filter((path) => path !== '' && !isApart(path) && isFile(path));
  return fingerprint([...files.sort(), ...built], versions);
}

/** What a part did when it passed with this state, if it has. */
export function passedBefore(name, state) {
  const file = join(FOLDER, `${name}.json`);
  if (state === undefined || !existsSync(file)) return undefined;
  const last = JSON.parse(readFileSync(file, 'utf8'));
  return last.state === state ? last : undefined;
}

/** Keeps that a part has passed with this state; without one, nothing is known of it any more. */
export function keepPassed(name, state, passed) {
  const file = join(FOLDER, `${name}.json`);
  if (state === undefined) return rmSync(file, { force: true });
  mkdirSync(FOLDER, { recursive: true });
  writeFileSync(file, JSON.stringify({ state, passed }));
}

function isFile(path) {
  return lstatSync(join(root, path), { throwIfNoEntry: false })?.isFile() ?? false;
}
