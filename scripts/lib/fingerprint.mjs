// Skips builds whose inputs have not changed.

import { createHash } from 'node:crypto';
import { existsSync, mkdirSync, readFileSync, readdirSync, rmSync, statSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';

import { inProject, root, toolsFolder } from './project.mjs';

const NOT_INPUTS = new Set(['node_modules', 'dist', 'test-results', 'playwright-report']);

/**
 * Runs `build` unless `outputs` exist and the contents of `inputs` (files and folders of the project) and `versions`
 * (of the build programs) are those of the last successful build. Returns whether it ran.
 */
export async function buildIfChanged(name, { inputs, outputs, versions = [] }, build) {
  const record = join(toolsFolder, 'built', name);
  const current = fingerprint(inputs, versions);
  const same = existsSync(record) && readFileSync(record, 'utf8') === current;
  if (same && outputs.every(inProject)) return false;
  rmSync(record, { force: true });
  await build();
  mkdirSync(join(toolsFolder, 'built'), { recursive: true });
  writeFileSync(record, current);
  return true;
}

/** The contents of files and folders of the project and the versions of programs, as one text. */
export function fingerprint(inputs, versions) {
  const hash = createHash('sha256');
  hash.update(JSON.stringify(versions));
  for (const path of inputs.flatMap(filesIn)) {
    const content = readFileSync(join(root, path));
    hash.update(`${path}\0${content.length}\0`).update(content);
  }
  return `${hash.digest('hex')}\n`;
}

/** The files at or below a path of the project, sorted; empty if the path does not exist. */
function filesIn(path) {
  if (!inProject(path)) return [];
  if (!statSync(join(root, path)).isDirectory()) return [path];
  const names = readdirSync(join(root, path)).filter((name) => !NOT_INPUTS.has(name));
  return names.sort().flatMap((name) => filesIn(`${path}/${name}`));
}
