// Runs files of tests in this process, one after another.

import { test } from 'node:test';

for (const name of process.argv.slice(2)) {
  await import(`../${name}`);
  // Tests run in the order in which they were made.
  await new Promise((resolve) => test(`end of ${name}`, resolve));
}
