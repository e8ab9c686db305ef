// What the program tells a person: help, suggestions, colour, and what it leaves out.
// cspell:ignore clpi davsi mtoions pipestatus shaard

import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { existsSync } from 'node:fs';
import { describe, test } from 'node:test';
import { frame, pair, png } from './support/frames.mjs';
import { entries, program, temporaryFolder, veronese } from './support/program.mjs';
import { cases } from './support/soak.mjs';

const OF_ALL = ['quiet', 'help', 'version'];
const OF_PAIRS = ['motions', 'quality', 'grouped', 'subject', 'mark-unknown', 'confidence', 'out', 'overlay', 'max-size', 'allow-damaged', 'force'];
const OPTIONS = {
  pair: OF_PAIRS,
  batch: [...OF_PAIRS, 'list', 'every', 'shard', 'jobs'],
  clip: ['list', 'every', 'motions', 'quality', 'look-ahead', 'masks', 'corrections', 'levels', 'subject', 'mark-unknown', 'max-size', 'jobs', 'out', 'overlay', 'show', 'frame-rate', 'allow-damaged', 'force'],
  convert: ['to', 'tolerance', 'background', 'grouped', 'image', 'from', 'until', 'shapes', 'video', 'frame-rate', 'clip', 'levels', 'first-frame', 'out', 'force'],
  points: ['motions', 'method', 'seed'],
};

async function shown(...args) {
  const { code, stdout, stderr } = await veronese(args);
  assert.deepEqual([code, stderr], [0, ''], args.join(' '));
  return stdout;
}

/** What a shell shows for a line that uses `veronese`, found as this program. */
function inShell(shell, script, { env = {}, cwd } = {}) {
  const found = spawnSync(shell, ['-c', script], { encoding: 'utf8', cwd, env: { ...process.env, NODE: process.execPath, PROGRAM: program, ...env }, timeout: 120_000 });
  assert.equal(found.error, undefined);
  return found;
}

function moving(t) {
  const folder = temporaryFolder(t);
  const [first, second] = pair();
  return { folder, first: folder.file('first.png', png(first)), second: folder.file('second.png', png(second)) };
}

describe('help', () => {
  for (const [command, options] of Object.entries(OPTIONS)) {
    test(`of ${command} has its options, no others, and examples that are right`, async () => {
      const text = await shown('help', command);
      for (const args of [[command, '--help'], [command, '-h'], ['-h', command], ['--help', command]]) assert.equal(await shown(...args), text);
      for (const option of options) assert.match(text, new RegExp(`^ +(-., )?--${option} `, 'm'));
      const listed = Array.from(text.matchAll(/^ +(?:-., )?--([\w-]+) /gm), ([, name]) => name).filter((name) => !OF_ALL.includes(name));
      assert.deepEqual(listed.sort(), options.toSorted());
      assert.ok(text.split('\n').every((line) => line.length <= 100), text);
      const examples = text.slice(text.indexOf('Examples:')).match(/(?<=^ +)veronese .*$/gm);
      for (const example of examples) {
        const { code, stderr } = await veronese(example.replace(/ >.*/, '').split(' ').slice(1));
        assert.notEqual(code, 2, `${example}\n${stderr}`);
      }
    });
  }

  test('is short for all commands, and whole on request', async () => {
    const text = await shown('help');
    assert.equal(await shown('-h'), text);
    for (const command of Object.keys(OPTIONS)) assert.match(text, new RegExp(`^ +${command} `, 'm'));
    assert.ok(text.split('\n').length < 30, text);
    const whole = await shown('--help');
    assert.ok(whole.startsWith(text.trimEnd()));
    for (const command of Object.keys(OPTIONS)) assert.ok(whole.includes(await shown('help', command)), command);
  });

  test('-v is the version', async () => {
    assert.match(await shown('-v'), /^veronese \d+\.\d+\.\d+\n$/);
    assert.equal(await shown('--version'), await shown('-v'));
  });
});

