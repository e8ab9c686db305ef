// Every command ends: on SIGTERM whatever it waits for, and where its output folder cannot be made.

import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { existsSync, mkdirSync, writeFileSync } from 'node:fs';
import { open } from 'node:fs/promises';
import { describe, test } from 'node:test';
import { clipFolder } from './support/clip.mjs';
import { clip } from './support/folders.mjs';
import { frame } from './support/frames.mjs';
import { program, temporaryFolder, veronese, veroneseProcess } from './support/program.mjs';
import { largeFrames, markedReading, there } from './support/stopping.mjs';

const frames = (t) => clip(t, 3, frame);

describe('SIGTERM', { skip: process.platform === 'win32' }, () => {
  /** `underWay(child)` waits until it is at work, or waits itself. */
  async function ends(args, underWay, options) {
    const { code, stderr } = await veroneseProcess(args, {
      ...options,
      onStart: async (child) => {
        await underWay(child);
        assert.equal(child.exitCode, null, 'it is still at work');
        child.kill('SIGTERM');
      },
    });
    assert.equal(code, 143, `${args[0]} ${stderr}`);
    assert.match(stderr, /veronese: error: cancelled: [^\n]+\n$/);
  }

  test('ends clip and points', async (t) => {
    const folder = frames(t);
    const [first, second] = largeFrames(folder);
    const ofClip = markedReading(folder, second);
    await ends(['clip', first, second, '--out', folder.path('out')], ofClip.seen, { env: ofClip.env });
    const derivatives = Array.from({ length: 400_000 }, (_, k) => [Math.sin(k) * 99, Math.cos(3 * k) * 99, Math.sin(7 * k)]);
    const file = folder.file('points.json', JSON.stringify({ positions: derivatives.map(([x, y]) => [x, y]), derivatives }));
    const ofPoints = markedReading({ ...folder, path: (name) => folder.path(`points-${name}`) }, file);
    await ends(['points', file], ofPoints.seen, { env: ofPoints.env });
  });

  test('ends a wait for a list', async (t) => {
    const { path } = frames(t);
    // More than a pipe holds: it is all written when somebody reads.
    const isRead = (child) => new Promise((resolve) => child.stdin.on('error', () => {}).write('\n'.repeat(2 ** 20), resolve));
    await ends(['batch', '--list', '-'], isRead, { stdin: 'pipe' });
    await ends(['clip', '--list', '-', '--out', path('out')], isRead, { stdin: 'pipe' });
    if (spawnSync('mkfifo', [path('list')]).status !== 0) return;
    // Opens when the other end is open too.
    let writer;
    await ends(['batch', '--list', path('list')], async () => (writer = await open(path('list'), 'w')));
    await writer.close();
  });

  test('ends a wait for ffmpeg', async (t) => {
    const { file, path } = temporaryFolder(t);
    const film = file('film.mp4', 'film');
    const scripts = { asked: '', reading: '[ "$1" = -version ] && echo "ffmpeg version 6.0" && exit;' };
    for (const [name, script] of Object.entries(scripts)) {
      for (const args of [['video', film], ['clip', film, '--out', path('out')]]) {
        const started = path(`${name}-${args[0]}`);
        mkdirSync(path(`bin-${name}`), { recursive: true });
        writeFileSync(path(`bin-${name}`, 'ffmpeg'), `#!/bin/sh\n${script} touch '${started}'; exec sleep 60\n`, { mode: 0o755 });
        await ends(args, (child) => there(started, child), { env: { PATH: `${path(`bin-${name}`)}:${process.env.PATH}` } });
      }
    }
  });
});

test('a list may come through a pipe', { skip: process.platform === 'win32' }, (t) => {
  const { one } = frames(t);
  const run = (list) => spawnSync('bash', ['-c', `"$0" "$1" batch --quality fast --list ${list}`, process.execPath, program], { encoding: 'utf8', timeout: 60_000 });
  for (const list of [`<(sleep 0.2; echo '${one(0)}'; echo '${one(1)}')`, `- < <(echo '${one(0)}'; echo '${one(1)}')`, `/dev/stdin <<< '${one(0)}\n${one(1)}'`]) {
    const { status, stdout, stderr } = run(list);
    assert.deepEqual([status, stderr, stdout.trim().split('\n').length], [0, '', 1], list);
  }
});

test('an output folder that cannot be made is an error', { skip: !existsSync('/proc/self/fd') && 'there is no /proc' }, async (t) => {
  const { frames: folder, one, path } = frames(t);
  clipFolder(path('clip'));
  const commands = [
    ['pair', one(0), one(1), '--quality', 'fast'],
    ['batch', folder, '--quality', 'fast'],
    ['clip', folder, '--quality', 'fast'],
    ['clip', folder, '--quality', 'fast', '--look-ahead', '0'],
    ['convert', path('clip'), '--to', 'coco,yolo'],
  ];
  for (const out of ['/proc/none/a/b', '/dev/fd/99/out', '/proc/self/fd/77/out']) {
    for (const args of commands) {
      const { code, stderr } = await veronese([...args, '--out', out]);
      assert.equal(code, 1, `${args[0]} ${out}`);
      assert.match(stderr, /^veronese: error: write-failed: /m);
    }
  }
});
