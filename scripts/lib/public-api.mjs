// The names of the crate that semantic versioning covers: tests/public-api.txt has them, `npm run public-api` writes it, and the checks
// compare it, so that no name comes or goes unseen. That takes cargo-public-api and a nightly toolchain, which `npm run public-api -- --install`
// installs. The workflows do, and set the variable, so that there the check cannot be left out unseen.
//
// The names of the npm package are its types, pkg/types, which are written by hand; tests compare them with what is exported.

import { writeFileSync } from 'node:fs';
import { join } from 'node:path';

import { projectText, root } from './project.mjs';
import { Stop, run, say } from './run.mjs';
import { NIGHTLY, lacksPublicApi } from './rust.mjs';

const REQUIRED = 'VERONESE_REQUIRE_PUBLIC_API';
const FILE = 'tests/public-api.txt';
/** Parts that may change in any version (src/lib.rs, "Stability"). */
const UNSTABLE = /^(?:impl .* for |[^:(>]*)veronese::(?:embedding|factorisation|linear|paper|refinement)\b/;

/** Whether the names are those of the file; undefined where they cannot be listed. */
export async function publicApiAgrees() {
  const problem = await missing();
  if (problem) {
    say(`The names of the crate were not compared: ${problem}`);
    return process.env[REQUIRED] ? false : undefined;
  }
  const [found, expected] = [await names(), projectText(FILE)];
  if (found === undefined) return false;
  const lines = (text) => new Set(text.split('\n'));
  const without = (one, other) => [...lines(one)].filter((line) => !lines(other).has(line));
  for (const line of without(found, expected)) say(`new: ${line}`);
  for (const line of without(expected, found)) say(`gone: ${line}`);
  if (found !== expected) say(`The names of the crate are not those of ${FILE}. If that is meant, run \`npm run public-api\`.`);
  return found === expected;
}

export async function writePublicApi() {
  const problem = await missing();
  if (problem) throw new Stop(problem);
  const found = await names();
  if (found === undefined) throw new Stop('Nothing was written.');
  writeFileSync(join(root, FILE), found);
  say(`Written to ${FILE}.`);
}

async function missing() {
  const lacking = await lacksPublicApi();
  return lacking && `there is no ${lacking} (\`npm run public-api -- --install\` installs it).`;
}

/** The names, a line each; undefined, with what cargo says, where it cannot list them. */
async function names() {
  // Without what traits give, and without paths of other crates to the names' own types.
  const args = ['run', NIGHTLY, 'cargo', 'public-api', '--package', 'veronese', '--features', 'codecs', '-sss'];
  const { code, text, stdout } = await run('rustup', args, { output: 'collect' });
  if (code !== 0) {
    say(`The names of the crate could not be listed:\n${text.trim()}`);
    return undefined;
  }
  const stable = stdout.split('\n').filter((line) => line && !UNSTABLE.test(line));
  return `${stable.join('\n')}\n`;
}
