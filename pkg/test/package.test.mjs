import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { readFileSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { describe, test } from 'node:test';
import { fileURLToPath } from 'node:url';
import { gzipSync } from 'node:zlib';
import { segmentPair, version } from 'veronese';
import { pair } from './support/frames.mjs';

const folder = fileURLToPath(new URL('..', import.meta.url));
const read = (path) => readFileSync(join(folder, path));
const manifest = JSON.parse(read('package.json'));

test('one version everywhere', async () => {
  assert.equal(version, manifest.version);
  assert.equal(read('../Cargo.toml').toString().match(/^version = "([^"]+)"/m)[1], version);
  assert.equal((await segmentPair(...pair())).settings.software, `veronese ${version}`);
});

describe('npm pack', () => {
  const { stdout, stderr } = spawnSync('npm', ['pack', '--dry-run', '--json', '--ignore-scripts'], {
    cwd: folder,
    encoding: 'utf8',
    shell: process.platform === 'win32',
  });
  const [{ files }] = JSON.parse(stdout || `[{"files": [], "error": ${JSON.stringify(stderr)}}]`);
  const names = files.map(({ path }) => path);

  test('holds everything that package.json names', () => {
    const targets = (entry) => (typeof entry === 'string' ? [entry] : Object.values(entry).flatMap(targets));
    const wanted = [...targets(manifest.exports), ...targets(manifest.bin), manifest.types];
    for (const path of wanted) assert.ok(names.includes(path.replace(/^\.\//, '')), path);
    for (const path of ['README.md', 'dist/worker.js', 'dist/worker-node.js', 'dist/cli-work.js']) {
      assert.ok(names.includes(path), path);
    }
    assert.ok(names.includes('wasm/codecs/veronese_codecs_bg.wasm'));
  });

  test('holds every file that another one imports or points to', () => {
    for (const name of names.filter((path) => /^(dist|bin)\/.*\.js$/.test(path))) {
      const text = read(name).toString();
      const places = [...text.matchAll(/(?:from |import |import\(|new URL\()(['"])(\.[^'"]+)\1/g)].map(([, , place]) => join(dirname(name), place));
      for (const place of places) assert.ok(names.includes(place.replaceAll('\\', '/')), `${name} names ${place}`);
    }
  });

  test('holds nothing else', () => {
    for (const name of names) assert.match(name, /^(package\.json|custom-elements\.json|README\.md|LICENSE-(MIT|APACHE)|THIRD-PARTY-NOTICES|(bin|dist(\/formats)?)\/[\w-]+\.js|types\/[\w.-]+\.d\.ts|schemas\/\w+\.schema\.json|wasm\/.*_bg\.wasm)$/);
  });
});

test('sizes stay within their budgets', () => {
  const zipped = (path) => gzipSync(read(path), { level: 9 }).length;
  const core = zipped('wasm/veronese_bg.wasm');
  assert.ok(core <= 278 * 1024, `the core module has ${core} bytes`);
  const points = zipped('wasm/points/veronese_points_bg.wasm');
  assert.ok(points <= 66 * 1024, `the module of measurements has ${points} bytes`);
  for (const [entry, kilobytes] of [['web', 22], ['element', 33]]) {
    const scripts = loadedBy(`dist/${entry}.js`);
    assert.ok(scripts.size > 1, 'the imports are found');
    const bytes = [...scripts].reduce((sum, name) => sum + zipped(name), 0);
    assert.ok(bytes <= kilobytes * 1024, `the JavaScript of ${entry} has ${bytes} bytes`);
  }
});

test('the worker of browsers is one file: bundlers that copy files copy it alone', () => {
  assert.ok(!/\bimport *[({"'`]|\bfrom *["'`]/.test(read('dist/worker.js').toString()));
});

test('the element loads the code for clips when there is one', () => {
  const scripts = loadedBy('dist/element.js');
  assert.ok(!scripts.has('dist/element-later.js') && !scripts.has('dist/png-writer.js'));
  assert.match(read('dist/element-class.js').toString(), /import\("\.\/element-later\.js"\)/);
});

/** A script and everything that a browser loads with it. */
function loadedBy(name, scripts = new Set()) {
  if (scripts.has(name)) return scripts;
  scripts.add(name);
  for (const [, place] of read(name).toString().matchAll(/^(?:import|export) .*? from "(\.[^"]+)";$/gm)) loadedBy(join(dirname(name), place), scripts);
  return scripts;
}

test("the modules do not hold the builder's folders", () => {
  const home = process.env.HOME;
  for (const path of ['wasm/veronese_bg.wasm', 'wasm/points/veronese_points_bg.wasm', 'wasm/codecs/veronese_codecs_bg.wasm']) {
    const text = read(path).toString('latin1');
    assert.ok(!text.includes('/.cargo/'), path);
    if (home && home.length > 1) assert.ok(!text.includes(`${home}/`), path);
  }
});
