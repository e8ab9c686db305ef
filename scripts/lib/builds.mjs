// The three things that are built: WebAssembly modules, npm package, page. Each is skipped when nothing changed.

import { existsSync, readdirSync } from 'node:fs';
import { join } from 'node:path';

import { buildIfChanged } from './fingerprint.mjs';
import { cargoHome, root, which } from './project.mjs';
import { Stop, must, run } from './run.mjs';

const TARGET = 'wasm32-unknown-unknown';
const RUST_SOURCES = ['src', 'Cargo.toml', 'Cargo.lock', '.cargo'];

/**
 * The modules that wasm-pack builds. The core, for frames, runs everywhere, and so does that of measurements, which few who segment
 * frames need; the one with codecs has everything and reads image files in Node.
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

/** Rust to WebAssembly, a module after the other. */
export async function buildModules() {
  const versions = await Promise.all(
    [['rustc', '-vV'], ['wasm-pack', '--version'], ['wasm-bindgen', '--version'], ['wasm-opt', '--version']].map(
      async ([program, flag]) => (await run(program, [flag], { output: 'collect' })).text,
    ),
  );
  // wasm-pack leaves the step out without an error where there is no wasm-opt, and takes any it meets on the path.
  if (!which('wasm-opt')?.startsWith(join(root, 'node_modules'))) {
    throw new Stop('wasm-opt of the npm package binaryen is missing: delete node_modules and run the command again.');
  }
  for (const { name, folder, title, features } of MODULES) {
    const outputs = [`${folder}/${name}.js`, `${folder}/${name}.d.ts`, `${folder}/${name}_bg.wasm`];
    await step(`${title} (one to three minutes when everything is new)`, folder, outputs, RUST_SOURCES, versions, () =>
      wasmPack(name, folder, features),
    );
  }
}

/** The npm package: the JavaScript beside the modules, TypeScript to JavaScript, and all of it joined into few files. */
export async function buildPackage() {
  // The modules too: one entry of the package holds them.
  const glue = MODULES.flatMap(({ name, folder }) => [`${name}.js`, `${name}.d.ts`, `${name}_bg.wasm`].map((file) => `${folder}/${file}`));
  const sources = ['pkg/src', 'pkg/scripts', 'pkg/types', 'pkg/package.json', 'pkg/tsconfig.json'];
  const inputs = [...sources, ...glue, 'package-lock.json'];
  await step('the npm package', 'pkg/dist', ['pkg/build/module/glue.js', 'pkg/dist/node.js', 'pkg/dist/web.js'], inputs, [], () =>
    must('The npm package could not be built.', 'npm', ['run', '--silent', 'build', '--workspace', 'pkg']),
  );
}

/** The page, with what it takes from the package. */
export async function buildPage() {
  const inputs = ['www', 'scripts/lib/policy.mjs', 'pkg/dist', 'pkg/types', 'pkg/package.json', 'pkg/wasm/veronese_bg.wasm', 'package-lock.json'];
  await step('the page', 'www/dist', ['www/dist/index.html'], inputs, [], () =>
    must('The page could not be built.', 'npm', ['run', '--silent', 'build', '--workspace', 'www']),
  );
}

async function step(title, folder, outputs, inputs, versions, build) {
  const built = await buildIfChanged(folder.replaceAll('/', '-'), { inputs, outputs, versions }, async () => {
    console.log(`Building ${title} …`);
    await build();
  });
  if (!built) console.log(`${folder} is up to date.`);
}

async function wasmPack(name, folder, features) {
  // The sources of dependencies must be there before their folders can be named in the flags below.
  await must('The Rust packages could not be fetched.', 'cargo', ['fetch', '--locked', '--target', TARGET]);
  // --out-dir is never pkg itself: wasm-pack deletes the package.json it finds there. One folder for each module,
  // because wasm-pack optimises every module in the folder.
  const pack = ['build', '--release', '--target', 'web', '--mode', 'no-install', '--no-pack', '--no-gitignore'];
  const cargo = ['--locked', '--config', `target.${TARGET}.rustflags=${JSON.stringify(pathFlags())}`];
  cargo.push('--no-default-features', '--features', features.join(','));
  await must(
    'The WebAssembly module could not be built.',
    'wasm-pack',
    [...pack, '--out-dir', folder, '--out-name', name, '--', ...cargo],
    // These variables would replace the flags of .cargo/config.toml, and SIMD with them.
    { env: { RUSTFLAGS: undefined, CARGO_ENCODED_RUSTFLAGS: undefined } },
  );
}

/** Keeps the builder's folders out of the module, so that the same sources give the same bytes everywhere. */
function pathFlags() {
  const sources = join(cargoHome, 'registry', 'src');
  const registries = existsSync(sources) ? readdirSync(sources) : [];
  return registries.map((registry) => `--remap-path-prefix=${join(sources, registry)}=/cargo`);
}
