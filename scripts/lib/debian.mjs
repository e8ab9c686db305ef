// Installs packages where that needs no confirmation: as root on Debian and its derivatives.

import { which } from './project.mjs';
import { run } from './run.mjs';

/** Installs packages and returns whether that worked; returns false silently if apt-get cannot be used. */
export async function installDebianPackages(packages, what) {
  if (process.platform !== 'linux' || process.getuid() !== 0 || !which('apt-get')) return false;
  console.log(`Installing ${what} with apt-get (${packages.join(', ')}; about a minute) …`);
  const env = { DEBIAN_FRONTEND: 'noninteractive' };
  for (const args of [
    ['update', '-q'],
    ['install', '-q', '-y', '--no-install-recommends', ...packages],
  ]) {
    const { code, text } = await run('apt-get', args, { output: 'collect', env });
    if (code === 0) continue;
    process.stderr.write(text);
    console.error(`apt-get ${args[0]} failed.`);
    return false;
  }
  return true;
}
