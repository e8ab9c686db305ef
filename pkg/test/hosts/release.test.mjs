// `npm run release` refuses what must not be published.

import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { describe, test } from 'node:test';
import { fileURLToPath } from 'node:url';
import { changelogProblem } from '../../../scripts/lib/changelog.mjs';
import { versionProblem, versions } from '../../../scripts/lib/versions.mjs';

const PROGRAM = fileURLToPath(new URL('../../../scripts/release.mjs', import.meta.url));

describe('refused are', () => {
  test('a version that differs in one file', async () => {
    const found = await versions();
    assert.equal(versionProblem(found), undefined);
    assert.match(versionProblem({ ...found, 'pkg/package.json': '9.8.7' }), /9\.8\.7 in pkg\/package\.json/);
  });

  test('a changelog whose newest section is of another version, or of no day', () => {
    const problem = (heading) => changelogProblem(`# Changelog\n\n${heading}\n\n## [0.0.1] – 2020-01-01\n`, '1.2.3');
    for (const right of ['## [1.2.3] – 2026-02-03', '## 1.2.3 - 2026-02-03']) assert.equal(problem(right), undefined, right);
    for (const wrong of ['## [Unreleased]', '## [1.2.3]', '## [1.2.3] – unreleased', '## [1.2.3] – 2026-02-30', '## [1.2.4] – 2026-02-03', '']) {
      assert.match(problem(wrong), /a release takes `## \[1\.2\.3\] – YYYY-MM-DD`/, wrong);
    }
  });

  test('calls that would publish from here, or that nobody knows', () => {
    for (const args of [[], ['--tag', '0.1.0'], ['--publish']]) {
      const { status, stderr } = spawnSync(process.execPath, [PROGRAM, ...args], { encoding: 'utf8' });
      assert.equal(status, 1, args.join(' '));
      assert.match(stderr, /npm run release -- --dry-run/);
    }
  });
});
