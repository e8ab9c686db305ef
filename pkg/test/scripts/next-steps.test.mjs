import assert from 'node:assert/strict';
import { test } from 'node:test';
import { nextSteps } from '../../../scripts/lib/next-steps.mjs';
import { veronese } from '../support/program.mjs';

const OVER_SSH = { SSH_CONNECTION: '10.0.0.7 50000 10.0.0.2 22', USER: 'ada' };

test('the page is named with its port, and over SSH the way to it from where the browser is', () => {
  assert.match(nextSteps({ host: '127.0.0.1', port: 4180 }, {}), /^The page is at http:\/\/localhost:4180\/ \(Ctrl-C ends it\)\n\n/);
  assert.match(nextSteps({ host: '127.0.0.1', port: 4180 }, OVER_SSH), /http:\/\/localhost:4180\/.*\n.*ssh -L 4180:localhost:4180 ada@10\.0\.0\.2/);
  assert.match(nextSteps({ host: '0.0.0.0', port: 80 }, OVER_SSH), /http:\/\/0\.0\.0\.0:80\/.*\n.*http:\/\/10\.0\.0\.2:80\//);
});

test('the commands for frames of one\'s own are those of the program', async () => {
  for (const text of [nextSteps(undefined, {}), nextSteps({ host: '127.0.0.1', port: 1 }, {})]) {
    const commands = Array.from(text.matchAll(/node pkg\/bin\/veronese\.js (.*)/g), ([, args]) => args.split(' '));
    assert.equal(commands.length, 2);
    for (const args of commands) assert.notEqual((await veronese(args)).code, 2, args.join(' '));
  }
});