test('--quiet leaves results and errors', async (t) => {
  const folder = temporaryFolder(t);
  const still = folder.file('still.png', png(frame(0)));
  const { stderr } = await veronese(['pair', still, still]);
  assert.match(stderr, /^veronese: note: nothing moves/);
  const quiet = await veronese(['pair', still, still, '--quiet']);
  assert.deepEqual([quiet.code, quiet.stderr], [0, '']);
  assert.match(quiet.stdout, /^\{"version":1,/);
  // In short forms.
  const batch = await veronese(['batch', still, still, '-o', folder.path('out'), '-j2', '-q']);
  assert.deepEqual([batch.code, batch.stderr, entries(folder.path('out'))], [0, '', ['000000-still']]);
  const wrong = await veronese(['pair', '--quiet', still, folder.path('none.png')]);
  assert.match(wrong.stderr, /^veronese: error: file-not-found/);
});

describe('an error names', () => {
  const typos = [
    [['clpi', 'frames'], /there is no command 'clpi'; did you mean 'clip'\?/],
    [['pair', '--mtoions', '2', 'a', 'b'], /unknown option '--mtoions'; did you mean '--motions'\?/],
    [['pair', 'a', 'b', '--conf'], /unknown option '--conf'; did you mean '--confidence'\?/],
    [['pair', 'a', 'b', '--zzzzzz'], /unknown option '--zzzzzz'; see 'veronese help pair'/],
    [['clip', 'a', '--shaard', '1/2'], /unknown option '--shaard'; see 'veronese help clip'/],
    [['pair', 'a', 'b', '--out'], /option '--out' needs DIR; see 'veronese help pair'/],
    [['pair', 'a', 'b', '--out', '--overlay'], /option '--out' needs DIR/],
    [['convert', 'a', '--to', 'coco,davsi'], /there is no format 'davsi'; did you mean 'davis'\?/],
    [['pair', 'a', 'b', '--quality', 'fats'], /option '--quality' must be 'fast' or 'best', not 'fats'/],
    [['video', 'a.mp4'], /there is no command 'video'; did you mean 'batch'\?/],
    [['help', 'clop'], /there is no command 'clop'; did you mean 'clip'\?/],
  ];
  test('what was meant, and the value that is wanted', async () => {
    for (const [args, sentence] of typos) {
      const { code, stdout, stderr } = await veronese(args);
      assert.deepEqual([code, stdout], [2, '']);
      assert.match(stderr, sentence);
    }
  });

  test('the folder that is missing', async (t) => {
    const folder = temporaryFolder(t);
    const still = folder.file('still.png', png(frame(0)));
    const missing = folder.path('none');
    for (const args of [
      ['pair', still, `${missing}/deep/a.png`],
      ['batch', `${missing}/deep`],
      ['clip', `${missing}/deep`, '--out', folder.path('out')],
      ['clip', `${missing}/deep/a.mp4`, '--out', folder.path('out')],
      ['batch', '--list', `${missing}/list`],
      ['convert', `${missing}/deep`, '--to', 'coco'],
      ['points', `${missing}/points.json`],
    ]) {
      const { code, stderr } = await veronese(args);
      assert.equal(code, 1);
      assert.ok(stderr.startsWith(`veronese: error: file-not-found: there is no folder '${missing}'`), stderr);
    }
    const { stderr } = await veronese(['clip', missing, '--out', folder.path('out')]);
    assert.ok(stderr.startsWith(`veronese: error: file-not-found: there is no file or folder '${missing}'`), stderr);
    const empty = await veronese(['convert', folder.path('.'), '--to', 'coco']);
    assert.match(empty.stderr, /error: file-not-found: '.*' is not a folder of pair, batch or clip: it has no labels\.png and no tracks\.json/);
  });
});

describe('a closed pipe ends the program quietly with 0', { skip: process.platform === 'win32' }, () => {
  for (const args of cases(['--help', 'clip first.png second.png --out masks'], ['pair first.png second.png', 'batch first.png second.png first.png'])) {
    test(args, (t) => {
      const { folder } = moving(t);
      // What reads is gone before the program has started.
      const { stdout, stderr } = inShell('bash', `"$NODE" "$PROGRAM" ${args} | true; echo "\${PIPESTATUS[0]}"`, { cwd: folder.path('.') });
      assert.deepEqual([stdout, stderr], ['0\n', '']);
    });
  }
});

describe('colour', { skip: !existsSync('/usr/bin/script') }, () => {
  const onTerminal = (args, env) => inShell('bash', `script -qec '"$NODE" "$PROGRAM" ${args}' /dev/null`, { env: { TERM: 'xterm-256color', NO_COLOR: undefined, CI: undefined, ...env } }).stdout;
  for (const args of ['help', 'pear']) {
    test(`is on a terminal: ${args}`, () => assert.ok(onTerminal(args, {}).includes('\u001b['), 'coloured'));
    test(`is not with NO_COLOR or elsewhere: ${args}`, async () => {
      assert.ok(!onTerminal(args, { NO_COLOR: '1' }).includes('\u001b['));
      const { stdout, stderr } = await veronese([args]);
      assert.ok(!(stdout + stderr).includes('\u001b['));
    });
  }
});
