// Set-up: everything the other commands need, from git, Node and rustup's cargo. What is there already is left alone,
// and nothing is recorded: each piece is looked at anew, which takes less than a second.

import { prepareChromium } from './chromium.mjs';
import { HOSTS, SCALE_OUT, SERVERS, prepareNpmPackages } from './npm-packages.mjs';
import { projectText, atLeast } from './project.mjs';
import { preparePython } from './python-packages.mjs';
import { Stop } from './run.mjs';
import { checkRust, prepareCompiler, prepareWasmTools } from './rust.mjs';

/**
 * Prepares compiler, wasm tools and npm packages; with `checks` formatter and clippy too, with `browser` Chromium, with
 * `hosts` the bundlers and checkers that the packed package is tried in and what the examples need, with
 * `python` the decoders of annotation tools.
 * Throws `Stop` with a sentence for every missing piece. Only a missing browser or Python is returned instead,
 * as `{ chromium: { problem } }` or `{ python: { problem } }`, because everything but their tests works without.
 */
export async function prepare({ checks = false, browser = false, hosts = false, python = false } = {}) {
  checkNode();
  await checkRust();
  const rust = prepareCompiler({ checks }).then(prepareWasmTools);
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
