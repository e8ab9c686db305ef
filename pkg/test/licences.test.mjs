// The archives that are published, opened: they hold the licences, also of what others wrote.

import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { readdirSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';
import { fileURLToPath } from 'node:url';
import { temporaryFolder } from './support/program.mjs';

const root = fileURLToPath(new URL('../..', import.meta.url));
const LICENCES = ['LICENSE-MIT', 'LICENSE-APACHE'];
/** Others' works are in what is compiled or bundled, not in the crate's sources. */
const NOTICES = 'THIRD-PARTY-NOTICES';

function run(program, args, cwd = root) {
  const { status, stdout, stderr } = spawnSync(program, args, { cwd, encoding: 'utf8', shell: process.platform === 'win32' });
  assert.equal(status, 0, stderr);
  return stdout;
}

/** Unpacks the archive, which has one folder, and looks into it. */
function check(archive, folder, names) {
  run('tar', ['-xzf', archive, '--strip-components', '1', '-C', folder]);
  for (const name of names) {
    assert.equal(readFileSync(join(folder, name), 'utf8'), readFileSync(join(root, name), 'utf8'), name);
  }
}

test('the notices name what is shipped, and hold its licences', () => {
  const text = readFileSync(join(root, NOTICES), 'utf8');
  const { packages } = JSON.parse(readFileSync(join(root, 'package-lock.json'), 'utf8'));
  const lock = readFileSync(join(root, 'Cargo.lock'), 'utf8');
  const version = (name) => new RegExp(`name = "${name}"\\nversion = "([^"]+)"`).exec(lock)[1];
  for (const [name, number] of [
    ...['nalgebra', 'libm', 'wasm-bindgen', 'moxcms', 'png', 'simba'].map((name) => [name, version(name)]),
    ...['@rgrove/parse-xml', 'fflate', 'mediabunny'].map((name) => [name, packages[`node_modules/${name}`].version]),
  ]) {
    assert.ok(text.includes(`- ${name} ${number}: `), name);
    assert.match(text, new RegExp(`^-{80}\\n.*(?<!\\w)${name} ${number.replaceAll('.', '\\.')}\\b`, 'm'), `${name} has a text`);
  }
  const licences = ['Permission is hereby granted', 'Redistribution and use in source', 'Apache License', 'Mozilla Public License'];
  for (const licence of licences) assert.ok(text.includes(licence), licence);
  for (const name of ['criterion', 'proptest', 'plotters', 'typescript']) assert.ok(!text.includes(`- ${name} `), `${name} is not shipped`);
  assert.doesNotMatch(text, /\/home\/|\/root\/|\.cargo|node_modules|registry|crates\.io|npmjs/);
});

test('the npm package', (t) => {
  const folder = temporaryFolder(t).path();
  const [{ filename }] = JSON.parse(run('npm', ['pack', '--json', '--ignore-scripts', '--pack-destination', folder], join(root, 'pkg')));
  check(join(folder, filename), folder, [...LICENCES, NOTICES]);
});

test('the crate', (t) => {
  const folder = temporaryFolder(t).path();
  run('cargo', ['package', '--locked', '--offline', '--no-verify', '--allow-dirty', '--quiet', '--target-dir', folder]);
  const archives = join(folder, 'package');
  check(join(archives, readdirSync(archives).find((name) => name.endsWith('.crate'))), folder, LICENCES);
});
