// The packages from npm.

import { join } from 'node:path';

import { inProject, projectText } from './project.mjs';
import { Stop, longStep } from './run.mjs';

/** Installs what package-lock.json names, unless it is there already. */
export async function prepareNpmPackages() {
  if (!inProject('package-lock.json')) {
    throw new Stop('package-lock.json is missing: restore it with `git checkout package-lock.json`.');
  }
  if (isInstalled()) return;
  await longStep(
    'Installing the npm packages (about half a minute)',
    'The npm packages could not be installed. See above; if it is the network, run the command again.',
    'npm',
    ['ci', '--no-audit', '--no-fund'],
  );
}

/**
 * Whether node_modules holds the versions of package-lock.json. npm notes what it installed in a lock file of its own
 * there; packages for other operating systems are optional and absent.
 */
function isInstalled() {
  if (!inProject('node_modules/.package-lock.json')) return false;
  const wanted = JSON.parse(projectText('package-lock.json')).packages;
  const found = JSON.parse(projectText('node_modules/.package-lock.json')).packages;
  return Object.entries(wanted).every(([path, { version, link, optional }]) => {
    if (!path.includes('node_modules/')) return true;
    if (!(path in found)) return optional === true;
    return link ? inProject(path) : found[path].version === version && inProject(join(path, 'package.json'));
  });
}
