// Set-up: installs everything the other commands need, given git, Node and rustup's cargo. Pieces that are installed are left alone.
// Nothing is recorded: each piece is checked every time, which takes less than a second.

import { compileAhead } from './builds.mjs';
import { prepareChromium } from './chromium.mjs';
import { HOSTS, RUNTIMES, SCALE_OUT, SERVERS, prepareNpmPackages } from './npm-packages.mjs';
import { projectText, atLeast } from './project.mjs';
import { DECODERS, FIFTYONE, OWN, preparePython } from './python-packages.mjs';
import { Stop, say } from './run.mjs';
import { checkRust, prepareCompiler, prepareWasmTools } from './rust.mjs';

/**
 * Prepares the compiler, wasm tools and npm packages. `checks` adds the formatter and clippy, `browser` adds Chromium, `hosts` adds the
 * bundlers and checkers for the packed package and what the examples need, `runtimes` adds what else the package runs on, `python` adds the
 * decoders of annotation tools and CVAT's SDK, `fiftyone` FiftyOne, and `ownPython` what builds and tests the Python package.
 * Throws `Stop` with a sentence for every missing piece. A missing browser or Python is returned instead, as
 * `{ chromium: { problem } }`, `{ python: { problem } }` and the like, because only their tests need them.
 */
export async function prepare({
  checks = false,
  browser = false,
  hosts = false,
  python = false,
  fiftyone = false,
  ownPython = false,
  runtimes = false,
} = {}) {
  checkNode();
  await checkRust();
  const rust = prepareCompiler({ checks }).then(() => prepareWasmTools(compileAhead));
  const javascript = prepareNpmPackages()
    .then(() => prepareFolders([...(hosts ? [HOSTS, SCALE_OUT, SERVERS] : []), ...(runtimes ? [HOSTS, RUNTIMES] : [])]))
    .then(() => (browser ? prepareChromium() : {}));
  const decoders = python ? preparePython(DECODERS) : {};
  const readers = fiftyone ? preparePython(FIFTYONE) : {};
  const own = ownPython ? preparePython(OWN) : {};
  const outcomes = await Promise.allSettled([rust, javascript, decoders, readers, own]);
  const failures = outcomes.filter(({ status }) => status === 'rejected').map(({ reason }) => reason);
  const surprise = failures.find((reason) => !(reason instanceof Stop));
  if (surprise) throw surprise;
  if (failures.length > 0) throw new Stop(failures.map(({ message }) => message).join('\n'));
  return { chromium: outcomes[1].value, python: outcomes[2].value, fiftyone: outcomes[3].value, ownPython: outcomes[4].value };
}

async function prepareFolders(folders) {
  for (const folder of folders) await prepareNpmPackages(folder);
}

function checkNode() {
  const needed = /\d+/.exec(JSON.parse(projectText('package.json')).engines.node)[0];
  const found = process.versions.node;
  if (!atLeast(found, needed)) say(`Node ${found} is older than ${needed}, the oldest that is supported: see https://nodejs.org.`);
}
