// Every command ends: on SIGTERM whatever it waits for, and where its output folder cannot be made.

import assert from 'node:assert/strict';
import { spawn, spawnSync } from 'node:child_process';
import { chmodSync, existsSync, mkdirSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { describe, test } from 'node:test';
import { setTimeout } from 'node:timers/promises';
import { fileURLToPath } from 'node:url';
import { clipFolder } from './support/clip.mjs';
import { frame, png } from './support/frames.mjs';
import { temporaryFolder, veronese } from './support/program.mjs';

const program = fileURLToPath(new URL('../bin/veronese.js', import.meta.url));
/** A machine may be busy. */
const GENEROUS = 20_000;

function frames(t) {
  const folder = temporaryFolder(t);
  mkdirSync(folder.path('frames'));
  for (let k = 0; k < 3; k++) writeFileSync(folder.path('frames', `f${k}.png`), png(frame(k)));
  return { ...folder, frames: folder.path('frames'), one: (k) => folder.path('frames', `f${k}.png`) };
}

/**
 * Starts it, sends SIGTERM when it is under way, and returns how it ended. On a busy machine a program may not have come so far that it
 * listens: then it is started again and given longer.
 */
async function terminated(args, { env = {}, stdin = 'ignore' } = {}) {
  let end;
  for (const patience of [1500, 6000, GENEROUS]) {
    const child = spawn(process.execPath, [program, ...args], { stdio: [stdin, 'pipe', 'pipe'], env: { ...process.env, ...env } });
    let stderr = '';
    child.stderr.setEncoding('utf8').on('data', (text) => (stderr += text));
    const ended = new Promise((resolve) => child.once('exit', (code, signal) => resolve({ code, signal })));
    await setTimeout(patience);
    assert.equal(child.exitCode, null, `it is still at work: ${stderr}`);
    child.kill('SIGTERM');
    end = { ...(await Promise.race([ended, setTimeout(GENEROUS, { code: 'it does not end' }, { ref: false })])), stderr };
    child.kill('SIGKILL');
    if (end.signal !== 'SIGTERM') break;
  }
  return end;
}

describe('SIGTERM', { skip: process.platform === 'win32' }, () => {
  const ends = async (args, options) => {
    const { code, stderr } = await terminated(args, options);
    assert.equal(code, 143, `${args[0]} ${stderr}`);
    assert.match(stderr, /veronese: error: cancelled: [^\n]+\n$/);
  };
  const large = (folder) => folder.file('large.pgm', Buffer.concat([Buffer.from('P5 4096 4096 255\n'), Buffer.alloc(4096 * 4096, 'texture')]));

  test('ends pair, batch, clip and points', async (t) => {
    const folder = frames(t);
    const [picture, out] = [large(folder), folder.path('out')];
    const other = folder.path('other.pgm');
    writeFileSync(other, Buffer.concat([Buffer.from('P5 4096 4096 255\n'), Buffer.alloc(4096 * 4096, 'another texture')]));
    await ends(['pair', picture, other, '--out', out]);
    await ends(['batch', picture, other, picture, '--out', out]);
    await ends(['clip', picture, other, '--out', out]);
    const row = (_, k) => [Math.sin(k) * 99, Math.cos(3 * k) * 99, Math.sin(7 * k)];
    const derivatives = Array.from({ length: 400_000 }, row);
    await ends(['points', folder.file('points.json', JSON.stringify({ positions: derivatives.map(([x, y]) => [x, y]), derivatives }))]);
  });

  test('ends convert', async (t) => {
    const folder = temporaryFolder(t);
    const noise = Uint8Array.from({ length: 512 * 512 }, (_, at) => Math.imul(at, 0x9e3779b1) >>> 31);
    clipFolder(folder.path('clip'), { frames: Array(60).fill(noise), width: 512, height: 512 });
    await ends(['convert', folder.path('clip'), '--to', 'labelme-polygon,coco-polygon']);
  });

  test('ends a wait for a list', async (t) => {
    const folder = frames(t);
    await Promise.all([
      ends(['batch', '--list', '-'], { stdin: 'pipe' }),
      ends(['clip', '--list', '-', '--out', folder.path('out')], { stdin: 'pipe' }),
      spawnSync('mkfifo', [folder.path('list')]).status === 0 && ends(['batch', '--list', folder.path('list')]),
    ]);
  });

  test('ends a wait for ffmpeg', async (t) => {
    const folder = temporaryFolder(t);
    const file = folder.file('film.mp4', 'film');
    const scripts = { asked: 'exec sleep 60', reading: '[ "$1" = -version ] && echo "ffmpeg version 6.0" && exit; exec sleep 60' };
    const runs = Object.entries(scripts).flatMap(([name, script]) => {
      const bin = folder.path(name);
      mkdirSync(bin);
      writeFileSync(join(bin, 'ffmpeg'), `#!/bin/sh\n${script}\n`);
      chmodSync(join(bin, 'ffmpeg'), 0o755);
      const env = { PATH: `${bin}:${process.env.PATH}` };
      return [ends(['video', file], { env }), ends(['clip', file, '--out', folder.path(`out-${name}`)], { env })];
    });
    await Promise.all(runs);
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
      const { code, signal, stderr } = await veronese([...args, '--out', out]);
      assert.equal(signal, null, `${args[0]} ${out} ends`);
      assert.equal(code, 1);
      assert.match(stderr, /^veronese: error: write-failed: /m);
    }
  }
});
