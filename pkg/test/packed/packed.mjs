// The package as a user gets it: packed, installed from the tarball into an empty project, with frames to segment.

import { spawnSync } from 'node:child_process';
import { cpSync, mkdtempSync, readdirSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { pair } from '../support/moving.mjs';

const here = (path) => fileURLToPath(new URL(path, import.meta.url));

/** Runs a program to its end; throws with its messages where it fails. */
export function run(program, args, options = {}) {
  const { status, stdout, stderr, error } = spawnSync(program, args, { encoding: 'utf8', timeout: 120_000, ...options });
  if (status !== 0) throw new Error(`${program} ${args.join(' ')}: ${error?.message ?? `code ${status}`}\n${stdout}\n${stderr}`);
  return stdout;
}

/** What the first process of a run has installed, for the others: a folder that `scripts/lib/parts.mjs` makes and removes. */
const SHARED = process.env.VERONESE_INSTALLED;

/** Makes the project and returns its folder and the tarball; `remove()` takes both away. */
export function install() {
  const folder = mkdtempSync(join(tmpdir(), 'veronese-hosts-'));
  const app = join(folder, 'app');
  const isThere = SHARED !== undefined && readdirSync(SHARED).length > 0;
  if (isThere) copy(SHARED, folder);
  else {
    run('npm', ['pack', '--ignore-scripts', '--pack-destination', folder], { cwd: here('../..') });
    cpSync(here('./app'), app, { recursive: true });
    writeFileSync(join(app, 'package.json'), '{ "name": "app", "private": true, "type": "module" }\n');
    writeFileSync(join(app, 'frames.js'), framesModule());
    run('npm', ['install', '--no-audit', '--no-fund', '--prefer-offline', '--omit=dev', tarballIn(folder)], { cwd: app });
    if (SHARED !== undefined) copy(folder, SHARED);
  }
  return { app, tarball: tarballIn(folder), remove: () => rmSync(folder, { recursive: true, force: true }) };
}

function copy(from, to) {
  cpSync(from, to, { recursive: true, verbatimSymlinks: true });
}

function tarballIn(folder) {
  return join(folder, readdirSync(folder).find((name) => name.endsWith('.tgz')));
}

/** The frames as a module without a dependency, so that every host segments the same bytes. */
function framesModule() {
  const [first, second] = pair().map(({ data }) => Buffer.from(data).toString('base64'));
  return `const frame = (text) => ({ data: Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0)), width: 64, height: 48 });
export const first = frame('${first}');
export const second = frame('${second}');
`;
}
