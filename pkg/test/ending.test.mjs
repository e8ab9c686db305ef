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
import { signalledAt } from './support/stopping.mjs';

const frames = (t) => clip(t, 3, frame);

describe('SIGTERM', { skip: process.platform === 'win32' }, () => {
  async function ends(args, options) {
    const { code, stderr } = await veroneseProcess(args, options);
    assert.equal(code, 143, `${args[0]} ${stderr}`);
    assert.match(stderr, /veronese: error: cancelled: [^\n]+\n$/);
  }

  test('ends clip and points', async (t) => {
    const folder = frames(t);
    await ends(['clip', folder.frames, '--out', folder.path('out')], signalledAt(folder, 'SIGTERM', { call: 'readFile', path: /f1\.png$/, n: 2 }));
    await ends(['points', folder.file('points.json', '')], signalledAt(folder, 'SIGTERM', { call: 'readFile', path: /points\.json$/, stays: true }));
  });

  test('ends a wait for a list', async (t) => {
    const { path } = frames(t);
    // More than a pipe holds: it is all written when somebody reads.
    const onStart = (child) => child.stdin.on('error', () => {}).write('\n'.repeat(2 ** 20), () => child.kill());
    await ends(['batch', '--list', '-'], { stdin: 'pipe', onStart });
    await ends(['clip', '--list', '-', '--out', path('out')], { stdin: 'pipe', onStart });
    if (spawnSync('mkfifo', [path('list')]).status !== 0) return;
    let writer;
    const onOpen = async (child) => {
      writer = await openedToo(path('list'));
      child.kill();
    };
    await ends(['batch', '--list', path('list')], { onStart: onOpen });
    await writer.close();
  });

  test('ends a wait for ffmpeg', async (t) => {
    const { file, path } = temporaryFolder(t);
    const film = file('film.mp4', 'film');
    const scripts = { asked: '', reading: '[ "$1" = -version ] && echo "ffmpeg version 6.0" && exit;' };
    for (const [name, script] of Object.entries(scripts)) {
      mkdirSync(path(name));
      writeFileSync(path(name, 'ffmpeg'), `#!/bin/sh\n${script} kill -TERM $PPID; exec sleep 60\n`, { mode: 0o755 });
      for (const args of [['batch', film], ['clip', film, '--out', path('out')]]) {
        await ends(args, { env: { PATH: `${path(name)}:${process.env.PATH}` } });
      }
    }
  });
});

/** The writing end of a pipe with a name, as soon as somebody reads it. */
const openedToo = (path) => open(path, 'w');

test('a list may come through a pipe', { skip: process.platform === 'win32' }, async (t) => {
  const { one, path } = frames(t);
  const list = `${one(0)}\n${one(1)}\n`;
  const check = ({ stdout, stderr }, how) => assert.deepEqual([stderr, stdout.trim().split('\n').length], ['', 1], how);
  for (const how of ['- < <(cat)', '/dev/stdin < <(cat)']) {
    check(spawnSync('bash', ['-c', `"$0" "$1" batch --quality fast --list ${how}`, process.execPath, program], { encoding: 'utf8', input: list, timeout: 120_000 }), how);
  }
  // One that has nothing yet is waited for.
  if (spawnSync('mkfifo', [path('list')]).status !== 0) return;
  const onStart = async () => {
    const writer = await openedToo(path('list'));
    await writer.write(list);
    await writer.close();
  };
  check(await veroneseProcess(['batch', '--quality', 'fast', '--list', path('list')], { onStart }), 'a pipe with a name');
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
  for (const [out, some] of [['/proc/none/a/b', commands], ['/dev/fd/99/out', commands.slice(0, 1)], ['/proc/self/fd/77/out', commands.slice(-1)]]) {
    for (const args of some) {
      const { code, stderr } = await veronese([...args, '--out', out]);
      assert.equal(code, 1, `${args[0]} ${out}`);
      assert.match(stderr, /^veronese: error: write-failed: /m);
    }
  }
});
