// `npm run release` refuses what must not be published. It runs in a copy of what its steps look at; nothing is compiled.

import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { cpSync, existsSync, mkdtempSync, readFileSync, rmSync, symlinkSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { describe, test } from 'node:test';
import { fileURLToPath } from 'node:url';
import { changelogState } from '../../../scripts/lib/release/changelog.mjs';

const root = fileURLToPath(new URL('../../..', import.meta.url));
const version = JSON.parse(readFileSync(join(root, 'package.json'), 'utf8')).version;
const today = new Date().toISOString().slice(0, 10);
/** Copied, because cases change them. */
const COPIES = ['scripts', '.github', 'CHANGELOG.md', 'Cargo.lock', 'Cargo.toml', 'LICENSE-APACHE', 'LICENSE-MIT', 'README.md', 'THIRD-PARTY-NOTICES'];
const MORE = ['package.json', 'package-lock.json', 'pkg/LICENSE-APACHE', 'pkg/LICENSE-MIT', 'pkg/THIRD-PARTY-NOTICES', 'pkg/package.json', 'pkg/wasm'];
/** Only looked at. */
const LINKS = ['benches', 'examples', 'experiments', 'node_modules', 'scenes', 'src', 'tests', 'www'];
const CRATES = ['python', 'wasm'];
const QUICK = 'versions,changelog,tree,licences';

function copyOfProject(t) {
  const folder = mkdtempSync(join(tmpdir(), 'veronese-release-test-'));
  t.after(() => rmSync(folder, { recursive: true, force: true }));
  for (const name of [...COPIES, ...MORE]) cpSync(join(root, name), join(folder, name), { recursive: true });
  for (const name of [...LINKS, ...CRATES.filter((crate) => existsSync(join(root, crate)))]) symlinkSync(join(root, name), join(folder, name));
  const path = (name) => join(folder, name);
  return {
    path,
    change(name, what, by) {
      const text = readFileSync(path(name), 'utf8');
      assert.ok(text.match(what), `${name} has ${what}`);
      writeFileSync(path(name), text.replace(what, by));
    },
    release(...args) {
      return spawnSync(process.execPath, [path('scripts/release.mjs'), ...args], { encoding: 'utf8' });
    },
    refuses(args, sentence) {
      const { status, stdout, stderr } = this.release(...args);
      assert.match(stderr, sentence);
      assert.equal(status, 1, stdout);
    },
  };
}

const DATED = `## [${version}] – ${today}`;
const HEADING = /^## .*$/m;

test('what is ready passes', (t) => {
  const project = copyOfProject(t);
  const { status, stderr } = project.release('--dry-run', '--only', QUICK);
  assert.equal(stderr, '');
  assert.equal(status, 0);
  project.change('CHANGELOG.md', HEADING, DATED);
  assert.equal(project.release('--dry-run', '--tag', `v${version}`, '--only', 'versions,changelog,licences').status, 0);
});

describe('refused are', () => {
  test('a version that differs in one file, and a tag of another version', (t) => {
    const project = copyOfProject(t);
    project.refuses(['--tag', 'v9.8.7', '--only', 'versions'], /The tag is v9\.8\.7/);
    project.change('pkg/package.json', `"version": "${version}"`, '"version": "9.8.7"');
    project.refuses(['--dry-run', '--only', QUICK], /9\.8\.7 in pkg\/package\.json/);
  });

  test('a licence that is missing, and notices of something else', (t) => {
    const project = copyOfProject(t);
    rmSync(project.path('pkg/LICENSE-MIT'));
    project.change('THIRD-PARTY-NOTICES', /^- nalgebra .*$/m, '- nalgebra 0.0.1: MIT');
    project.refuses(['--dry-run', '--only', QUICK], /pkg\/LICENSE-MIT is missing[^]*THIRD-PARTY-NOTICES: not of the packages that are used now/);
  });

  test('a changelog without a date', (t) => {
    const project = copyOfProject(t);
    project.change('CHANGELOG.md', HEADING, `## [${version}]`);
    project.refuses(['--dry-run', '--only', QUICK], /CHANGELOG\.md has no date/);
    project.change('CHANGELOG.md', HEADING, `## [${version}] – unreleased`);
    project.refuses(['--tag', `v${version}`, '--only', 'versions,changelog'], /unreleased: a release writes/);
    assert.equal(project.release('--dry-run', '--only', 'versions,changelog').status, 0, 'a rehearsal says so and goes on');
  });

  test('uncommitted files, for a tag', (t) => {
    const project = copyOfProject(t);
    project.refuses(['--tag', `v${version}`, '--only', 'tree'], /Not committed/);
  });

  test('a module that is not what was built, and builds that differ', (t) => {
    const project = copyOfProject(t);
    const builds = ['out/release/modules-1', 'out/release/modules-2'];
    for (const build of builds) cpSync(project.path('pkg/wasm'), project.path(build), { recursive: true });
    assert.equal(project.release('--dry-run', '--only', 'modules').status, 0);
    const flip = (name) => {
      const bytes = readFileSync(project.path(name));
      bytes[bytes.length >> 1] ^= 1;
      writeFileSync(project.path(name), bytes);
    };
    flip('pkg/wasm/veronese_bg.wasm');
    project.refuses(['--dry-run', '--only', 'modules'], /pkg\/wasm\/veronese_bg\.wasm is not what the last commit builds/);
    flip(`${builds[1]}/points/veronese_points_bg.wasm`);
    project.refuses(['--dry-run', '--only', 'modules'], /points\/veronese_points_bg\.wasm differs between two builds/);
    for (const build of builds) rmSync(project.path(build), { recursive: true });
    project.refuses(['--dry-run', '--only', 'modules'], /differs between two builds/);
  });

  test('calls that would publish from here, or that nobody knows', (t) => {
    const project = copyOfProject(t);
    for (const args of [[], ['--tag', '0.1.0'], ['--dry-run', '--only', 'luck'], ['--publish']]) assert.equal(project.release(...args).status, 2, args.join(' '));
  });
});

test('a section of the changelog is dated when its date is a day', () => {
  const state = (heading) => changelogState(`# Changelog\n\n${heading}\n\n## [0.0.1] – 2020-01-01\n`, '1.2.3', '2026-02-03');
  assert.deepEqual(state('## [1.2.3] – 2026-02-03'), {});
  assert.deepEqual(state('## 1.2.3 - 2026-02-03'), {});
  assert.match(state('## [Unreleased]').todo, /`## \[1\.2\.3\] – 2026-02-03`/);
  for (const wrong of ['## [1.2.3]', '## [1.2.3] – soon', '## [1.2.3] – 2026-02-30', '## [1.2.4] – 2026-02-03', '']) assert.ok(state(wrong).problem, wrong);
});
