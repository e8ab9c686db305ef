// Output folders with files of others: no command replaces or deletes what it did not write.

import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { createHash } from 'node:crypto';
import { appendFileSync, cpSync, existsSync, linkSync, mkdirSync, readFileSync, renameSync, rmSync, statSync, symlinkSync, writeFileSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { describe, test } from 'node:test';
import { clipFolder } from './support/clip.mjs';
import { clip, tree } from './support/folders.mjs';
import { entries, temporaryFolder, veronese, veroneseProcess } from './support/program.mjs';
import { cases, soaking } from './support/soak.mjs';
import { signalledAt } from './support/stopping.mjs';

const COUNT = 4;
const skipWindows = process.platform === 'win32';

function made(t, count = COUNT) {
  const folder = clip(t, count);
  const { one, out } = folder;
  const commands = {
    pair: ['pair', one(0), one(1), '--quality', 'fast', '--out', out],
    batch: ['batch', folder.frames, '--quality', 'fast', '--jobs', '1', '--out', out],
    clip: ['clip', folder.frames, '--quality', 'fast', '--out', out],
  };
  const place = (path, content) => {
    mkdirSync(dirname(join(out, path)), { recursive: true });
    writeFileSync(join(out, path), content);
    return join(out, path);
  };
  return { ...folder, commands, place };
}

async function done(args) {
  const { code, stderr, stdout } = await veronese(args);
  assert.equal(stderr, '');
  assert.equal(code, 0);
  return stdout;
}

/** The command names the file, prints no result, and leaves everything in the folder as it is. */
async function refused(args, out, path, code = 'file-exists') {
  const before = tree(out);
  const answer = await veronese(args);
  assert.equal(answer.code, 1, `${args.join(' ')}\n${answer.stdout}${answer.stderr}`);
  assert.match(answer.stderr, new RegExp(`^veronese: error: ${code}: [^\\n]*\n$`));
  assert.ok(answer.stderr.includes(`'${join(out, path)}'`), answer.stderr);
  assert.equal(answer.stdout, '', 'before any work');
  assert.deepEqual(tree(out), before);
}

describe('files of others', () => {
  const places = {
    pair: ['labels.png', 'result.json', 'mask-0.png', 'mask-9.png'],
    batch: ['000002-f2/labels.png', '000002-f2/result.json', '000000-f0/mask-1.png'],
    clip: ['labels/f3.png', 'tracks.json', '.clip/state', '.clip/00001.pairs'],
  };
  for (const [command, paths] of Object.entries(places)) {
    test(`${command} names them before any work`, async (t) => {
      const { commands, out, place } = made(t);
      for (const path of paths) {
        place(path, '{"mine": true}');
        place('mine.txt', 'mine');
        await refused(commands[command], out, path);
        rmSync(out, { recursive: true });
      }
      for (const path of ['overlay.png', '000001-f1/overlay.png', 'overlay/f2.png']) place(path, 'mine');
      const [theirs] = { pair: ['overlay.png'], batch: ['000001-f1/overlay.png'], clip: ['overlay/f2.png'] }[command];
      await refused([...commands[command], '--overlay'], out, theirs);
      await done(commands[command]);
      for (const path of ['overlay.png', '000001-f1/overlay.png', 'overlay/f2.png']) assert.equal(readFileSync(join(out, path), 'utf8'), 'mine', path);
    });

    test(`${command} leaves other files in the folder alone, and runs again`, async (t) => {
      const { commands, out, place } = made(t);
      const mine = ['mine.txt', 'mask-x.png', 'labels/notes.txt', 'labels/g.png', '.clip/mine', '000001-f1/mine.txt'];
      for (const path of mine) place(path, 'mine');
      await done(commands[command]);
      await done([...commands[command], '--overlay']);
      await done(commands[command]);
      for (const path of mine) assert.equal(readFileSync(join(out, path), 'utf8'), 'mine', path);
      assert.ok(!entries(out).some((name) => name.startsWith('overlay')), 'its own overlays go');
    });

    test(`${command} does not overwrite a file of its own that was edited since, unless it is told to`, async (t) => {
      const { commands, out, place } = made(t);
      await done(commands[command]);
      const path = { pair: 'labels.png', batch: '000001-f1/labels.png', clip: 'labels/f1.png' }[command];
      const before = readFileSync(join(out, path));
      appendFileSync(join(out, path), 'a stroke');
      await refused([...commands[command], '--mark-unknown'], out, path);
      await refused(commands[command], out, path);
      place('mine.txt', 'mine');
      await done([...commands[command], '--force']);
      assert.deepEqual(readFileSync(join(out, path)), before);
      assert.equal(readFileSync(join(out, 'mine.txt'), 'utf8'), 'mine', 'what is not in the way stays');
      await done(commands[command]);
    });

    test(`${command} trusts no list that is damaged, and loses nothing in a copied folder`, async (t) => {
      const { commands, out, path, place } = made(t);
      await done(commands[command]);
      cpSync(out, path('copy'), { recursive: true });
      rmSync(out, { recursive: true });
      renameSync(path('copy'), out);
      await done([...commands[command], '--overlay']);
      const at = command === 'batch' ? '000000-f0/' : '';
      const [list, file] = [`${at}.veronese`, { clip: 'labels/f0.png' }[command] ?? `${at}labels.png`];
      const name = file.slice(at.length);
      place(list, readFileSync(join(out, list), 'utf8').replace(new RegExp(`^.*  ${name}$`, 'm'), `${'0'.repeat(64)}  ${name}`));
      await refused(commands[command], out, file);
      place(list, 'a list of mine');
      await refused(commands[command], out, list);
      await done([...commands[command], '--force', '--mark-unknown']);
      await done(commands[command]);
    });
  }

  test('frames that are in the place of results', async (t) => {
    const { commands, out, place, one } = made(t);
    for (let k = 0; k < COUNT; k++) place(`overlay/f${k}.png`, readFileSync(one(k)));
    await refused(['clip', join(out, 'overlay'), '--quality', 'fast', '--overlay', '--out', out], out, 'overlay/f0.png');
    rmSync(out, { recursive: true });
    // The program's own images, once they are frames, as well.
    await done([...commands.clip, '--overlay']);
    await refused(['clip', join(out, 'overlay'), '--quality', 'fast', '--overlay', '--out', out], out, 'overlay/f0.png');
    rmSync(out, { recursive: true });
    await done([...commands.pair, '--overlay']);
    await refused(['pair', join(out, 'overlay.png'), join(out, 'overlay.png'), '--overlay', '--force', '--out', out], out, 'overlay.png');
  });

  test('corrections that are the labels themselves', async (t) => {
    const { commands, out } = made(t);
    await done(commands.clip);
    await refused([...commands.clip, '--corrections', join(out, 'labels')], out, 'labels/f0.png');
  });

  test('links are no files of ours', { skip: skipWindows }, async (t) => {
    const { commands, out, path, one } = made(t);
    mkdirSync(out);
    symlinkSync(one(2), join(out, 'labels.png'));
    await refused(commands.pair, out, 'labels.png');
    rmSync(out, { recursive: true });
    mkdirSync(out);
    symlinkSync(path('nowhere'), join(out, 'labels.png'));
    await refused(commands.pair, out, 'labels.png');
    // A second name of a file of ours keeps its content.
    rmSync(out, { recursive: true });
    await done(commands.pair);
    linkSync(join(out, 'labels.png'), path('kept.png'));
    const kept = readFileSync(path('kept.png'));
    await done([...commands.pair, '--motions', '1']);
    assert.deepEqual(readFileSync(path('kept.png')), kept);
    assert.notDeepEqual(readFileSync(join(out, 'labels.png')), kept);
    // Nor does a list lead elsewhere.
    const outside = path('outside.png');
    writeFileSync(outside, 'theirs');
    appendFileSync(join(out, '.veronese'), `${createHash('sha256').update('theirs').digest('hex')}  ../outside.png\n`);
    await done(commands.pair);
    assert.equal(readFileSync(outside, 'utf8'), 'theirs');
  });

  test('a pipe in the place of a result keeps nobody waiting', { skip: spawnSync('mkfifo', ['--version']).status !== 0 && 'there is no mkfifo' }, async (t) => {
    const { commands, out } = made(t);
    for (const [command, pipes] of [
      ['pair', ['result.json', 'labels.png', '.veronese']],
      ['batch', ['000000-f0/result.json', '000000-f0/labels.png']],
      ['clip', ['tracks.json', 'labels/f0.png', '.clip/state']],
    ]) {
      for (const pipe of pipes) {
        mkdirSync(dirname(join(out, pipe)), { recursive: true });
        assert.equal(spawnSync('mkfifo', [join(out, pipe)]).status, 0);
        const { code, stderr } = await veronese(commands[command]);
        assert.equal(code, 1, stderr);
        assert.match(stderr, /^veronese: error: file-exists: /, pipe);
        rmSync(out, { recursive: true });
      }
    }
  });
});

describe('convert', () => {
  const names = {
    coco: 'coco.json',
    mots: 'mots/gt/gt.txt',
    davis: 'davis/Annotations/480p/clip/f003.png',
    masks: 'masks/1/f003.png',
  };

  test('replaces files that it wrote, and no others', async (t) => {
    const folder = temporaryFolder(t);
    const clip = folder.path('clip');
    clipFolder(clip, { frameRate: 25 });
    for (const [format, name] of Object.entries(names)) {
      const args = ['convert', clip, '--to', `yolo,${format}`];
      const place = join(clip, name);
      mkdirSync(dirname(place), { recursive: true });
      writeFileSync(place, 'mine');
      await refused(args, clip, name);
      rmSync(place);
      writeFileSync(join(dirname(place), 'mine.txt'), 'mine');
      await done(args);
      await done([...args, '--from', '3', '--until', '3']);
      assert.equal(readFileSync(join(dirname(place), 'mine.txt'), 'utf8'), 'mine');
      assert.deepEqual(entries(join(clip, 'yolo', 'labels')), ['f003.txt'], 'what an earlier run wrote is gone');
      appendFileSync(place, ' ');
      await refused(args, clip, name);
      rmSync(place);
    }
  });

  test('of a pair, whose files stay known', async (t) => {
    const { commands, out, place } = made(t);
    await done(commands.pair);
    place('yolo-names.txt', 'mine');
    await refused(['convert', out, '--to', 'coco,yolo'], out, 'yolo-names.txt');
    await done(['convert', out, '--to', 'coco']);
    await done(['convert', out, '--to', 'coco', '--image', 'a.png']);
    await done([...commands.pair, '--motions', '1']);
    await done(['convert', out, '--to', 'coco']);
    place('coco.json', '{}');
    await refused(['convert', out, '--to', 'coco'], out, 'coco.json');
    await done(['convert', out, '--to', 'coco', '--force']);
  });
});

describe('interrupted runs', { skip: skipWindows }, () => {
  /** The files that a run leaves in an empty folder. */
  async function straight(args, out) {
    await done(args);
    const files = tree(out);
    rmSync(out, { recursive: true });
    return files;
  }

  test('know what they wrote, wherever they end, and end as a straight run does', async (t) => {
    const folder = made(t);
    const { commands, out, path } = folder;
    clipFolder(path('drawn'));
    // What convert writes, pair writes in the same way.
    const { batch, clip } = commands;
    const all = { batch, clip, convert: ['convert', path('drawn'), '--to', 'yolo,coco', '--out', out] };
    for (const [command, args] of Object.entries(all)) {
      const other = command === 'convert' ? [...args, '--from', '2'] : [...args, '--motions', '2'];
      const expected = await straight(args, out);
      const ends = (first, places) => places.map(([n, when]) => [first, n, when]);
      const few = [[undefined, 3, 'after'], [other, 1, 'after']];
      const more = [[1, 'before'], [2, 'before'], [4, 'before'], [5, 'after']];
      for (const [first, n, when] of cases(few, [...ends(undefined, [[1, 'after'], ...more]), ...ends(other, [[3, 'after'], ...more])])) {
        if (first) await done(first);
        const { signal } = await veroneseProcess(args, signalledAt(folder, 'SIGKILL', { n, when }));
        assert.ok(signal === 'SIGKILL' || n > 3, `${command} ${n} ${when}`);
        const again = await veronese(args);
        assert.deepEqual([again.code, again.stderr], [0, ''], `${command} ${n} ${when} ${Boolean(first)}`);
        assert.deepEqual(entries(out).filter((name) => name.startsWith('.veronese-')), [], 'nothing half-written stays');
        assert.deepEqual(tree(out), expected, 'the files of a straight run');
        rmSync(out, { recursive: true });
      }
    }
  });

  test('of a clip leave files of others alone, and name a new one in their way', async (t) => {
    const folder = made(t);
    const { commands, out, place } = folder;
    const args = [...commands.clip, '--look-ahead', '0'];
    const { signal } = await veroneseProcess(args, signalledAt(folder, 'SIGKILL', { path: /f2\.png$/ }));
    assert.equal(signal, 'SIGKILL');
    assert.ok(existsSync(join(out, 'labels', 'f0.png')) && !existsSync(join(out, 'tracks.json')));
    place('labels/f3.png', 'mine');
    await refused(args, out, 'labels/f3.png');
    rmSync(join(out, 'labels', 'f3.png'));
    await done(args);
  });
});

describe('at once', () => {
  test('two batches into one folder both end well', async (t) => {
    const { commands, out } = made(t, 5);
    const runs = await Promise.all([veroneseProcess(commands.batch), veroneseProcess(commands.batch)]);
    for (const { code, stderr } of runs) assert.deepEqual([code, stderr], [0, '']);
    await done(commands.batch);
    assert.equal(entries(out).length, 4);
  });

  test('a file that comes into the way while a clip is worked on stays', { skip: skipWindows }, async (t) => {
    const { commands, out, place } = made(t);
    const { code, stderr } = await veronese([...commands.clip, '--look-ahead', '0'], { onLine: () => place('tracks.json', 'mine') });
    assert.equal(code, 1);
    assert.match(stderr, /^veronese: error: file-exists: [^\n]*tracks\.json' /);
    assert.equal(readFileSync(join(out, 'tracks.json'), 'utf8'), 'mine');
  });
});

test('a folder of many files is looked through in seconds', async (t) => {
  const folder = temporaryFolder(t);
  const clip = folder.path('clip');
  const frames = Array.from({ length: soaking ? 3000 : 60 }, () => new Uint8Array(64).fill(1, 9, 12));
  clipFolder(clip, { frames, width: 8, height: 8 });
  const seconds = async () => {
    const run = await veronese(['convert', clip, '--to', 'yolo']);
    assert.equal(run.code, 0, run.stderr);
    return run.seconds;
  };
  const first = await seconds();
  const again = await seconds();
  assert.ok(again < 2 * first + 5, `${first} s, then ${again} s`);
  assert.equal(statSync(join(clip, '.veronese')).size < 300 * frames.length, true, 'the list does not grow with each run');
});
