// Test programs: how many of their tests passed and failed in what they write, and which failed.

const ESCAPES = /\u001b\[[0-9;]*m/g;

/** cargo test: a line of counts for each binary. */
export const cargo = {
  counts: (output) => {
    const counts = { passed: 0, failed: 0, skipped: 0 };
    for (const [, passed, failed, ignored] of output.matchAll(/^test result: \w+\. (\d+) passed; (\d+) failed; (\d+) ignored/gm)) {
      counts.passed += Number(passed);
      counts.failed += Number(failed);
      counts.skipped += Number(ignored);
    }
    return counts;
  },
  failures: (output) => first(output, /^test (\S.*) \.\.\. FAILED$/gm),
};

/** Node's test runner with the reporter `tap`, which is the default of some of its versions only. A failure counts for its suite too. */
export const node = {
  counts: (output) => {
    const kinds = { pass: 'passed', fail: 'failed', cancelled: 'failed', skipped: 'skipped', todo: 'skipped' };
    return sum(output, /^# (pass|fail|cancelled|skipped|todo) (\d+)$/gm, kinds, ([, kind, count]) => [kind, count]);
  },
  failures: (output) => first(output, /^ *not ok \d+ - (.+)$/gm),
};

/** Playwright, whose configuration is in a file or a workspace of npm. */
export const playwright = {
  counts: (output) => {
    const kinds = { passed: 'passed', failed: 'failed', flaky: 'failed', skipped: 'skipped', 'did not run': 'failed' };
    const line = /^\s+(\d+) (passed|failed|flaky|skipped|did not run)\b/gm;
    return sum(output, line, kinds, ([, count, kind]) => [kind, count]);
  },
  failures: (output) => first(output, /^ +\d+\) (.+?)(?: ─+)?$/gm),
};

/** pytest, whose last line has all counts. */
export const pytest = {
  counts: (output) => {
    const kinds = {
      passed: 'passed',
      failed: 'failed',
      error: 'failed',
      errors: 'failed',
      skipped: 'skipped',
      xfailed: 'skipped',
      xpassed: 'failed',
    };
    const last = output.match(/^.*\b\d+ (?:passed|failed|errors?|skipped)\b.* in [\d.]+s.*$/gm)?.at(-1) ?? '';
    return sum(last, /(\d+) (passed|failed|errors?|skipped|xfailed|xpassed)\b/g, kinds, ([, count, kind]) => [kind, count]);
  },
  failures: (output) => first(output, /^(?:FAILED|ERROR) (\S+)/gm),
};

/** The output of a program without colours. */
export function plain(output) {
  return output.replace(ESCAPES, '');
}

function sum(output, pattern, kinds, read) {
  const counts = { passed: 0, failed: 0, skipped: 0 };
  for (const match of output.matchAll(pattern)) {
    const [kind, count] = read(match);
    counts[kinds[kind]] += Number(count);
  }
  return counts;
}

/** The first groups of all matches, each once. */
function first(output, pattern) {
  return [...new Set([...output.matchAll(pattern)].map((match) => match[1]))];
}
