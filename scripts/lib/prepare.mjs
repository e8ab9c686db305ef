// Set-up: installs everything the other commands need, given git, Node and rustup's cargo. Pieces that are installed are left alone.
// Nothing is recorded: each piece is checked every time, which takes less than a second.

import { compileModulesAhead } from './builds.mjs';
import { prepareChromium } from './chromium.mjs';
import { HOSTS, SCALE_OUT, SERVERS, prepareNpmPackages } from './npm-packages.mjs';
import { projectText, atLeast } from './project.mjs';
import { preparePython } from './python-packages.mjs';
import { Stop } from './run.mjs';
import { checkRust, prepareCompiler, prepareWasmTools } from './rust.mjs';

/**
 * Prepares the compiler, wasm tools and npm packages. `checks` adds the formatter and clippy, `browser` adds Chromium, `hosts` adds the
 * bundlers and checkers for the packed package and what the examples need, and `python` adds the decoders of annotation tools.
 * Throws `Stop` with a sentence for every missing piece. A missing browser or Python is returned instead, as
 * `{ chromium: { problem } }` or `{ python: { problem } }`, because only their tests need them.
 */
export async function prepare({ checks = false, browser = false, hosts = false, python = false } = {}) {
  checkNode();
  await checkRust();
  const rust = prepareCompiler({ checks }).then(() => prepareWasmTools(compileModulesAhead));
  const javascript = prepareNpmPackages()
    .then(() => prepareFolders(hosts ? [HOSTS, SCALE_OUT, SERVERS] : []))
    .then(() => (browser ? prepareChromium() : {}));
  const decoders = python ? preparePython() : {};
  const outcomes = await Promise.allSettled([rust, javascript, decoders]);
  const failures = outcomes.filter(({ status }) => status === 'rejected').map(({ reason }) => reason);
  const surprise = failures.find((reason) => !(reason instanceof Stop));
  if (surprise) throw surprise;
  if (failures.length > 0) throw new Stop(failures.map(({ message }) => message).join('\n'));
  return { chromium: outcomes[1].value, python: outcomes[2].value };
}

async function prepareFolders(folders) {
  for (const folder of folders) await prepareNpmPackages(folder);
}

function checkNode() {
  const needed = /\d+/.exec(JSON.parse(projectText('package.json')).engines.node)[0];
  const found = process.versions.node;
  if (!atLeast(found, needed)) throw new Stop(`Node ${found} is too old, ${needed} is needed: see https://nodejs.org.`);
}
