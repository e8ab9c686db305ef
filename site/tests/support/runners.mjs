// Runs a block of the guide, by its language, in a reader's folder. Each runner returns what was printed, errors too, or `{ skip }` with a
// sentence where something is not installed; it throws if the block fails.

import { spawnSync } from 'node:child_process';
import { copyFileSync, existsSync, mkdirSync, symlinkSync, writeFileSync } from 'node:fs';
import { dirname, join } from 'node:path';

import { environment, root } from '../../../scripts/lib/project.mjs';
import { OWN } from '../../../scripts/lib/python-packages.mjs';
import { divide } from './commands.mjs';
import { programs } from './reader.mjs';
import { showPage } from './show.mjs';

const MINUTES = 60_000;
const TSC = join(root, 'node_modules/.bin/tsc');
/** Where the tests of the package in its hosts have the frameworks. */
const FRAMEWORKS = join(root, 'pkg/test/hosts/node_modules');

/** By the language of a fence. A language that is not here fails the test. */
export const RUNNERS = { html: showPage, js: runScript, json: writeJson, python: runPython, rust: runRust, sh: runShell, ts: checkTypes, tsx: checkTypes };

function runScript({ folder, block }) {
  const file = written(folder, block, 'example.mjs');
  // Files without a name of their own are examples, others are run as a reader runs them.
  return printed(folder, process.execPath, [file]);
}

function writeJson({ folder, block }) {
  JSON.parse(block.code);
  if (!block.file) throw new Error('a block of JSON needs the name of its file');
  written(folder, block);
  return '';
}

function runShell({ folder, block, note }) {
  const { run, recognised } = divide(block.code);
  for (const line of recognised) note(`checked, not run: ${line}`);
  if (run.length === 0) return '';
  if (run.some((line) => /^node \S+\.mts$/.test(line)) && !process.features.typescript) return { skip: 'this Node runs no TypeScript' };
  const usesPython = run.some((line) => line.startsWith('python '));
  if (usesPython && !hasPython()) return { skip: WITHOUT_PYTHON };
  const bin = programs(folder, usesPython ? OWN.python : undefined);
  return printed(folder, 'sh', ['-e', '-c', `exec 2>&1\n${run.join('\n')}`], { PATH: `${bin}:${process.env.PATH}` });
}

const WITHOUT_PYTHON = 'the Python package is not installed in .tools/python-package: `npm test -- --part python` builds and installs it';

function hasPython() {
  return existsSync(OWN.python) && spawnSync(OWN.python, ['-c', 'import veronese']).status === 0;
}

function runPython({ folder, block }) {
  if (!hasPython()) return { skip: WITHOUT_PYTHON };
  return printed(folder, OWN.python, [written(folder, block, 'example.py')]);
}

/** As a program of its own that depends on the crate, with the versions and the built files of this checkout. */
function runRust({ folder, block }) {
  const home = join(root, 'out/guide-rust');
  mkdirSync(join(home, 'src'), { recursive: true });
  const manifest = ['[package]', 'name = "guide"', 'edition = "2024"', '', '[dependencies]', `veronese = { path = '${root}', features = ["codecs"] }`];
  // The profile of the workspace, so that what the native tests have built is used again.
  const profile = ['[profile.dev]', 'opt-level = 2', 'debug = "line-tables-only"'];
  writeFileSync(join(home, 'Cargo.toml'), [...manifest, '', ...profile, '', '[workspace]', ''].join('\n'));
  copyFileSync(join(root, 'Cargo.lock'), join(home, 'Cargo.lock'));
  writeFileSync(join(home, 'src/main.rs'), block.code);
  const target = process.env.CARGO_TARGET_DIR ?? join(root, 'target');
  const { status, stderr, error } = spawnSync('cargo', ['build', '--quiet', '--manifest-path', join(home, 'Cargo.toml')], {
    env: { ...environment, CARGO_TARGET_DIR: target },
    encoding: 'utf8',
    timeout: 15 * MINUTES,
  });
  if (error?.code === 'ENOENT') return { skip: 'there is no cargo' };
  if (status !== 0) throw new Error(error ? `cargo: ${error.code}` : stderr);
  return printed(folder, join(target, 'debug', 'guide'), []);
}

/** Under the strictest settings, with the types that the package installs. */
function checkTypes({ folder, block }) {
  const file = written(folder, block, `example.${block.language}`);
  const types = [];
  if (block.language === 'tsx') {
    const react = join(FRAMEWORKS, '@types/react');
    if (!existsSync(react)) return { skip: 'the types of React are not installed: `npm run soak -- hosts` does that' };
    for (const name of ['@types/react', 'csstype']) link(join(FRAMEWORKS, name), join(folder, 'node_modules', name.replace('@types/', '')));
    types.push('react');
  }
  const strict = { strict: true, exactOptionalPropertyTypes: true, noUncheckedIndexedAccess: true, noUnusedLocals: true, noEmit: true };
  const platform = { target: 'ES2022', lib: ['ES2022', 'DOM', 'DOM.Iterable', 'DOM.AsyncIterable'], module: 'ESNext', moduleResolution: 'Bundler' };
  const compilerOptions = { ...strict, ...platform, types: block.code.includes("'node:") ? ['node'] : types, jsx: 'react-jsx' };
  writeFileSync(join(folder, 'tsconfig.json'), JSON.stringify({ compilerOptions, files: [file] }));
  return printed(folder, TSC, ['-p', folder]);
}

/** Writes the code under its name, or another; returns the path. */
function written(folder, { code, file }, otherwise) {
  const path = join(folder, file ?? otherwise);
  mkdirSync(dirname(path), { recursive: true });
  writeFileSync(path, code);
  return path;
}

function link(from, to) {
  mkdirSync(dirname(to), { recursive: true });
  if (!existsSync(to)) symlinkSync(from, to);
}

function printed(folder, program, args, env = {}) {
  const options = { cwd: folder, encoding: 'utf8', timeout: 3 * MINUTES, env: { ...process.env, ...env } };
  const { status, signal, stdout, stderr } = spawnSync(program, args, options);
  if (status !== 0) throw new Error(`ended with ${signal ?? status}:\n${stdout}${stderr}`);
  return stdout + stderr;
}
