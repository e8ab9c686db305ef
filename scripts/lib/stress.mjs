// npm test -- --stress: looks for tests, and for faults of the page, that only a busy or a slow machine shows. Runs the tests of the package,
// of Python and of the page in the ways below, several times, and lists those that failed, with the way and how often.

import { availableParallelism } from 'node:os';
import { Worker } from 'node:worker_threads';

import { say } from './run.mjs';
import { NOTHING, added } from './tests.mjs';

/** How often each test runs in each way, unless it is said. */
export const TIMES = 5;

/** What happens around the tests meanwhile. The page's tests do the rest themselves, as `VERONESE_STRESS` says (www/tests/kept.ts). */
const WAYS = {
  busy: { title: 'twice as many busy threads as processors, one test at a time', around: withBusyThreads },
  'slow-page': { title: 'a page six times slower, whose scripts come a second late', around: (main) => main() },
  'slow-test': { title: 'a test that waits before each step, until what passes has passed', around: (main) => main() },
};

/** Runs parts in all ways that they have, and says what failed; returns the exit code. */
export async function stress(parts, setup, times) {
  const { passed, failed, failures } = await stressed(parts, setup, times);
  say(`\n=== stress, each test ${times === 1 ? 'once' : `${times} times`} in each way ===`);
  for (const failure of failures) say(`failed: ${failure}`);
  say(`\n${passed} passed, ${failed} failed`);
  return failed === 0 && passed > 0 ? 0 : 1;
}

/** The outcome of all ways and times together; `failures` says of each test how often it failed in which way. */
export async function stressed(parts, setup, times) {
  let outcome = NOTHING;
  const failed = new Map();
  for (const [way, { title, around }] of Object.entries(WAYS)) {
    for (const part of parts.filter(({ stressed }) => stressed?.[way])) {
      for (let time = 1; time <= times; time++) {
        say(`\n=== ${part.title}: ${title} (${time} of ${times}) ===`);
        const one = await around(() => part.stressed[way](setup));
        outcome = added(outcome, one);
        // A program that ends before its tests names none.
        const names = one.failed > 0 && one.failures.length === 0 ? [`${part.title}: ${one.note}`] : one.failures;
        for (const name of names) failed.set(`${way}: ${name}`, (failed.get(`${way}: ${name}`) ?? 0) + 1);
      }
    }
  }
  return { ...outcome, failures: [...failed].map(([failure, count]) => `${failure} (${count} of ${times})`) };
}

/** Keeps all processors busy while `main` runs. */
async function withBusyThreads(main) {
  const threads = Array.from({ length: 2 * availableParallelism() }, () => new Worker('for (;;);', { eval: true }));
  try {
    return await main();
  } finally {
    await Promise.all(threads.map((thread) => thread.terminate()));
  }
}
