// Builds the WebAssembly modules, the npm package, the page and the wheel. What has not changed is skipped.

import { copyFileSync, existsSync, readdirSync, rmSync } from 'node:fs';
import { join } from 'node:path';

import { buildIfChanged } from './fingerprint.mjs';
import { NOTICES, writeNotices, writeNoticesOfWheel } from './notices.mjs';
import { cargoHome, projectText, root, which } from './project.mjs';
import { Stop, must, run, say } from './run.mjs';
import { pinnedRust, versionOfRust, wasmTools } from './rust.mjs';

const TARGET = 'wasm32-unknown-unknown';
/** The crate of the package's modules. */
const CALLS = 'veronese-wasm';
/** Texts in the package and on the page. */
const LICENCES = ['LICENSE-APACHE', 'LICENSE-MIT', NOTICES];
const RUST_SOURCES = ['src', 'wasm/src', 'wasm/Cargo.toml', 'Cargo.toml', 'Cargo.lock', '.cargo', 'scripts/wasm-tools'];

/**
 * The modules. The core (frames) and the measurements module run everywhere; segmenting frames needs only the core.
 * The module with codecs has everything and reads image files in Node.
 */
export const MODULES = [
  { name: 'veronese', folder: 'pkg/wasm', title: 'the core module', features: ['frames'] },
  { name: 'veronese_points', folder: 'pkg/wasm/points', title: 'the module of measurements', features: ['points'] },
  { name: 'veronese_codecs', folder: 'pkg/wasm/codecs', title: 'the module with codecs', features: ['frames', 'points', 'codecs'] },
];

/** Shows the steps of the method one by one, for the site alone; no part of the package. */
const STAGES = {
  name: 'veronese_stages',
  folder: 'site/module',
  title: 'the module of the site',
  crate: 'veronese-site',
  features: [],
  sources: ['site/stages', 'scenes/src', 'scenes/Cargo.toml'],
};

/** Compiles Rust to WebAssembly, one module after another. */
export const buildModules = once(() => buildEach(MODULES));

/** Compiles the module of the site. Only what shows the site or tests it needs it. */
export const buildStagesModule = once(() => buildEach([STAGES]));

async function buildEach(modules) {
  const optimiser = await run('wasm-opt', ['--version'], { output: 'collect' });
  if (!which('wasm-opt')?.startsWith(join(root, 'node_modules'))) {
    throw new Stop('wasm-opt of the npm package binaryen is missing: delete node_modules and run the command again.');
  }
  const versions = [await versionOfRust(pinnedRust()), optimiser.text];
  for (const module of modules) {
    const { name, folder, title, sources = [] } = module;
    const outputs = [`${folder}/${name}.js`, `${folder}/${name}.d.ts`, `${folder}/${name}_bg.wasm`];
    await step(`${title} (a minute or two when everything is new)`, folder, outputs, [...RUST_SOURCES, ...sources], versions, () =>
      buildModule(module),
    );
  }
}

/** Compiles the modules while the program that writes them is being compiled itself. Without it they take longer, and nothing else. */
export async function compileAhead() {
  for (const module of MODULES) await compile(module, { output: 'collect' }).catch(() => undefined);
}

/** Builds the modules, then the npm package: their JavaScript, the compiled TypeScript, and the bundle of both in a few files. */
export const buildPackage = once(async () => {
  await buildModules();
  const parts = ['Cargo.lock', 'package-lock.json', 'wasm/Cargo.toml', 'pkg/package.json', 'www/package.json', 'scripts/lib/notices.mjs'];
  await step('the notices of licences', NOTICES, [NOTICES], parts, [], writeNotices);
  // Includes the modules, because one entry of the package embeds them.
  const glue = MODULES.flatMap(({ name, folder }) => [`${name}.js`, `${name}.d.ts`, `${name}_bg.wasm`].map((file) => `${folder}/${file}`));
  const sources = ['pkg/src', 'pkg/scripts', 'pkg/types', 'pkg/package.json', 'pkg/tsconfig.json'];
  const inputs = [...sources, ...glue, ...LICENCES, 'package-lock.json'];
  await step(
    'the npm package',
    'pkg/dist',
    ['pkg/build/module/glue.js', 'pkg/dist/node.js', 'pkg/dist/web.js', 'pkg/custom-elements.json', 'pkg/THIRD-PARTY-NOTICES'],
    inputs,
    [],
    () => must('The npm package could not be built.', 'npm', ['run', '--silent', 'build', '--workspace', 'pkg']),
  );
});

/** Builds the package, then the page with the parts of it that it uses. */
export const buildPage = once(async () => {
  await buildPackage();
  const built = ['pkg/dist', 'pkg/types', 'pkg/package.json', 'pkg/wasm/veronese_bg.wasm'];
  const inputs = ['www', 'examples/embed', 'scripts/lib/policy.mjs', ...built, ...LICENCES, 'package-lock.json'];
  await step('the page', 'www/dist', ['www/dist/index.html'], inputs, [], () =>
    must('The page could not be built.', 'npm', ['run', '--silent', 'build', '--workspace', 'www']),
  );
});

