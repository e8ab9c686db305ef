// Runs test programs.

import { run } from './run.mjs';
import { plain } from './test-programs.mjs';

export const NOTHING = { passed: 0, failed: 0, skipped: 0, failures: [] };
/** pytest ended without a test. */
const NONE = 5;

/**
 * Runs a test program, one of test-programs.mjs. Its exit code decides: a crash fails the part, and so does a run without tests
 * unless they were to have a `word`. Returns the counts, and the names of the tests that failed in `failures`.
 */
export async function tests(kind, program, args, env = {}, word) {
  const { code, text } = await run(program, args, { output: 'both', env });
  const output = plain(text);
  const counts = kind.counts(output);
  const failures = kind.failures(output);
  const none = counts.passed + counts.failed === 0;
  if (none && word !== undefined && [0, NONE].includes(code)) return { ...NOTHING };
  if (code !== 0 && counts.failed === 0) return { ...counts, failed: 1, failures, note: `${program} ended with code ${code}` };
  if (none) return { ...counts, failed: 1, failures, note: 'no test ran' };
  return { ...counts, failures };
}

/** The outcomes of two programs as one. */
export function added(one, other) {
  const both = (kind) => one[kind] + other[kind];
  return {
    passed: both('passed'),
    failed: both('failed'),
    skipped: both('skipped'),
    failures: [...one.failures, ...other.failures],
    note: one.note ?? other.note,
  };
}
