// node scripts/compare-installed.mjs PACKED.tgz [--write]: installs the packed package into a folder with spaces in its path, runs `pair`,
// `clip` and `convert` there and compares every file that they write with scripts/installed.json. It needs Node and npm alone, on Windows
// too. --write writes the hashes, after a change of results.

import { spawnSync } from 'node:child_process';
import { createHash } from 'node:crypto';
import { cpSync, mkdirSync, mkdtempSync, readFileSync, readdirSync, rmSync, statSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';

const HASHES = fileURLToPath(new URL('./installed.json', import.meta.url));
const SAMPLES = fileURLToPath(new URL('../www/public/samples/', import.meta.url));
const WINDOWS = process.platform === 'win32';
/** Two cars pass in these; few enough for some seconds. */
const FRAMES = [20, 26];

const [archive, ...options] = process.argv.slice(2);
if (archive === undefined || options.some((option) => option !== '--write')) {
  console.error('node scripts/compare-installed.mjs PACKED.tgz [--write]');
  process.exit(2);
}
const place = mkdtempSync(join(tmpdir(), 'veronese installed '));
try {
  const found = hashesOf(work(resolve(archive)));
  if (options.includes('--write')) writeFileSync(HASHES, `${JSON.stringify(found, null, 2)}\n`);
  process.exitCode = compare(JSON.parse(readFileSync(HASHES, 'utf8')), found);
} finally {
  rmSync(place, { recursive: true, force: true, maxRetries: 5 });
}

/** Installs the package, runs its commands as people write them on this system, and returns the folder of results. */
function work(tarball) {
  const project = join(place, 'a project');
  const results = join(project, 'the results');
  const frames = join(project, 'some frames');
  mkdirSync(frames, { recursive: true });
  writeFileSync(join(project, 'package.json'), '{ "name": "a-project", "private": true }\n');
  for (const name of ['first.png', 'second.png']) cpSync(join(SAMPLES, 'intel-two-cars', name), join(project, name));
  for (const name of readdirSync(join(SAMPLES, 'passing-cars', 'frames'))
    .sort()
    .slice(...FRAMES)) {
    cpSync(join(SAMPLES, 'passing-cars', 'frames', name), join(frames, name));
  }
  shell('npm', ['install', '--no-audit', '--no-fund', '--omit=dev', tarball], project);
  shell(join(project, 'node_modules', '.bin', 'veronese'), ['--version'], project);
  const veronese = (...args) => run(process.execPath, [join(project, 'node_modules', 'veronese', 'bin', 'veronese.js'), ...args], project);
  // Whole paths, which begin with a drive on Windows; a pattern; and paths from the current folder.
  veronese(
    'pair',
    join(project, 'first.png'),
    join(project, 'second.png'),
    '--quality',
    'fast',
    '--overlay',
    '--out',
    join(results, 'pair'),
  );
  veronese('clip', join(frames, '*.webp'), '--quality', 'fast', '--overlay', '--out', join('the results', 'clip'));
  veronese('convert', join('the results', 'pair'), '--to', 'coco,yolo', '--out', join(results, 'converted pair'));
  veronese('convert', join(results, 'clip'), '--to', 'cvat-video,mots,davis', '--out', join('the results', 'converted clip'));
  return results;
}

/** A program that is a script of the shell on Windows; there nobody else puts quotes around what has spaces. */
function shell(program, args, cwd) {
  if (!WINDOWS) return run(program, args, cwd);
  return run(
    `"${program}"`,
    args.map((arg) => `"${arg}"`),
    cwd,
    { shell: true },
  );
}

function run(program, args, cwd, how = {}) {
  console.log(`${program} ${args.join(' ')}`);
  const { status, stdout, stderr, error } = spawnSync(program, args, { cwd, encoding: 'utf8', ...how });
  if (status === 0) return;
  console.error(`${stdout ?? ''}${stderr ?? ''}${error?.message ?? ''}`);
  throw new Error(`ended with code ${status}`);
}

/** The hash of every file below a folder, except what the program keeps for itself in hidden ones, by paths with slashes. */
function hashesOf(folder) {
  const paths = readdirSync(folder, { recursive: true }).map((path) => String(path).replaceAll('\\', '/'));
  const files = paths.filter((path) => !/(^|\/)\./.test(path) && statSync(join(folder, path)).isFile()).sort();
  return Object.fromEntries(
    files.map((path) => [
      path,
      createHash('sha256')
        .update(lasting(path, readFileSync(join(folder, path))))
        .digest('hex'),
    ]),
  );
}

/** A file without what differs between two runs of the same version: times and versions are left out of JSON. */
function lasting(path, content) {
  if (!path.endsWith('.json')) return content;
  return JSON.stringify(JSON.parse(content), (key, value) => (key === 'milliseconds' || key === 'software' ? undefined : value));
}

function compare(wanted, found) {
  const names = [...new Set([...Object.keys(wanted), ...Object.keys(found)])].sort();
  const different = names.filter((name) => wanted[name] !== found[name]);
  for (const name of different) console.error(`${name}: ${!found[name] ? 'missing' : !wanted[name] ? 'not expected' : 'other bytes'}`);
  console.log(`${names.length - different.length} files have the expected bytes, ${different.length} do not.`);
  return different.length === 0 ? 0 : 1;
}
