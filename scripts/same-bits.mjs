// npm run same-bits: the same generated pairs and clips in native code (debug and release), in WebAssembly in Node, with SIMD and without,
// in Chromium, Firefox and WebKit, and in Python. Prints a table of hashes of all labels and numbers; the exit code is 1 if any differ.
//   --pairs N       pairs (40)
//   --clips N       clips of 8 frames (4)
//   --only A,B      only these: debug, release, node, plain, chromium, firefox, webkit, python
// What is not there is said and left out: browsers, a suitable Python.

import { mkdirSync, readFileSync, rmSync } from 'node:fs';
import { join } from 'node:path';
import { parseArgs } from 'node:util';

import { findBrowsers } from './lib/browsers.mjs';
import { buildPackage, buildPlainModule, buildWheel } from './lib/builds.mjs';
import { launchChromium } from './lib/launch-chromium.mjs';
import { prepare } from './lib/prepare.mjs';
import { root } from './lib/project.mjs';
import { OWN, installWheel } from './lib/python-packages.mjs';
import { Stop, command, must, run } from './lib/run.mjs';
import { sha256 } from './lib/same-bits/bits.mjs';
import { serve } from './lib/static-server.mjs';

const HERE = 'scripts/lib/same-bits';
const OUT = 'out/same-bits';
const HOST = '127.0.0.1';
const BROWSERS = ['Chromium', 'Firefox', 'WebKit'];
/** By the name of each variant, what it is. */
const VARIANTS = {
  release: 'native, release',
  debug: 'native, debug',
  node: 'WebAssembly in Node',
  plain: 'WebAssembly in Node, without SIMD',
  ...Object.fromEntries(BROWSERS.map((name) => [name.toLowerCase(), `WebAssembly in ${name}`])),
  python: 'Python',
};

await command(async (args) => {
  const { pairs, clips, wanted } = options(args);
  const { chromium, ownPython } = await prepare({ browser: wanted.has('chromium'), ownPython: wanted.has('python') });
  const folder = join(root, OUT, 'cases');
  rmSync(join(root, OUT), { recursive: true, force: true });
  mkdirSync(folder, { recursive: true });
  console.log('Generating the frames (building the native program first if it has changed) …');
  await native(wanted.has('release') ? 'release' : 'debug', ['frames', folder, String(pairs), String(clips)]);
  const cases = JSON.parse(readFileSync(join(folder, 'cases.json'), 'utf8'));

  const answers = {};
  for (const profile of ['release', 'debug']) if (wanted.has(profile)) answers[profile] = await ofNative(profile, folder, cases);
  if (['node', 'plain', ...BROWSERS.map((name) => name.toLowerCase())].some((name) => wanted.has(name))) {
    await buildPackage();
  }
  if (wanted.has('node')) answers.node = await ofProgram(process.execPath, [join(root, HERE, 'node.mjs'), folder]);
  if (wanted.has('plain')) answers.plain = await ofProgram(process.execPath, [join(root, HERE, 'node.mjs'), folder, await buildPlainModule(join(root, OUT, 'plain'))]);
  Object.assign(answers, await ofBrowsers(chromium, wanted));
  if (wanted.has('python')) {
    if (ownPython.problem) console.log(ownPython.problem);
    else {
      await installWheel(OWN, await buildWheel(OWN.python));
      answers.python = await ofProgram(OWN.python, [join(root, HERE, 'bits.py'), folder]);
    }
  }
  return print(cases, answers);
});

function options(args) {
  let values;
  try {
    const text = (value) => ({ type: 'string', default: value });
    ({ values } = parseArgs({ args, options: { pairs: text('40'), clips: text('4'), only: text(Object.keys(VARIANTS).join()) } }));
  } catch (error) {
    throw new Stop(error.message);
  }
  const [pairs, clips] = ['pairs', 'clips'].map((name) => {
    const count = Number(values[name]);
    if (!Number.isInteger(count) || count < 0 || count > 100) throw new Stop(`--${name} must be a whole number from 0 to 100.`);
    return count;
  });
  if (pairs + clips === 0) throw new Stop('There is nothing to compare: ask for a pair or a clip.');
  const wanted = new Set(values.only.split(',').map((name) => name.trim()));
  const unknown = [...wanted].filter((name) => !(name in VARIANTS));
  if (unknown.length > 0) throw new Stop(`There is no ${unknown.join(' and no ')}: name some of ${Object.keys(VARIANTS).join(', ')}.`);
  return { pairs, clips, wanted };
}

