// The script that compares what an installed package writes on other systems finds the same bytes here, and notices others.

import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { copyFileSync, mkdirSync, mkdtempSync, readFileSync, rmSync, symlinkSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { test } from 'node:test';
import { fileURLToPath } from 'node:url';
import { install } from '../packed/packed.mjs';

const root = fileURLToPath(new URL('../../..', import.meta.url));

test('an installed package writes the expected bytes, in folders with spaces too; other bytes are named', (t) => {
  const { tarball, remove } = install();
  t.after(remove);
  const copy = mkdtempSync(join(tmpdir(), 'veronese-compare-'));
  t.after(() => rmSync(copy, { recursive: true, force: true }));
  mkdirSync(join(copy, 'scripts'));
  mkdirSync(join(copy, 'www/public'), { recursive: true });
  symlinkSync(join(root, 'www/public/samples'), join(copy, 'www/public/samples'));
  for (const name of ['compare-installed.mjs', 'installed.json']) copyFileSync(join(root, 'scripts', name), join(copy, 'scripts', name));
  const hashes = JSON.parse(readFileSync(join(copy, 'scripts/installed.json'), 'utf8'));
  const names = Object.keys(hashes);
  for (const start of ['pair/', 'clip/', 'converted pair/', 'converted clip/']) assert.ok(names.some((name) => name.startsWith(start)), start);
  const labels = names.filter((name) => name.startsWith('clip/labels/')).map((name) => hashes[name]);
  assert.equal(new Set(labels).size, labels.length, 'something moves');

  writeFileSync(join(copy, 'scripts/installed.json'), JSON.stringify({ ...hashes, 'pair/labels.png': 'another', 'pair/more.png': 'gone' }));
  const { status, stdout, stderr } = spawnSync(process.execPath, [join(copy, 'scripts/compare-installed.mjs'), tarball], { encoding: 'utf8' });
  assert.equal(stderr, 'pair/labels.png: other bytes\npair/more.png: missing\n');
  assert.match(stdout, new RegExp(`^${names.length - 1} files have the expected bytes, 2 do not\\.$`, 'm'));
  assert.equal(status, 1);
});
