// The Rust side of set-up: compiler, wasm target, linker, wasm-pack and wasm-bindgen.

import { existsSync, rmSync } from 'node:fs';
import { join } from 'node:path';

import { installDebianPackages } from './debian.mjs';
import { atLeast, projectText, toolsFolder, which } from './project.mjs';
import { Stop, longStep, run } from './run.mjs';

const TARGET = 'wasm32-unknown-unknown';
const WASM_PACK = '0.15.1';
const GECKODRIVER = '0.37.1';
const RUSTUP = 'https://rustup.rs';
// Shared by both tools, which have packages in common. Removed at the end, so an interrupted installation resumes where it stopped.
const COMPILE_FOLDER = join(toolsFolder, 'build');

/** The version of wasm-bindgen in Cargo.lock; the program that generates the JavaScript must have the same version. */
export function wasmBindgenVersion() {
  const found = /name = "wasm-bindgen"\r?\nversion = "([^"]+)"/.exec(projectText('Cargo.lock'));
  if (!found) throw new Stop('Cargo.lock names no version of wasm-bindgen; restore it with `git checkout Cargo.lock`.');
  return found[1];
}

/** Checks the compiler and linker, which every build needs. Throws one sentence that names everything missing. */
export async function checkRust() {
  const problems = [];
  const needed = /^rust-version = "([^"]+)"/m.exec(projectText('Cargo.toml'))[1];
  for (const program of ['cargo', 'rustc']) {
    const { code, text } = await run(program, ['--version'], { output: 'collect' });
    const version = new RegExp(`^${program} (\\d[\\d.]*)`, 'm').exec(text)?.[1];
    if (code === 127) {
      problems.push(`${program} was not found: install Rust from ${RUSTUP}, then open a new shell.`);
    } else if (code !== 0 || !version) {
      problems.push(`${program} does not run (${text.trim().split('\n')[0]}): try \`rustup update stable\`.`);
    } else if (!atLeast(version, needed)) {
      problems.push(`${program} ${version} is too old, ${needed} is needed: run \`rustup update stable\`.`);
    }
  }
  if (problems.length === 0) problems.push(...(await linkerProblem()));
  if (problems.length > 0) throw new Stop(problems.join('\n'));
}

/** Installs the wasm target and, for checks, the formatter and clippy. */
export async function prepareCompiler({ checks }) {
  const { text } = await run('rustc', ['--print', 'target-libdir', '--target', TARGET], { output: 'collect' });
  if (!existsSync(text.trim())) {
    await rustup(['target', 'add', TARGET], `Rust cannot compile for ${TARGET}`);
  }
  if (!checks) return;
  const components = [];
  for (const [program, component] of [['fmt', 'rustfmt'], ['clippy', 'clippy']]) {
    if ((await run('cargo', [program, '--version'], { output: 'collect' })).code !== 0) components.push(component);
  }
  if (components.length > 0) {
    await rustup(['component', 'add', ...components], `The Rust tool chain has no ${components.join(' and no ')}`);
  }
}

/** Installs wasm-pack and wasm-bindgen, each in exactly the version this project requires. */
export async function prepareWasmTools() {
  await cargoInstall('wasm-bindgen', 'wasm-bindgen-cli', wasmBindgenVersion(), ['wasm-bindgen-test-runner']);
  await cargoInstall('wasm-pack', 'wasm-pack', WASM_PACK);
  rmSync(COMPILE_FOLDER, { recursive: true, force: true });
}

/** Installs the program that drives Firefox; only its tests need it. */
export async function prepareGeckodriver() {
  await cargoInstall('geckodriver', 'geckodriver', GECKODRIVER);
  rmSync(COMPILE_FOLDER, { recursive: true, force: true });
}

async function cargoInstall(program, crate, version, companions = []) {
  const { code, text } = await run(program, ['--version'], { output: 'collect' });
  const present = code === 0 && text.trim().split(' ')[1] === version;
  if (present && companions.every(which)) return;
  // The tools run for seconds, so quick compilation matters more than fast code.
  await longStep(
    `Installing ${crate} ${version} into .tools (some minutes; once)`,
    `${crate} ${version} could not be installed. See above; if it is the network, run the command again.`,
    'cargo',
    ['install', '--locked', '--force', '--root', toolsFolder, `${crate}@${version}`],
    {
      env: {
        CARGO_TARGET_DIR: COMPILE_FOLDER,
        CARGO_PROFILE_RELEASE_OPT_LEVEL: '1',
        CARGO_PROFILE_RELEASE_LTO: 'off',
        CARGO_PROFILE_RELEASE_CODEGEN_UNITS: '16',
        RUSTFLAGS: undefined,
        CARGO_ENCODED_RUSTFLAGS: undefined,
      },
    },
  );
}

async function rustup(args, lack) {
  const advice = `run \`rustup ${args.join(' ')}\``;
  if (!which('rustup')) throw new Stop(`${lack}, and there is no rustup to add it: install Rust from ${RUSTUP}.`);
  await longStep(`rustup ${args.join(' ')}`, `${lack}, and adding it failed: ${advice} and see why.`, 'rustup', args);
}

/** Build scripts are native programs and need a linker, which rustup does not install. */
async function linkerProblem() {
  if (process.platform === 'win32' || which('cc')) return [];
  if (await installDebianPackages(['gcc', 'libc6-dev'], 'a C compiler')) return [];
  const advice = process.platform === 'darwin' ? '`xcode-select --install`' : 'for example `apt-get install gcc libc6-dev`';
  return [`No C compiler (cc) was found, which Rust needs to link programs: install one, ${advice}.`];
}
