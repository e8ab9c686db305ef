// The Rust side of set-up: compiler, wasm target, linker, and the programs that make WebAssembly modules.

import { existsSync, rmSync } from 'node:fs';
import { join } from 'node:path';

import { installDebianPackages } from './debian.mjs';
import { buildIfChanged } from './fingerprint.mjs';
import { atLeast, projectText, root, toolsFolder, which } from './project.mjs';
import { Stop, longStep, run, say } from './run.mjs';

const TARGET = 'wasm32-unknown-unknown';
/**
 * The Rust that compiles the modules that are shipped: .cargo/config.toml has internal flags of the compiler, which another version may read
 * in another way. Everything else takes any stable Rust from rust-version in Cargo.toml onwards.
 */
const PINNED = '1.95.0';
const GECKODRIVER = '0.37.1';
const WASM_PACK = '0.15.1';
const RUSTUP = 'https://rustup.rs';
// Removed at the end, so an interrupted installation resumes where it stopped.
const COMPILE_FOLDER = join(toolsFolder, 'build');

/** Of the program that writes modules with their JavaScript: its sources, Cargo's folder for it, and itself. */
const WASM_TOOLS = { sources: 'scripts/wasm-tools', target: '.tools/wasm-tools', program: '.tools/wasm-tools/release/wasm-tools' };
/** Flags of the user's are for other programs. */
const OF_PROGRAMS = { env: { RUSTFLAGS: undefined, CARGO_ENCODED_RUSTFLAGS: undefined } };
/** The path of the program that writes modules with their JavaScript. */
export const wasmTools = join(root, WASM_TOOLS.program);

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

/** The environment that chooses the pinned compiler; empty where that is the one on the path. */
let pinned = {};

export function pinnedRust() {
  return pinned;
}

/** What the compiler says of itself. */
export async function versionOfRust(env = {}) {
  return (await run('rustc', ['-vV'], { output: 'collect', env })).text;
}

/** Finds or installs the pinned compiler. */
async function preparePinned() {
  const { text } = await run('rustc', ['--version'], { output: 'collect' });
  if (text.startsWith(`rustc ${PINNED} `)) return;
  if ((await run('rustup', ['run', PINNED, 'rustc', '--version'], { output: 'collect' })).code !== 0) {
    await rustup(
      ['toolchain', 'install', PINNED, '--profile', 'minimal', '--target', TARGET],
      `The modules are compiled with Rust ${PINNED}, which is not installed`,
    );
  }
  pinned = { RUSTUP_TOOLCHAIN: PINNED };
}

/** Installs the pinned compiler, the wasm target for both and, for checks, the formatter and clippy. */
export async function prepareCompiler({ checks }) {
  await preparePinned();
  for (const env of Object.keys(pinned).length > 0 ? [{}, pinned] : [{}]) {
    const { text } = await run('rustc', ['--print', 'target-libdir', '--target', TARGET], { output: 'collect', env });
    if (!existsSync(text.trim())) await rustup(['target', 'add', TARGET], `Rust cannot compile for ${TARGET}`, env);
  }
  if (!checks) return;
  const components = [];
  for (const [program, component] of [
    ['fmt', 'rustfmt'],
    ['clippy', 'clippy'],
  ]) {
    if ((await run('cargo', [program, '--version'], { output: 'collect' })).code !== 0) components.push(component);
  }
  if (components.length > 0) {
    await rustup(['component', 'add', ...components], `The Rust tool chain has no ${components.join(' and no ')}`);
  }
}

/** Compiles what writes modules. Where that takes a minute, `meanwhile` runs beside it: neither keeps all cores busy all the time. */
export async function prepareWasmTools(meanwhile) {
  const { sources, target, program } = WASM_TOOLS;
  const build = ['build', '--locked', '--release', '--manifest-path', `${sources}/Cargo.toml`, '--target-dir', target];
  const compile = () =>
    longStep(
      'Compiling what writes WebAssembly modules (about a minute; once)',
      `${sources} could not be compiled. See above; if it is the network, run the command again.`,
      'cargo',
      build,
      OF_PROGRAMS,
    );
  await buildIfChanged('wasm-tools', { inputs: [sources], outputs: [program], versions: [await versionOfRust()] }, () =>
    Promise.all([compile(), meanwhile()]),
  );
}

