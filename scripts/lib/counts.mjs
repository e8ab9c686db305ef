// Reads the numbers of passed and failed tests from a test program's output.

const ESCAPES = /\u001b\[[0-9;]*m/g;

/** The counts `{ passed, failed, skipped }` in the output of cargo test and wasm-pack test: one line for each binary. */
export function cargoCounts(output) {
  const counts = { passed: 0, failed: 0, skipped: 0 };
  const line = /^test result: \w+\. (\d+) passed; (\d+) failed; (\d+) ignored/gm;
  for (const [, passed, failed, ignored] of output.replace(ESCAPES, '').matchAll(line)) {
    counts.passed += Number(passed);
    counts.failed += Number(failed);
    counts.skipped += Number(ignored);
  }
  return counts;
}

/** The same for Node's test runner, whose summary begins with # or ℹ, depending on the reporter. */
export function nodeCounts(output) {
  const kinds = { pass: 'passed', fail: 'failed', cancelled: 'failed', skipped: 'skipped', todo: 'skipped' };
  return sum(output, /^(?:#|ℹ) (pass|fail|cancelled|skipped|todo) (\d+)$/gm, kinds, ([, kind, count]) => [kind, count]);
}

/** The same for Playwright. A test that passes only on a retry counts as failed, because it is unreliable. */
export function playwrightCounts(output) {
  const kinds = { passed: 'passed', failed: 'failed', flaky: 'failed', skipped: 'skipped', 'did not run': 'failed' };
  const line = /^\s+(\d+) (passed|failed|flaky|skipped|did not run)\b/gm;
  return sum(output, line, kinds, ([, count, kind]) => [kind, count]);
}

/** The same for pytest, whose last line has all counts. */
export function pytestCounts(output) {
  const kinds = { passed: 'passed', failed: 'failed', error: 'failed', errors: 'failed', skipped: 'skipped', xfailed: 'skipped', xpassed: 'failed' };
  const last = output.replace(ESCAPES, '').match(/^.*\b\d+ (?:passed|failed|errors?|skipped)\b.* in [\d.]+s.*$/gm)?.at(-1) ?? '';
  return sum(last, /(\d+) (passed|failed|errors?|skipped|xfailed|xpassed)\b/g, kinds, ([, count, kind]) => [kind, count]);
}

function sum(output, pattern, kinds, read) {
  const counts = { passed: 0, failed: 0, skipped: 0 };
  for (const match of output.replace(ESCAPES, '').matchAll(pattern)) {
    const [kind, count] = read(match);
    counts[kinds[kind]] += Number(count);
  }
  return counts;
}

/** The counts of two runs of one part. */
export function added(one, other) {
  const both = (kind) => one[kind] + other[kind];
  return { passed: both('passed'), failed: both('failed'), skipped: both('skipped'), note: one.note ?? other.note };
}
