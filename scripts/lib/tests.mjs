// Runs test programs.

import { run } from './run.mjs';
import { plain } from './test-programs.mjs';

/** More failures than this are no accident. */
const FEW = 5;

/**
 * Runs a test program, one of test-programs.mjs. Its exit code decides: a crash fails the part, and so does a run without tests.
 *
 * Returns the counts, the names of the tests that failed in `failures`, and `again`, which runs those alone, where that can tell something.
 */
export async function tests(kind, program, args, env = {}) {
  const { code, text } = await run(program, args, { output: 'both', env });
  const output = plain(text);
  const counts = kind.counts(output);
  const failures = kind.failures(output);
  if (code !== 0 && counts.failed === 0) return { ...counts, failed: 1, failures, note: `${program} ended with code ${code}` };
  if (counts.passed + counts.failed === 0) return { ...counts, failed: 1, failures, note: 'no test ran' };
  if (counts.failed === 0 || counts.failed > FEW) return { ...counts, failures };
  const second = kind.again?.(output, program, args);
  return { ...counts, failures, again: second && (() => tests(kind, ...second, env)) };
}

/** The outcomes of two programs as one. */
export function added(one, other) {
  const both = (kind) => one[kind] + other[kind];
  const again = one.again || other.again ? async () => added(await repeated(one), await repeated(other)) : undefined;
  const failures = [...one.failures, ...other.failures];
  return { passed: both('passed'), failed: both('failed'), skipped: both('skipped'), failures, note: one.note ?? other.note, again };
}

/**
 * The outcome after the tests that failed had another try, by themselves. Those that pass then are in `unsteady`: they count as passed, and
 * the summary names them.
 */
export async function repeated(outcome) {
  if (!outcome.again) return outcome;
  const { again, ...before } = outcome;
  const after = await again();
  if (after.failed > 0) return before;
  return { ...before, passed: before.passed + before.failed, failed: 0, failures: [], unsteady: [...(before.unsteady ?? []), ...before.failures] };
}
