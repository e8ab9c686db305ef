// How scripts start programs: `npm test` runs parts side by side.

import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import { once } from 'node:events';
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { test } from 'node:test';
import { setTimeout } from 'node:timers/promises';
import { inPart, run, say } from '../../../scripts/lib/run.mjs';

const MODULE = new URL('../../../scripts/lib/run.mjs', import.meta.url).href;

test('what parts and their programs show is not mixed, and programs get the niceness of their part', async (t) => {
  const written = { one: '', two: '' };
  const nice = Number((await run('nice', [], { output: 'collect' })).text);
  const folder = mkdtempSync(join(tmpdir(), 'veronese-test-'));
  t.after(() => rmSync(folder, { recursive: true }));
  // Both go on when both were heard.
  const script = 'echo "$0"; until [ -e heard ]; do sleep 0.01; done; nice >&2; exit 3';
  const write = (name, piece) => {
    written[name] += piece;
    if (Object.values(written).every((text) => text.split('\n').length > 2)) writeFileSync(join(folder, 'heard'), '');
  };
  const part = (name, niceness) =>
    inPart({ write: (piece) => write(name, piece), niceness }, async () => {
      say(`${name}:`);
      const { code } = await run('bash', ['-c', script, name], { cwd: folder });
      say(`${name} ended with ${code}`);
    });
  await Promise.all([part('one', 0), part('two', nice + 3)]);
  assert.equal(written.one, `one:\none\n${nice}\none ended with 3\n`);
  assert.equal(written.two, `two:\ntwo\n${nice + 3}\ntwo ended with 3\n`);
});

const INTERRUPTIONS = { SIGINT: 130, SIGTERM: 143 };
for (const [signal, code] of Object.entries(INTERRUPTIONS)) {
  test(`${signal} ends also the programs that programs have started`, { timeout: 60_000 }, async () => {
    const main = `
      import { command, run } from ${JSON.stringify(MODULE)};
      await command(() => run('bash', ['-c', 'sleep 600 & echo $!; wait']));
    `;
    const child = spawn(process.execPath, ['--input-type=module', '--eval', main], { stdio: ['ignore', 'pipe', 'inherit'] });
    const [line] = await once(child.stdout, 'data');
    const sleeper = Number(line);
    assert.ok(lives(sleeper));
    child.kill(signal);
    assert.deepEqual(await once(child, 'exit'), [code, null]);
    while (lives(sleeper)) await setTimeout(20);
  });
}

function lives(pid) {
  try {
    return process.kill(pid, 0);
  } catch {
    return false;
  }
}
