// Installs packages from npm.

import { join } from 'node:path';

import { inProject, projectText, root } from './project.mjs';
import { Stop, longStep } from './run.mjs';

/** Tools that only some tests and commands need. They are not a workspace, so nobody else has to install them. */
export const HOSTS = 'pkg/test/hosts';
export const RUNTIMES = 'pkg/test/runtimes';
export const SERVERS = 'examples/hosts';
export const SCALE_OUT = 'examples/scale-out';
export const SITE = 'site';

/** Installs the packages of a folder's package-lock.json unless they are already installed. */
export async function prepareNpmPackages(folder = '.') {
  const at = (path) => join(folder, path);
  if (!inProject(at('package-lock.json'))) {
    throw new Stop(`${at('package-lock.json')} is missing: restore it with \`git checkout ${at('package-lock.json')}\`.`);
  }
  if (isInstalled(at)) return;
  const what = folder === '.' ? 'the npm packages' : `the npm packages of ${folder}`;
  await longStep(
    `Installing ${what} (${folder === RUNTIMES ? 'some hundred megabytes' : 'about half a minute'})`,
    `${what[0].toUpperCase()}${what.slice(1)} could not be installed. See above; if it is the network, run the command again.`,
    'npm',
    // `ci` requires every optional package of every system in the lock file, and some of BullMQ's are not available everywhere.
    [...(folder === SCALE_OUT ? ['install', '--no-save'] : ['ci']), '--no-audit', '--no-fund'],
    { cwd: join(root, folder) },
  );
}

/**
 * Whether node_modules holds the versions of package-lock.json. npm notes what it installed in a lock file of its own
 * there; packages for other operating systems are optional and absent.
 */
function isInstalled(at) {
  if (!inProject(at('node_modules/.package-lock.json'))) return false;
  const wanted = JSON.parse(projectText(at('package-lock.json'))).packages;
  const found = JSON.parse(projectText(at('node_modules/.package-lock.json'))).packages;
  return Object.entries(wanted).every(([path, { version, link, optional }]) => {
    if (!path.includes('node_modules/')) return true;
    if (!(path in found)) return optional === true;
    return link ? inProject(at(path)) : found[path].version === version && inProject(at(join(path, 'package.json')));
  });
}