/** Builds the wheel of the Python package, with the maturin of an environment. Returns its path. Cargo knows what is up to date. */
export function buildWheel(python) {
  return makeWheel(python, ['--release'], {
    CARGO_PROFILE_RELEASE_LTO: 'fat',
    RUSTFLAGS: undefined,
    CARGO_ENCODED_RUSTFLAGS: pathFlags().join('\u001f'),
  });
}

/** The same wheel compiled as tests are, so that the native tests and it share the crate. */
export function buildTestWheel(python) {
  return makeWheel(python, ['--profile', 'dev', '--features', 'veronese/stages']);
}

async function makeWheel(python, profile, env = {}) {
  say('Building the wheel of the Python package …');
  const folder = join(root, 'out', 'wheel');
  rmSync(folder, { recursive: true, force: true });
  await must('The Rust packages could not be fetched.', 'cargo', ['fetch', '--locked']);
  await writeNoticesOfWheel();
  for (const name of ['LICENSE-APACHE', 'LICENSE-MIT']) copyFileSync(join(root, name), join(root, 'python', name));
  const args = [
    '-m',
    'maturin',
    'build',
    '--quiet',
    '--locked',
    ...profile,
    '--manifest-path',
    join(root, 'python', 'Cargo.toml'),
    '--out',
    folder,
  ];
  await must('The wheel could not be built.', python, args, { env });
  return join(folder, readdirSync(folder)[0]);
}

/** The same build for all who ask for it, one after another or at the same time. */
function once(build) {
  let built;
  return () => (built ??= build());
}

async function step(title, folder, outputs, inputs, versions, build) {
  const built = await buildIfChanged(folder.replaceAll('/', '-'), { inputs, outputs, versions }, async () => {
    say(`Building ${title} …`);
    await build();
  });
  if (!built) say(`${folder} is up to date.`);
}

/** Compiles a module, writes its JavaScript and types, and has wasm-opt make it smaller, as wasm-pack does and with its settings. */
async function buildModule({ name, folder, crate = CALLS, features }) {
  await compile({ crate, features });
  rmSync(join(root, folder, `${name}_bg.wasm`), { force: true });
  await must('The JavaScript of the module could not be written.', wasmTools, [
    'module',
    `target/${TARGET}/release/${crate.replace('-', '_')}.wasm`,
    folder,
    name,
  ]);
  const module = `${folder}/${name}_bg.wasm`;
  // Set-up installs it.
  const { parse } = await import('smol-toml');
  const { metadata } = parse(projectText('wasm/Cargo.toml')).package;
  await must('The module could not be made smaller.', 'wasm-opt', [
    module,
    '-o',
    module,
    ...metadata['wasm-pack'].profile.release['wasm-opt'],
  ]);
}

async function compile({ crate = CALLS, features }, options = {}) {
  // The dependencies' sources must be downloaded before the flags below can name their folders.
  await must('The Rust packages could not be fetched.', 'cargo', ['fetch', '--locked', '--target', TARGET], { output: 'collect' });
  const args = ['build', '--lib', '--release', '--target-dir', 'target', '--target', TARGET, '--package', crate, ...ofModule(features)];
  await must('The WebAssembly module could not be compiled.', 'cargo', args, { ...options, env: ofProject() });
}

/** Cargo's arguments for a module with these features. */
export function ofModule(features) {
  const config = `target.${TARGET}.rustflags=${JSON.stringify(pathFlags())}`;
  return ['--locked', '--config', config, '--no-default-features', '--features', features.join(',')];
}

/** Cargo's arguments for a test of the modules' own crate, and the environment: with these, the libraries are those that the modules have. */
export function testOfModules(name) {
  const args = [
    'test',
    '--package',
    CALLS,
    '--test',
    name,
    '--release',
    '--target-dir',
    'target',
    '--target',
    TARGET,
    ...ofModule(MODULES.at(-1).features),
  ];
  return {
    args,
    env: {
      ...ofProject(),
      CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_RUNNER: `node ${join(root, 'scripts', 'lib', 'wasm-test-runner.mjs')}`,
      VERONESE_WASM_TOOLS: wasmTools,
    },
  };
}

/** Keeps the builder's folders out of modules and wheels, so that the same sources give the same bytes everywhere. */
function pathFlags() {
  const sources = join(cargoHome, 'registry', 'src');
  const registries = existsSync(sources) ? readdirSync(sources) : [];
  return registries.map((registry) => `--remap-path-prefix=${join(sources, registry)}=/cargo`);
}

/** The pinned compiler, without the variables that would override the flags of .cargo/config.toml, which enable SIMD. */
export function ofProject() {
  return { ...pinnedRust(), RUSTFLAGS: undefined, CARGO_ENCODED_RUSTFLAGS: undefined };
}
