// Builds the WebAssembly modules, the npm package and the page. Each is skipped if nothing changed.

import { copyFileSync, existsSync, readdirSync } from 'node:fs';
import { dirname, join } from 'node:path';

import { buildIfChanged } from './fingerprint.mjs';
import { cargoHome, inProject, root, which } from './project.mjs';
import { Stop, must, run, say } from './run.mjs';

const TARGET = 'wasm32-unknown-unknown';
const RUST_SOURCES = ['src', 'Cargo.toml', 'Cargo.lock', '.cargo'];

/**
 * The modules. The core (frames) and the measurements module run everywhere; segmenting frames needs only the core.
 * The module with codecs has everything and reads image files in Node.
 */
export const MODULES = [
  { name: 'veronese', folder: 'pkg/wasm', title: 'the core module', features: ['frames'] },
  { name: 'veronese_points', folder: 'pkg/wasm/points', title: 'the module of measurements', features: ['points'] },
  { name: 'veronese_codecs', folder: 'pkg/wasm/codecs', title: 'the module with codecs', features: ['frames', 'points', 'codecs'] },
];

/** Everything, in order. */
export async function buildAll() {
  await buildModules();
  await buildPackage();
  await buildPage();
}

/** Compiles Rust to WebAssembly. Cargo compiles one module after another; the next one while the one before is optimised. */
export const buildModules = once(async () => {
  const versions = await Promise.all(
    [['rustc', '-vV'], ['wasm-bindgen', '--version'], ['wasm-opt', '--version']].map(
      async ([program, flag]) => (await run(program, [flag], { output: 'collect' })).text,
    ),
  );
  if (!which('wasm-opt')?.startsWith(join(root, 'node_modules'))) {
    throw new Stop('wasm-opt of the npm package binaryen is missing: delete node_modules and run the command again.');
  }
  let turn = Promise.resolve();
  const built = MODULES.map((module) => {
    const outputs = [`${module.name}.js`, `${module.name}.d.ts`, `${module.name}_bg.wasm`].map((file) => `${module.folder}/${file}`);
    return step(`${module.title} (one to three minutes when everything is new)`, module.folder, outputs, RUST_SOURCES, versions, async () => {
      await finish(module, await (turn = turn.then(() => compileOnce(module))));
    });
  });
  await Promise.all(built);
});

/** Compiles the modules that are not there yet, as far as Cargo goes, while their other tools are still being installed. */
export async function compileModulesAhead() {
  const missing = MODULES.filter(({ name, folder }) => !inProject(`${folder}/${name}_bg.wasm`));
  if (missing.length > 0) say('Compiling the modules meanwhile …');
  for (const module of missing) await compileOnce(module, { output: 'collect' });
}

/** Builds the npm package: the modules' JavaScript, the compiled TypeScript, and the bundle of both in a few files. */
export const buildPackage = once(async () => {
  // Includes the modules, because one entry of the package embeds them.
  const glue = MODULES.flatMap(({ name, folder }) => [`${name}.js`, `${name}.d.ts`, `${name}_bg.wasm`].map((file) => `${folder}/${file}`));
  const sources = ['pkg/src', 'pkg/scripts', 'pkg/types', 'pkg/package.json', 'pkg/tsconfig.json'];
  const inputs = [...sources, ...glue, 'package-lock.json'];
  await step('the npm package', 'pkg/dist', ['pkg/build/module/glue.js', 'pkg/dist/node.js', 'pkg/dist/web.js'], inputs, [], () =>
    must('The npm package could not be built.', 'npm', ['run', '--silent', 'build', '--workspace', 'pkg']),
  );
});

/** Builds the page with the parts of the package that it uses. */
export const buildPage = once(async () => {
  const built = ['pkg/dist', 'pkg/types', 'pkg/package.json', 'pkg/wasm/veronese_bg.wasm'];
  const licences = ['LICENSE-APACHE', 'LICENSE-MIT', 'THIRD-PARTY-NOTICES'];
  const inputs = ['www', 'examples/embed', 'scripts/lib/policy.mjs', ...built, ...licences, 'package-lock.json'];
  await step('the page', 'www/dist', ['www/dist/index.html'], inputs, [], () =>
    must('The page could not be built.', 'npm', ['run', '--silent', 'build', '--workspace', 'www']),
  );
});

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

const compilations = new Map();

/** Compiles a module unless this program has done so: Cargo would again, because all modules have one name and each replaces the last. */
function compileOnce(module, options) {
  if (!compilations.has(module.name)) compilations.set(module.name, compile(module, options));
  return compilations.get(module.name);
}

/** Compiles a module and returns the path of what wasm-bindgen takes. */
async function compile({ name, features }, options = {}) {
  const { crate, compiled } = await moduleCrate();
  // The dependencies' sources must be downloaded before the flags below can name their folders.
  await must('The Rust packages could not be fetched.', 'cargo', ['fetch', '--locked', '--target', TARGET], options);
  const flags = ['--config', `target.${TARGET}.rustflags=${JSON.stringify(pathFlags())}`];
  const what = ['--package', crate, '--lib', '--no-default-features', '--features', features.join(',')];
  await must('The WebAssembly module could not be compiled.', 'cargo', ['build', '--locked', '--release', '--target', TARGET, ...what, ...flags], {
    ...options,
    // These variables would override the flags of .cargo/config.toml, which enable SIMD.
    env: { RUSTFLAGS: undefined, CARGO_ENCODED_RUSTFLAGS: undefined },
  });
  // The next module gets the same name.
  const own = join(dirname(compiled), `${name}.module.wasm`);
  copyFileSync(compiled, own);
  return own;
}

/** Makes a compiled module's JavaScript and types, and optimises it. */
async function finish({ name, folder }, compiled) {
  const { optimisation } = await moduleCrate();
  await must('The JavaScript of the module could not be made.', 'wasm-bindgen', ['--target', 'web', '--out-dir', folder, '--out-name', name, compiled]);
  const module = join(root, folder, `${name}_bg.wasm`);
  await must('The module could not be optimised.', 'wasm-opt', [module, '-o', module, ...optimisation]);
}

/** The crate that is compiled to modules: its name, the file that Cargo makes, and the flags for wasm-opt. wasm-pack takes them from there too. */
const moduleCrate = once(async () => {
  const args = ['metadata', '--locked', '--no-deps', '--format-version', '1'];
  const { stdout } = await must('The crates of the project could not be listed.', 'cargo', args, { output: 'collect' });
  const { packages, target_directory: target } = JSON.parse(stdout);
  const crate = packages.find(({ metadata }) => metadata?.['wasm-pack']);
  const library = crate.targets.find(({ crate_types: types }) => types.includes('cdylib')).name.replaceAll('-', '_');
  const optimisation = crate.metadata['wasm-pack'].profile.release['wasm-opt'];
  return { crate: crate.name, compiled: join(target, TARGET, 'release', `${library}.wasm`), optimisation };
});

/** Keeps the builder's folders out of the module, so that the same sources give the same bytes everywhere. */
function pathFlags() {
  const sources = join(cargoHome, 'registry', 'src');
  const registries = existsSync(sources) ? readdirSync(sources) : [];
  return registries.map((registry) => `--remap-path-prefix=${join(sources, registry)}=/cargo`);
}
