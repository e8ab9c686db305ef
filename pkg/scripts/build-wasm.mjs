// Builds both WebAssembly modules into pkg/wasm: the core, which browsers and Node share, and the one that also reads and
// writes image files, for Node. wasm-pack, wasm-bindgen and wasm-opt are taken from PATH (npm scripts put the packages' first).
//
//   node pkg/scripts/build-wasm.mjs [--core-only]

import { spawnSync } from 'node:child_process';
import { appendFileSync, rmSync } from 'node:fs';
import { homedir } from 'node:os';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';

const root = fileURLToPath(new URL('../..', import.meta.url)).replace(/[/\\]$/, '');
const out = join(root, 'pkg', 'wasm');

// Paths of this machine end up in the messages of panics: replace them, so that the bytes are the same everywhere. Cargo adds
// these flags to those of .cargo/config.toml.
const cargoHome = process.env.CARGO_HOME ?? join(homedir(), '.cargo');
const remap = [`--remap-path-prefix=${cargoHome}=/cargo`, `--remap-path-prefix=${root}=/veronese`];
const variable = 'CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_RUSTFLAGS';
const env = { ...process.env, [variable]: [process.env[variable], ...remap].filter(Boolean).join(' ') };

function build(folder, name, cargoArguments) {
  const args = ['build', '--target', 'web', '--release', '--mode', 'no-install', '--no-pack', '--no-gitignore'];
  args.push('--out-dir', folder, '--out-name', name, ...cargoArguments);
  const { status, error } = spawnSync('wasm-pack', args, { cwd: root, env, stdio: 'inherit' });
  if (error) {
    console.error(`veronese: wasm-pack cannot be run (${error.message}); "npm start" in the project's folder installs it`);
    process.exit(1);
  }
  if (status !== 0) process.exit(status ?? 1);
  // The glue keeps its one instance for ever. After a panic an instance cannot be trusted: let the package ask for a new one.
  appendFileSync(join(folder, `${name}.js`), '\nexport function forgetInstance() {\n    wasm = undefined;\n}\n');
  appendFileSync(
    join(folder, `${name}.d.ts`),
    '\n/**\n * Lets go of the instance: the next initialisation makes a new one.\n */\nexport function forgetInstance(): void;\n',
  );
}

rmSync(out, { recursive: true, force: true });
build(out, 'veronese', []);
if (!process.argv.includes('--core-only')) build(join(out, 'codecs'), 'veronese_codecs', ['--', '--features', 'codecs']);
