import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { existsSync, mkdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { describe, test } from 'node:test';
import { segmentPair } from 'veronese';
import { byNumbers, findFrames } from '../build/cli/frames.js';
import { progressBar } from '../build/cli/terminal.js';
import { enter, notesOnVideo, pixmaps } from '../build/cli/video.js';
import { clip as framesOf, lines, tree } from './support/folders.mjs';
import { frame, png, ppm } from './support/frames.mjs';
import { entries, temporaryFolder, veronese, veroneseProcess } from './support/program.mjs';
import { cases } from './support/soak.mjs';
import { signalledAt } from './support/stopping.mjs';
import { checkPair, timeless } from './support/shapes.mjs';

/** The k-th frame of a small clip. */
const clipFrame = (k, size) => frame(k / 2, size);
const clip = (t, count, size) => framesOf(t, count, (k) => clipFrame(k, size));

async function batch(args, { code = 0, ...options } = {}) {
  const run = await veronese(['batch', '--quality', 'fast', ...args], options);
  assert.equal(run.code, code, run.stderr);
  if (code === 0) assert.equal(run.stderr, '', 'nothing on stderr where nobody looks');
  return { ...run, lines: lines(run.stdout) };
}

describe('veronese batch', () => {
  test('does every pair of consecutive frames, like pair, in order, with several jobs', async (t) => {
    const { frames, one, out } = clip(t, 6);
    const run = await batch([frames, '--out', out, '--jobs', '3', '--overlay', '--motions', '2']);
    assert.deepEqual(run.lines.map(({ index, status, first, second }) => [index, status, first, second]),
      Array.from({ length: 5 }, (_, k) => [k, 'done', one(k), one(k + 1)]));
    const names = run.lines.map(({ name }) => name);
    assert.deepEqual(entries(out), names);
    assert.equal(names[4], '000004-f4');
    const { index, name, status, first, second, ...found } = run.lines[3];
    checkPair(found, 64, 48);
    const { labels, ...direct } = await segmentPair(clipFrame(3), clipFrame(4), { motions: 2, quality: 'fast' });
    assert.deepEqual(timeless(found), timeless(direct));

    // The files are those of pair; result.json has no times, because two runs would differ in them.
    const alone = join(out, '..', 'alone');
    assert.equal((await veronese(['pair', one(3), one(4), '--quality', 'fast', '--out', alone, '--overlay', '--motions', '2'])).code, 0);
    const { 'result.json': mine, ...images } = tree(join(out, name));
    const { 'result.json': theirs, ...expectedImages } = tree(alone);
    const { job, inputs, ...lasting } = JSON.parse(mine);
    const { milliseconds, ...expected } = JSON.parse(theirs);
    assert.deepEqual([lasting, images], [expected, expectedImages]);
    assert.deepEqual(inputs.map(({ name }) => name), ['f3.png', 'f4.png']);
  });

  test('--every, patterns, lists and single files', async (t) => {
    const { frames, one, path, file } = clip(t, 7);
    const pairs = async (...args) => (await batch(args)).lines.map(({ first, second }) => [first, second]);
    assert.deepEqual(await pairs(frames, '--every', '3'), [[one(0), one(3)], [one(3), one(6)]]);
    assert.deepEqual(await pairs(path('f*', 'f[0-2].png')), [[one(0), one(1)], [one(1), one(2)]]);
    assert.deepEqual(await pairs('--list', file('list', `${one(5)}\n\n${one(2)}\r\n`)), [[one(5), one(2)]]);
    assert.deepEqual(await pairs(one(4), one(1)), [[one(4), one(1)]]);
  });

  test('shards are disjoint and together everything', async (t) => {
    const { frames, out } = clip(t, 8);
    const seen = [];
    for (const shard of ['1/3', '2/3', '3/3']) {
      seen.push(...(await batch([frames, '--out', out, '--shard', shard])).lines.map(({ index }) => index));
    }
    assert.deepEqual(seen, [0, 3, 6, 1, 4, 2, 5]);
    const whole = join(out, '..', 'whole');
    await batch([frames, '--out', whole]);
    assert.deepEqual(tree(out), tree(whole));
    assert.deepEqual((await batch([frames, '--shard', '9/9'])).lines, [], 'more shards than pairs');
  });

  test('skips what is finished, by content and settings, and mends what is lost', async (t) => {
    const { frames, one, out } = clip(t, 5);
    const status = async (...args) => (await batch([frames, '--out', out, ...args])).lines.map(({ status }) => status).join(' ');
    const first = await batch([frames, '--out', out]);
    const before = tree(out);
    const again = await batch([frames, '--out', out]);
    // What is skipped prints what was found then.
    const lasting = first.lines.map(({ milliseconds, ...line }) => ({ ...line, status: 'skipped' }));
    assert.deepEqual(again.lines.map(({ inputs, job, ...line }) => line), lasting);
    // A copy with another date is the same; another content is not.
    writeFileSync(one(0), readFileSync(one(0)));
    writeFileSync(one(4), png(frame(7)));
    assert.equal(await status(), 'skipped skipped skipped done');
    writeFileSync(one(4), png(clipFrame(4)));
    rmSync(join(out, '000000-f0'), { recursive: true });
    rmSync(join(out, '000001-f1', 'mask-0.png'));
    rmSync(join(out, '000002-f2', 'result.json'));
    assert.equal(await status(), 'done done done done');
    assert.deepEqual(tree(out), before);
    assert.equal(await status('--motions', '2', '--overlay'), 'done done done done');
    assert.equal(await status('--motions', '2', '--overlay'), 'skipped skipped skipped skipped');
    assert.equal(await status(), 'done done done done');
    assert.deepEqual(tree(out), before, 'an overlay of other settings does not stay');
  });

  test('one bad frame does not stop the rest; all are listed at the end, exit 1', async (t) => {
    const { frames, one, out } = clip(t, 6);
    writeFileSync(one(2), 'no image');
    const run = await batch([frames, '--out', out, '--jobs', '2'], { code: 1 });
    assert.deepEqual(run.lines.map(({ status }) => status), ['done', 'failed', 'failed', 'done', 'done']);
    assert.equal(run.lines[1].error.code, 'unreadable-image');
    assert.match(run.stderr, /^veronese: error: unreadable-image: pair 1 \(.*f1\.png, .*f2\.png\): .*\n.*: pair 2 .*\nveronese: error: pairs-failed: 2 of 5 pairs failed.*\n$/);
    assert.deepEqual(entries(out), ['000000-f0', '000003-f3', '000004-f4']);
    // Repaired, only those are done.
    writeFileSync(one(2), png(clipFrame(2)));
    assert.deepEqual((await batch([frames, '--out', out])).lines.map(({ status }) => status), ['skipped', 'done', 'done', 'skipped', 'skipped']);
  });

  test('a missing file, a frame of another size and a result that cannot be written fail alone', async (t) => {
    const { one, path, out } = clip(t, 3);
    writeFileSync(one(1), png(frame(0, { width: 70 })));
    // The longest name that there may be.
    const long = path(`${'a'.repeat(251)}.png`);
    writeFileSync(long, readFileSync(one(2)));
    assert.deepEqual((await batch([long, one(2), '--out', path('long')])).lines.map(({ name }) => name), [`000000-${'a'.repeat(200)}`]);
    await batch([one(2), one(2), '--out', out]);
    writeFileSync(join(out, '000003-f2'), 'in the way');
    const run = await batch([one(0), one(1), path('none.png'), one(2), one(2), one(0), '--out', out], { code: 1 });
    assert.deepEqual(run.lines.map(({ error }) => error?.code), ['frame-size-mismatch', 'file-not-found', 'file-not-found', 'write-failed', undefined]);
    assert.deepEqual(entries(out), ['000000-f2', '000003-f2', '000004-f2'], 'nothing half-written stays');
  });

  test('refuses what cannot be a batch, with one line', async (t) => {
    const { frames, one, path, file } = clip(t, 1);
    for (const name of ['empty', 'tiff']) mkdirSync(path(name));
    writeFileSync(path('tiff', 'f1.tif'), 'II*');
    for (const [args, errorCode, sentence = /./] of [
      [[one(0)], 'too-few-frames'],
      [[frames], 'too-few-frames'],
      [[path('empty')], 'file-not-found'],
      [[path('tiff')], 'unreadable-image', /no image in the folder '.*tiff' is read, such as 'f1\.tif': frames are PNG, JPEG, WebP, BMP or PNM/],
      [[path('none*.png')], 'file-not-found'],
      [['--list', path('none')], 'file-not-found'],
      [['--list', path('empty')], 'unreadable-file'],
      [['--list', file('blank', '\n\n')], 'too-few-frames'],
      [[one(0), one(0), '--out', one(0)], 'write-failed'],
    ]) {
      const { stderr, stdout } = await batch(args, { code: 1 });
      assert.match(stderr, /^veronese: error: [^\n]+\n$/);
      assert.equal(stderr.split(': ')[2], errorCode, stderr);
      assert.match(stderr, sentence);
      assert.equal(stdout, '');
    }
  });
});

describe('a batch that is stopped', { skip: process.platform === 'win32' }, () => {
  const args = (frames, out) => [frames, '--out', out, '--jobs', '2', '--overlay'];

  /** As the n-th pair is complete: before its folder has its name, or after. */
  const signalled = (folder, signal, n, when) => signalledAt(folder, signal, { path: /\d-f\d$/, n, when });

  test('in the middle of writing: what is left is taken away by the next run, but not that of others', async (t) => {
    const { frames, out, ...folder } = clip(t, 4);
    // This machine's mark is in the name of what the program writes: catch it in the act.
    const killed = await veroneseProcess(['batch', frames, '--quality', 'fast', '--out', out, '--jobs', '1'], signalled(folder, 'SIGKILL', 1, 'before'));
    assert.equal(killed.signal, 'SIGKILL');
    const [, host] = /^\.veronese-([0-9a-f]{8})-\d+\.part$/.exec(entries(out)[0]);
    const [live, other] = [`${host}-${process.ppid}`, '00000000-1'].map((mark) => `.veronese-${mark}.part`);
    for (const name of [live, other]) mkdirSync(join(out, name));
    await batch([frames, '--out', out, '--shard', '1/2']);
    assert.deepEqual(entries(out).filter((name) => name.startsWith('.')), [other, live].sort());
  });

  for (const [signal, exit] of cases([['SIGINT', 130]], [['SIGTERM', 143]])) {
    test(`by ${signal} leaves whole results only, exit ${exit}`, async (t) => {
      const { frames, out, path, ...folder } = clip(t, 8);
      const run = await veroneseProcess(['batch', '--quality', 'fast', ...args(frames, out)], signalled(folder, signal, 3, 'after'));
      assert.equal(run.code, exit);
      assert.match(run.stderr, /^veronese: error: cancelled: [^\n]+\n$/);
      const names = entries(out);
      assert.ok(names.length >= 3 && names.length < 7, names.join());
      await batch(args(frames, path('undisturbed')));
      for (const name of names) assert.deepEqual(tree(join(out, name)), tree(join(path('undisturbed'), name)));
      for (const line of lines(run.stdout)) assert.ok(names.includes(line.name), 'what is printed is on the disk');
    });
  }
});

describe('frames', () => {
  test('names that cannot stand in results are refused at once', { skip: process.platform === 'win32' }, async (t) => {
    const { path, one, out } = clip(t, 2);
    for (const [name, shown] of [['a\nb.png', 'a\\\\nb'], ['a\u007f.png', 'a\u007f'], ['a\\b.png', 'a'], ['...png', '\\.\\.\\.png']]) {
      writeFileSync(path(name), readFileSync(one(0)));
      for (const command of ['batch', 'clip']) {
        const { code, stdout, stderr } = await veronese([command, path(name), one(1), '--out', out]);
        assert.deepEqual([code, stdout], [1, '']);
        assert.match(stderr, new RegExp(`^veronese: error: invalid-input: [^\\n]*${shown}[^\\n]* cannot name results[^\\n]*\\n$`));
        assert.equal(existsSync(out), false);
      }
    }
    assert.match((await veronese(['batch', path('a\tb.mp4')])).stderr, /^veronese: error: invalid-input: /);
  });

  test('numbers are sorted by value, the same in every language', () => {
    const sorted = ['a', 'a1', 'a1b', 'a2', 'a02', 'a10', 'a10b', 'a100', 'b', 'b/1', 'b/2/x', 'b/10/x', 'Z'].sort(byNumbers);
    assert.deepEqual([...sorted].reverse().sort(byNumbers), sorted);
    assert.deepEqual(['f10', 'f9', 'f100', 'f1'].sort(byNumbers), ['f1', 'f9', 'f10', 'f100']);
    assert.deepEqual(['f99999999999999999999', 'f100000000000000000000'].sort(byNumbers), ['f99999999999999999999', 'f100000000000000000000']);
    assert.equal(byNumbers('same', 'same'), 0);
  });

  test('patterns', (t) => {
    const folder = temporaryFolder(t);
    mkdirSync(folder.path('a', 'b.c'), { recursive: true });
    for (const name of ['a/1.png', 'a/2.jpg', 'a/10.png', 'a/b.c/3.png', 'a/(x).png', 'a/.h.png', 'a/[y].png', 'a/n.txt']) folder.file(name, '');
    const found = (pattern) => findFrames([folder.path(pattern)]).map((path) => path.slice(folder.path('a').length + 1));
    assert.deepEqual(found('a/*.png'), ['(x).png', '1.png', '10.png', '[y].png']);
    assert.deepEqual(found('a/?.*'), ['1.png', '2.jpg', 'n.txt']);
    assert.deepEqual(found('*/[0-9].png'), ['1.png']);
    assert.deepEqual(found('a/[!1]*.jpg'), ['2.jpg']);
    assert.deepEqual(found('**/3.png'), ['b.c/3.png']);
    assert.deepEqual(found('a/**/*.png').length, 5);
    assert.deepEqual(found('a/(?).png'), ['(x).png']);
    assert.deepEqual(found('a/[y].png'), ['[y].png'], 'a file of that very name');
    assert.deepEqual(found('a'), ['(x).png', '1.png', '2.jpg', '10.png', '[y].png'], 'a folder: its images');
    assert.throws(() => found('a/*.gif'), { code: 'file-not-found' });
  });
});

describe('the progress bar', () => {
  const drawn = (isTTY, total, options) => {
    let [text, now] = ['', 0];
    const bar = progressBar(total, { isTTY, write: (piece) => (text += piece) }, { now: () => now, ...options });
    for (let done = 1; done <= 4; done++) {
      now += 500;
      bar.update({ done, skipped: 1, failed: 0 });
      bar.update({ done, skipped: 1, failed: 0 });
    }
    bar.clear();
    return text.split('\r\u001b[K');
  };

  test('is drawn on a terminal, not too often, and taken away; and nowhere else', () => {
    const pieces = drawn(true, 8);
    assert.equal(pieces.length, 6, 'four times, and the clearing');
    assert.equal(pieces[4], '[###############.........] 5 of 8 pairs, 1 done before, 2.0 pairs/s, 2 s left');
    assert.equal(pieces[5], '');
    assert.equal(drawn(true, undefined, { unit: 'frames', title: 'labels: ' })[2], 'labels: 3 frames, 1 done before, 2.0 frames/s');
    assert.deepEqual(drawn(false, 8), ['']);
  });
});

describe('veronese batch VIDEO', () => {
  const skip = spawnSync('ffmpeg', ['-version']).status !== 0 && 'the program ffmpeg is not installed';
  const ffmpeg = (...args) => {
    const { status, stderr } = spawnSync('ffmpeg', ['-v', 'error', ...args]);
    assert.equal(status, 0, String(stderr));
  };

  test('does the frames of a video like files of them', { skip }, async (t) => {
    const { frames, out, path } = clip(t, 10);
    const film = path('film.mkv');
    ffmpeg('-i', join(frames, 'f%d.png'), '-c:v', 'ffv1', '-pix_fmt', 'bgr0', film);
    const { lines: found } = await batch([film, '--out', out, '--every', '3']);
    assert.deepEqual(found.map(({ name, first, second }) => [name, first, second]), [
      ['000000-frame-000000', 'film.mkv#0', 'film.mkv#3'],
      ['000001-frame-000003', 'film.mkv#3', 'film.mkv#6'],
      ['000002-frame-000006', 'film.mkv#6', 'film.mkv#9'],
    ]);
    const { lines: files } = await batch([frames, '--every', '3', '--out', path('files')]);
    assert.deepEqual(found.map(({ motions }) => motions), files.map(({ motions }) => motions));
    assert.deepEqual(tree(join(out, found[1].name))['labels.png'], tree(join(path('files'), files[1].name))['labels.png']);
    const again = await batch([film, '--out', out, '--every', '3']);
    assert.deepEqual(again.lines.map(({ status }) => status), ['skipped', 'skipped', 'skipped']);
    // Interlaced.
    ffmpeg('-i', film, '-vf', 'setfield=tff', '-c:v', 'mpeg2video', '-flags', '+ildct+ilme', '-q:v', '1', path('woven.mkv'));
    const { code, stderr } = await veronese(['batch', '--quality', 'fast', path('woven.mkv')]);
    assert.deepEqual([code, /'.*woven\.mkv' is interlaced/.test(stderr)], [0, true], stderr);
  });

  test('refuses what is no video', { skip }, async (t) => {
    const { path, file } = temporaryFolder(t);
    ffmpeg('-f', 'lavfi', '-i', 'sine=duration=0.1', path('sound.wav'));
    const cases = [[path('none.mp4'), /file-not-found: /], [file('text.mp4', 'no video'), /unreadable-video: /], [path('sound.wav'), /unreadable-video: [^\n]*sound\.wav' has no pictures: there is no video stream in it\n$/]];
    for (const [name, sentence] of cases) {
      const { stdout, stderr } = await batch([name], { code: 1 });
      assert.match(stderr, sentence);
      assert.equal(stdout, '');
    }
  });

  test('takes damaged videos only with --allow-damaged, wherever they are cut off', { skip }, async (t) => {
    const { frames, out, path } = clip(t, 10);
    const file = path('film.avi');
    ffmpeg('-i', join(frames, 'f%d.png'), '-c:v', 'rawvideo', '-pix_fmt', 'bgr24', file);
    const whole = readFileSync(file);
    await batch([file]);
    // Within a frame, and between two, of which ffmpeg reports nothing.
    const end = whole.indexOf('00dc', whole.indexOf('movi')) + 4 * (8 + 64 * 48 * 3);
    for (const [cut, reason, ...args] of [[end - 1000, 'Invalid', 'batch', file], [end, 'it should have \\d+ bytes and has \\d+', 'clip', file, '--out', out]]) {
      writeFileSync(file, whole.subarray(0, cut));
      const refused = await veronese([...args, '--quality', 'fast']);
      assert.equal(refused.code, 1);
      if (args[0] === 'batch') assert.ok(lines(refused.stdout).length >= 2, 'the pairs before are done');
      assert.match(refused.stderr, new RegExp(`^veronese: error: unreadable-video: [^\n]*film\\.avi' is damaged[^\n]*${reason}[^\n]*--allow-damaged[^\n]*\n$`));
      const allowed = await veronese([...args, '--quality', 'fast', '--allow-damaged']);
      assert.equal(allowed.code, 0);
      assert.match(allowed.stderr, new RegExp(`^veronese: warning: [^\n]*film\\.avi' is damaged[^\n]*${reason}[^\n]*\n$`), 'once');
      assert.ok(lines(allowed.stdout).length >= 2);
    }
  });

  test('names what is missing where there is no ffmpeg', async (t) => {
    const { code, stderr } = await veroneseProcess(['batch', temporaryFolder(t).file('film.mp4', '')], { env: { PATH: '/nowhere' } });
    assert.equal(code, 1);
    assert.match(stderr, /^veronese: error: ffmpeg-missing: [^\n]*install[^\n]*\n$/);
  });

  test('notes what is interlaced, and what changes its size', () => {
    const line = (k, size = '320x240', fields = 'P') => `[Parsed_showinfo_0 @ 0x55] [info] n:   ${k} pts:  ${k} pts_time:${k / 25}  duration:1 duration_time:0.04 fmt:yuv420p cl:left sar:1/1 s:${size} i:${fields} iskey:1 type:I`;
    const notes = (...lines) => {
      const about = { times: [] };
      for (const each of lines) enter(about, each);
      assert.deepEqual(about.times, lines.map((_, k) => k / 25));
      return notesOnVideo('a.ts', about).map(({ code, message }) => `${code}: ${message}`);
    };
    const [woven, changing] = [/^video-interlaced: 'a\.ts' is interlaced, .*'ffmpeg -i IN -vf bwdif=0 OUT'/, /^video-size: the frames of 'a\.ts' change from 320x240 to 160x120 pixels, the first time at number 1 /];
    for (const [lines, ...expected] of [[[line(0), line(1)]], [[line(0), line(1, '320x240', 'T')], woven], [[line(0), line(1, '160x120'), line(2, '80x60', 'B')], woven, changing]]) {
      const found = notes(...lines);
      assert.equal(found.length, expected.length);
      expected.forEach((sentence, k) => assert.match(found[k], sentence));
    }
  });

  test('pixmaps are cut apart wherever the stream is', async () => {
    const pictures = [0, 1, 2].map((k) => ppm(frame(k, { width: 16 + k, height: 16 })));
    const stream = Buffer.concat(pictures);
    for (const size of [1, 7, 800, 1000, 100_000]) {
      const chunks = [];
      for (let at = 0; at < stream.length; at += size) chunks.push(stream.subarray(at, at + size));
      const found = [];
      for await (const picture of pixmaps(chunks, 'a.mp4')) found.push(Buffer.from(picture));
      assert.deepEqual(found, pictures, String(size));
    }
    const read = async (bytes) => { for await (const _ of pixmaps([bytes], 'a.mp4')); };
    await assert.rejects(read(stream.subarray(0, -1)), { code: 'unreadable-video', message: "'a.mp4': the last frame is cut off" });
    await assert.rejects(read(Buffer.alloc(64, 'x')), { code: 'unreadable-video', message: /^'a\.mp4': ffmpeg gave something else/ });
    await assert.rejects(read(Buffer.from('P6\n99999 10\n255\n')), { code: 'frame-size-unsupported' });
  });
});