/** Installs wasm-pack, and the version of wasm-bindgen's command line tool that it asks for; only a test of it needs them. */
export async function prepareWasmPack() {
  const version = /name = "wasm-bindgen"\r?\nversion = "([^"]+)"/.exec(projectText('Cargo.lock'))[1];
  await installAlone({ program: 'wasm-bindgen', crate: 'wasm-bindgen-cli', version, companions: ['wasm-bindgen-test-runner'] });
  await installAlone({ program: 'wasm-pack', crate: 'wasm-pack', version: WASM_PACK });
}

/** Installs the program that drives Firefox; only its tests need it. */
export async function prepareGeckodriver() {
  await installAlone({ program: 'geckodriver', crate: 'geckodriver', version: GECKODRIVER });
}

/** Installs a program unless it is on the path in exactly this version. */
async function installAlone(tool) {
  if (await isPresent(tool)) return;
  await cargoInstall(tool);
  rmSync(COMPILE_FOLDER, { recursive: true, force: true });
}

/** Installs a program: with cargo-binstall, which downloads it, where that is installed, otherwise by compiling it. */
async function cargoInstall(tool) {
  const name = `${tool.crate} ${tool.version}`;
  const crate = `${tool.crate}@${tool.version}`;
  const wanted = [tool.program, ...(tool.companions ?? [])].flatMap((program) => ['--bin', program]);
  if (which('cargo-binstall') && (await binstall(crate))) return;
  await longStep(
    `Installing ${name} into .tools (some minutes; once)`,
    `${name} could not be installed. See above; if it is the network, run the command again.`,
    'cargo',
    ['install', '--locked', '--force', '--root', toolsFolder, ...wanted, crate],
    {
      env: {
        CARGO_TARGET_DIR: COMPILE_FOLDER,
        // Programs run for a second and take minutes to compile.
        CARGO_PROFILE_RELEASE_OPT_LEVEL: '0',
        CARGO_PROFILE_RELEASE_LTO: 'off',
        CARGO_PROFILE_RELEASE_CODEGEN_UNITS: '16',
        CARGO_PROFILE_RELEASE_PANIC: 'abort',
        ...OF_PROGRAMS.env,
      },
    },
  );
}

/** Whether a program reports this version, and those that come with it are there too. */
async function isPresent({ program, version, companions = [], ask = ['--version'] }) {
  const { code, text } = await run(program, ask, { output: 'collect' });
  return code === 0 && text.trim().split(' ')[1] === version && companions.every(which);
}

/** Whether cargo-binstall could install the crate. It compiles nothing here: that is done above, with quicker settings. */
async function binstall(crate) {
  say(`Installing ${crate} into .tools with cargo-binstall …`);
  const args = ['binstall', '--no-confirm', '--disable-strategies', 'compile', '--root', toolsFolder, '--force', crate];
  return (await run('cargo', args, { output: 'collect' })).code === 0;
}

async function rustup(args, lack, env = {}) {
  const advice = `run \`rustup ${args.join(' ')}\``;
  if (!which('rustup')) throw new Stop(`${lack}, and there is no rustup to add it: install Rust from ${RUSTUP}.`);
  await longStep(`rustup ${args.join(' ')}`, `${lack}, and adding it failed: ${advice} and see why.`, 'rustup', args, { env });
}

/** Build scripts are native programs and need a linker, which rustup does not install. */
async function linkerProblem() {
  if (process.platform === 'win32' || which('cc')) return [];
  if (await installDebianPackages(['gcc', 'libc6-dev'], 'a C compiler')) return [];
  const advice = process.platform === 'darwin' ? '`xcode-select --install`' : 'for example `apt-get install gcc libc6-dev`';
  return [`No C compiler (cc) was found, which Rust needs to link programs: install one, ${advice}.`];
}