async function native(profile, args) {
  const cargo = ['run', '--quiet', '--locked', ...(profile === 'release' ? ['--release'] : []), '--package', 'experiments', '--example', 'same-bits', '--', ...args];
  return must('The native program failed.', 'cargo', cargo, { output: 'collect' });
}

async function ofNative(profile, folder, cases) {
  console.log(`${VARIANTS[profile]} …`);
  const out = join(root, OUT, profile);
  await native(profile, ['results', folder, out]);
  const hash = (name) => sha256(readFileSync(join(out, name)));
  const found = {};
  for (const { name } of cases) found[name] = { labels: await hash(`${name}.labels`), numbers: await hash(`${name}.numbers`) };
  return found;
}

async function ofProgram(program, args) {
  console.log(`${args.map((arg) => arg.replace(`${root}/`, '')).join(' ')} …`);
  return JSON.parse((await must('The program failed.', program, args, { output: 'collect' })).stdout);
}

/** The answers of the browsers that are installed, by name in small letters. Those of WebDriver need a driver beside the browser. */
async function ofBrowsers(chromium, wanted) {
  const others = wanted.has('firefox') || wanted.has('webkit') ? await findBrowsers(undefined) : [];
  const driven = others.filter(({ name }) => name !== 'Chromium' && wanted.has(name.toLowerCase()));
  const problems = [...(wanted.has('chromium') ? [chromium] : []), ...driven].flatMap(({ problem }) => problem ?? []);
  for (const problem of problems) console.log(problem);
  const found = {};
  const server = await serve(root, { host: HOST, headers: {} });
  const base = `http://${HOST}:${server.address().port}`;
  const [page, folder] = [`${base}/${HERE}/page.html`, `${base}/${OUT}/cases`];
  try {
    if (wanted.has('chromium') && !chromium.problem) found.chromium = await ofChromium(chromium.path, page, folder);
    const there = driven.filter(({ problem }) => !problem);
    if (there.length > 0) {
      console.log(`${there.map(({ name }) => name).join(', ')} …`);
      const asked = { page, folder, out: join(root, OUT, 'NAME.json') };
      const env = { VERONESE_BROWSERS: JSON.stringify(there), VERONESE_SAME_BITS: JSON.stringify(asked) };
      const { code } = await run('npm', ['run', '--silent', 'same-bits', '--workspace', 'www'], { env });
      if (code !== 0) throw new Stop('Not all browsers have answered: see above.');
      for (const { name } of there) found[name.toLowerCase()] = JSON.parse(readFileSync(join(root, OUT, `${name}.json`), 'utf8'));
    }
  } finally {
    server.close();
    server.closeAllConnections();
  }
  return found;
}

async function ofChromium(executablePath, page, folder) {
  console.log('Chromium …');
  const browser = await launchChromium(executablePath);
  try {
    const opened = await browser.newPage();
    await opened.goto(page);
    await opened.waitForFunction(() => globalThis.sameBits !== undefined);
    return await opened.evaluate((cases) => globalThis.sameBits(cases), folder);
  } finally {
    await browser.close();
  }
}

/** Prints the table; returns the exit code. */
function print(cases, answers) {
  const names = Object.keys(answers);
  if (names.length < 2) throw new Stop('There is nothing to compare with: only one variant has answered.');
  const short = (name, of) => (({ labels, numbers }) => `${labels.slice(0, 8)} ${numbers.slice(0, 8)}`)(answers[of][name]);
  const columns = names.map((of) => cases.map(({ name }) => short(name, of)));
  const width = Math.max(...names.map((name) => name.length), 17);
  console.log(`\nHashes of labels and of numbers; = where they are those of ${VARIANTS[names[0]]}\n`);
  console.log(['case   ', ...names.map((name) => name.padEnd(width))].join('  '));
  let differing = 0;
  for (const [k, { name }] of cases.entries()) {
    const same = names.map((of) => ['labels', 'numbers'].every((part) => answers[of][name][part] === answers[names[0]][name][part]));
    if (same.includes(false)) differing += 1;
    console.log([name, ...columns.map((column, j) => (j > 0 && same[j] ? '=' : column[k]).padEnd(width))].join('  '));
  }
  const said = names.map((name) => VARIANTS[name]).join('; ');
  const left = Object.keys(VARIANTS).filter((name) => !names.includes(name)).map((name) => VARIANTS[name]);
  console.log(`\n${cases.length - differing} of ${cases.length} have the same bits in: ${said}.`);
  if (left.length > 0) console.log(`Not compared: ${left.join('; ')}.`);
  return differing === 0 ? 0 : 1;
}
