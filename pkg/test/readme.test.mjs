import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { existsSync, mkdirSync, readdirSync, readFileSync, symlinkSync, writeFileSync } from 'node:fs';
import { describe, test } from 'node:test';
import { fileURLToPath } from 'node:url';
import { describe as describePair } from '../../scripts/lib/describe.mjs';
import { frame, png } from './support/frames.mjs';
import { temporaryFolder, veronese } from './support/program.mjs';
import { examples } from './support/readme.mjs';
import { soaking } from './support/soak.mjs';

/** A project with the package and the files that the examples speak of. */
function project(t) {
  const folder = temporaryFolder(t);
  mkdirSync(folder.path('node_modules', '.bin'), { recursive: true });
  symlinkSync(fileURLToPath(new URL('..', import.meta.url)), folder.path('node_modules', 'veronese'));
  symlinkSync('../veronese/bin/veronese.js', folder.path('node_modules', '.bin', 'veronese'));
  mkdirSync(folder.path('frames'));
  for (let k = 0; k < 4; k++) writeFileSync(folder.path('frames', `f${k}.png`), png(frame(k / 2)));
  folder.file('first.png', png(frame(0)));
  folder.file('second.png', png(frame(1)));
  return folder;
}

/** `first` and `second` of an example, where it does not make them itself. */
const FRAMES = `
import { readFileSync as readFrame } from 'node:fs';
import { decodeImage as decodeFrame } from 'veronese/codecs';
const [first, second] = await Promise.all(['first.png', 'second.png'].map((name) => decodeFrame(readFrame(name))));
`;

describe('README.md', () => {
  const ofNode = examples('js node');
  for (const [index, code] of ofNode.entries()) {
    test(`example ${index + 1} for Node: ${code.split('\n').find((line) => /segment|decode/.test(line))}`, (t) => {
      const folder = project(t);
      const own = /const first\b|let first\b/.test(code);
      const file = folder.file('example.mjs', own ? code : FRAMES + code);
      const { status, stdout, stderr } = spawnSync(process.execPath, [file], { cwd: folder.path('.'), encoding: 'utf8', timeout: 120_000 });
      assert.equal(status, 0, stderr);
      if (code.includes('console.log')) assert.notEqual(stdout, '');
    });
  }

  test('there are such examples', () => assert.ok(ofNode.length >= 2));

  test('the commands', { skip: process.platform === 'win32' }, (t) => {
    const folder = project(t);
    const [commands] = examples('sh run');
    // npx itself is asked by the tests of the packed package.
    const env = { ...process.env, PATH: `${folder.path('node_modules', '.bin')}:${process.env.PATH}` };
    const { status, stderr } = spawnSync('sh', ['-e', '-c', `npx() { "$@"; }\n${commands}`], { cwd: folder.path('.'), env, encoding: 'utf8', timeout: 120_000 });
    assert.equal(status, 0, stderr);
    assert.ok(existsSync(folder.path('masks', 'overlay.png')));
    assert.deepEqual(readdirSync(folder.path('results')), ['.veronese', '000000-f0', '000001-f1', '000002-f2']);
    assert.equal(readFileSync(folder.path('lines.jsonl'), 'utf8').trim().split('\n').length, 3);
    assert.deepEqual(readdirSync(folder.path('tracked')), ['.clip', '.veronese', 'labels', 'overlay', 'tracks.json']);
    assert.match(readFileSync(folder.path('tracked', 'tracks.json'), 'utf8'), /"name":"box"/);
  });

  test('what the project says of its bundled pair is what comes out', { skip: !soaking && 'npm run soak -- package' }, async () => {
    const at = (name) => fileURLToPath(new URL(`../../${name}`, import.meta.url));
    const sample = (name) => at(`www/public/samples/intel-two-cars/${name}.png`);
    const { code, stdout } = await veronese(['pair', sample('first'), sample('second')]);
    assert.equal(code, 0);
    const found = JSON.parse(stdout);
    const withoutTimes = (text) => text.replace(/[\d,]+ ms/g, '… ms');
    const text = readFileSync(at('README.md'), 'utf8');
    const [, quoted] = /```text\n(.*? motions in .*?)\n```/s.exec(text);
    assert.equal(withoutTimes(quoted), withoutTimes(describePair(found)));
    // "2 and 3 are parts of the car on the left, which `--grouped` joins."
    const groups = found.motions.map(({ group }) => group);
    assert.equal(groups[2], groups[3]);
    assert.equal(new Set(groups).size, 3);
  });
});
