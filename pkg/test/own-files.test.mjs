// Output folders: results go to a folder that is empty or ours; a file that `.veronese` there does not list is never replaced or deleted.

import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { appendFileSync, cpSync, existsSync, linkSync, mkdirSync, readFileSync, rmSync, symlinkSync, writeFileSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { describe, test } from 'node:test';
import { clipFolder } from './support/clip.mjs';
import { openClip } from 'veronese';
import { clip, results, tree } from './support/folders.mjs';
import { entries, veronese, veroneseProcess } from './support/program.mjs';
import { cases } from './support/soak.mjs';
import { signalledAt } from './support/stopping.mjs';

const skipWindows = process.platform === 'win32';

/** A folder of frames and a drawn clip, the commands that write to `out`, and a file in `out` of which each is a result. */
function made(t, count = 4) {
  const folder = clip(t, count);
  const { one, out, path, frames } = folder;
  clipFolder(path('drawn'), { frameRate: 25 });
  const commands = {
    pair: [['pair', one(0), one(1), '--quality', 'fast', '--out', out], 'labels.png'],
    batch: [['batch', frames, '--quality', 'fast', '--jobs', '1', '--out', out], '000001-f1/labels.png'],
    clip: [['clip', frames, '--quality', 'fast', '--out', out], 'labels/f1.png'],
    convert: [['convert', path('drawn'), '--to', 'yolo,coco', '--out', out], 'yolo/labels/f001.txt'],
    corrections: [['convert', path('drawn', 'coco.json'), '--to', 'corrections', '--out', out], 'edits.json'],
  };
  const place = (path, content = 'mine') => {
    mkdirSync(dirname(join(out, path)), { recursive: true });
    writeFileSync(join(out, path), content);
  };
  return { ...folder, commands, place };
}
const ALL = ['pair', 'batch', 'clip', 'convert'];

async function done(args) {
  const { code, stderr, stdout } = await veronese(args);
  assert.deepEqual([code, stderr], [0, ''], args.join(' '));
  return stdout;
}

/** The command names the file, prints no result, and leaves everything in the folder as it is. */
async function refused(args, out, path) {
  const before = tree(out);
  const answer = await veronese(args);
  assert.equal(answer.code, 1, `${args.join(' ')}\n${answer.stdout}${answer.stderr}`);
  assert.match(answer.stderr, /^veronese: error: file-exists: [^\n]*\n$/);
  assert.ok(answer.stderr.includes(`'${join(out, path)}'`), answer.stderr);
  assert.equal(answer.stdout, '', 'before any work');
  assert.deepEqual(tree(out), before);
}

describe('a folder that is not ours', () => {
  test('is refused before any work, with a file named; hidden files are no content', async (t) => {
    const { commands, out, path, place } = made(t);
    await done(['convert', path('drawn'), '--to', 'coco']);
    for (const [command, [args, result]] of Object.entries(commands)) {
      place('z.txt');
      await refused(args, out, 'z.txt');
      place(result);
      await refused(args, out, command === 'batch' ? '000001-f1' : command === 'convert' ? 'yolo' : result);
      rmSync(out, { recursive: true });
      place('.veronese', 'a list of mine');
      await refused(args, out, '.veronese');
      rmSync(out, { recursive: true });
      for (const name of ['.DS_Store', 'Thumbs.db']) place(name);
      await done(args);
      assert.equal(readFileSync(join(out, '.DS_Store'), 'utf8'), 'mine');
      rmSync(out, { recursive: true });
    }
    place('.clip/log');
    await refused(commands.clip[0], out, '.clip');
  });

  test('is ours with --force, which overwrites what is in the way and nothing else', async (t) => {
    const { commands, out, place } = made(t);
    for (const command of ALL) {
      const [args, result] = commands[command];
      for (const name of [result, 'mine.txt', '.veronese']) place(name);
      await done([...args, '--force']);
      assert.notEqual(readFileSync(join(out, result), 'utf8'), 'mine');
      assert.equal(readFileSync(join(out, 'mine.txt'), 'utf8'), 'mine');
      await done(args);
      rmSync(out, { recursive: true });
    }
  });

  test('is written to by convert where it is also what is read, but nothing there is replaced', async (t) => {
    const { path } = made(t);
    const [drawn, args] = [path('drawn'), ['convert', path('drawn'), '--to', 'coco,yolo']];
    mkdirSync(join(drawn, 'yolo', 'labels'), { recursive: true });
    writeFileSync(join(drawn, 'yolo', 'labels', 'f003.txt'), 'mine');
    await refused(args, drawn, 'yolo/labels/f003.txt');
    rmSync(join(drawn, 'yolo', 'labels', 'f003.txt'));
    await done(args);
    await done([...args, '--from', '3', '--until', '3']);
    assert.deepEqual(entries(join(drawn, 'yolo', 'labels')), ['f003.txt'], 'what an earlier run wrote is gone');
  });
});

describe('in our folder', () => {
  test('listed files are replaced and go, others are neither replaced nor deleted, also in a copy', async (t) => {
    const { commands, out, path, place } = made(t);
    for (const command of ALL) {
      const [args, result] = commands[command];
      await done(args);
      const files = tree(out);
      const mine = ['mine.txt', 'mask-x.png', 'labels/notes.txt', 'labels/g.png', '.clip/mine', '000001-f1/mine.txt', 'yolo/labels/g.txt'];
      for (const name of mine) place(name);
      rmSync(path('copy'), { recursive: true, force: true });
      cpSync(out, path('copy'), { recursive: true });
      appendFileSync(join(path('copy'), result), ' ');
      const inCopy = args.map((arg) => (arg === out ? path('copy') : arg));
      const other = command === 'convert' ? ['--from', '2'] : ['--overlay'];
      await done([...inCopy, ...other]);
      assert.notDeepEqual(Object.keys(tree(path('copy'))), Object.keys(tree(out)));
      await done(inCopy);
      // A pair's result has its times.
      for (const [name, content] of Object.entries(files)) if (name !== 'result.json') assert.equal(tree(path('copy'))[name], content, `${command}: ${name}`);
      for (const name of mine) assert.equal(readFileSync(join(path('copy'), name), 'utf8'), 'mine', name);
      assert.deepEqual(Object.keys(tree(path('copy'))), Object.keys(tree(out)), 'its own overlays go');
      rmSync(out, { recursive: true });
    }
  });

  test('a file that is not listed is in the way', async (t) => {
    const { commands, out, place } = made(t);
    const overlays = { pair: 'overlay.png', batch: '000001-f1/overlay.png', clip: 'overlay/f2.png' };
    for (const [command, overlay] of Object.entries(overlays)) {
      const [args] = commands[command];
      await done(args);
      place(overlay);
      await refused([...args, '--overlay'], out, overlay);
      await done(args);
      rmSync(out, { recursive: true });
    }
    await done(commands.convert[0]);
    place('mots/gt/gt.txt');
    await refused([...commands.convert[0], '--to', 'mots'], out, 'mots/gt/gt.txt');
  });

  test('no list leads to a file elsewhere, and no link', { skip: skipWindows }, async (t) => {
    const { commands: { pair: [args] }, out, path, file } = made(t);
    const outside = file('outside.png', 'theirs');
    await done([...args, '--overlay']);
    appendFileSync(join(out, '.veronese'), '\n../outside.png');
    rmSync(join(out, 'labels.png'));
    symlinkSync(outside, join(out, 'labels.png'));
    // A second name of a file of ours keeps its content.
    linkSync(join(out, 'mask-0.png'), path('kept.png'));
    const kept = readFileSync(path('kept.png'));
    await done([...args, '--motions', '1']);
    assert.deepEqual([readFileSync(outside, 'utf8'), readFileSync(path('kept.png'))], ['theirs', kept]);
    assert.notDeepEqual(readFileSync(join(out, 'mask-0.png')), kept);
    symlinkSync(path('nowhere'), join(out, 'overlay.png'));
    await refused([...args, '--overlay'], out, 'overlay.png');
  });

  test('what is read is not overwritten, even with --force', async (t) => {
    const { commands: { pair: [pair], clip: [clip] }, out } = made(t);
    await done([...clip, '--overlay']);
    await refused(['clip', join(out, 'overlay'), '--quality', 'fast', '--overlay', '--force', '--out', out], out, 'overlay/f0.png');
    // Painted in place.
    await refused([...clip, '--corrections', join(out, 'labels')], out, 'labels/f0.png');
    rmSync(out, { recursive: true });
    await done([...pair, '--overlay']);
    await refused(['pair', join(out, 'overlay.png'), join(out, 'overlay.png'), '--overlay', '--force', '--out', out], out, 'overlay.png');
  });

  test('a pipe in the place of a result keeps nobody waiting', { skip: spawnSync('mkfifo', ['--version']).status !== 0 && 'there is no mkfifo' }, async (t) => {
    const { commands, out } = made(t);
    for (const [command, pipe] of [['pair', 'labels.png'], ['pair', '.veronese'], ['batch', '000000-f0/result.json'], ['clip', 'tracks.json'], ['clip', '.clip/log']]) {
      mkdirSync(dirname(join(out, pipe)), { recursive: true });
      assert.equal(spawnSync('mkfifo', [join(out, pipe)]).status, 0);
      const { code, stderr } = await veronese(commands[command][0]);
      assert.deepEqual([code, stderr.slice(0, 31)], [1, 'veronese: error: file-exists: \''], pipe);
      rmSync(out, { recursive: true });
    }
  });
});

describe('interrupted runs', { skip: skipWindows }, () => {
  test('know what they wrote, wherever they end, and end as a straight run does', async (t) => {
    const folder = made(t);
    const { commands, out } = folder;
    // What convert writes, pair writes in the same way.
    for (const command of ['batch', 'clip', 'convert']) {
      const [args] = commands[command];
      const other = command === 'convert' ? [...args, '--from', '2'] : [...args, '--motions', '2'];
      await done(args);
      const [expected, names] = [results(out), Object.keys(tree(out))];
      rmSync(out, { recursive: true });
      const ends = (first, places) => places.map(([n, when]) => [first, n, when]);
      const few = [[undefined, 3, 'after'], [other, 1, 'after']];
      const more = [[1, 'before'], [2, 'before'], [4, 'before'], [5, 'after']];
      for (const [first, n, when] of cases(few, [...ends(undefined, [[1, 'after'], ...more]), ...ends(other, [[3, 'after'], ...more])])) {
        if (first) await done(first);
        const { signal } = await veroneseProcess(args, signalledAt(folder, 'SIGKILL', { n, when }));
        assert.ok(signal === 'SIGKILL' || n > 3, `${command} ${n} ${when}`);
        await done(args);
        assert.deepEqual([results(out), Object.keys(tree(out))], [expected, names], 'the files of a straight run, and nothing half-written');
        rmSync(out, { recursive: true });
      }
    }
  });

  test('of a clip name a new file in their way', async (t) => {
    const folder = made(t);
    const { commands, out, place } = folder;
    const args = [...commands.clip[0], '--look-ahead', '0'];
    const { signal } = await veroneseProcess(args, signalledAt(folder, 'SIGKILL', { path: /f2\.png$/ }));
    assert.ok(signal === 'SIGKILL' && existsSync(join(out, 'labels', 'f0.png')) && !existsSync(join(out, 'tracks.json')));
    place('labels/f3.png');
    await refused(args, out, 'labels/f3.png');
    rmSync(join(out, 'labels', 'f3.png'));
    // One that comes while it is worked on stays.
    const { code, stderr } = await veronese(args, { onLine: () => place('tracks.json') });
    assert.equal(code, 1);
    assert.match(stderr, /^veronese: error: file-exists: [^\n]*tracks\.json' /);
    assert.equal(readFileSync(join(out, 'tracks.json'), 'utf8'), 'mine');
    rmSync(join(out, 'tracks.json'));
    await done(args);
  });
});

test('a run of clip that comes to the folder of another one is refused', async (t) => {
  const { commands: { clip: [args] }, out } = made(t);
  await done(args);
  const other = await openClip({ length: 4, read: () => undefined }, { journal: join(out, '.clip', 'log') });
  const before = tree(out);
  const { code, stderr } = await veronese([...args, '--overlay']);
  assert.deepEqual([code, stderr], [1, `veronese: error: write-failed: the results cannot be written into '${out}': another run is writing there\n`]);
  assert.deepEqual(tree(out), before);
  await other.close();
  await done([...args, '--overlay']);
});

test('two batches into one folder at once both end well', async (t) => {
  const { commands: { batch: [args] }, out } = made(t, 5);
  for (const { code, stderr } of await Promise.all([veroneseProcess(args), veroneseProcess(args)])) assert.deepEqual([code, stderr], [0, '']);
  await done(args);
  assert.equal(entries(out).length, 4);
});
