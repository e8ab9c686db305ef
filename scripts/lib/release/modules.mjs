// The modules are built twice from the last commit, in two fresh folders, and must have the same bytes as those that are packed.

import { createHash } from 'node:crypto';
import { existsSync, mkdirSync, mkdtempSync, readFileSync, readdirSync, rmSync, symlinkSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';

import { environment, root } from '../project.mjs';
import { longStep, must } from '../run.mjs';

/** Where the packed modules are, in the project and in every copy of it. */
const PACKED = 'pkg/wasm';

/**
 * Builds the modules of the last commit in two folders of different lengths, side by side: a linker works on one core. Each compiles
 * everything for itself. Their modules are left in `out/modules-1` and `out/modules-2`.
 */
export async function buildTwice(out) {
  const folder = mkdtempSync(join(tmpdir(), 'veronese-release-'));
  try {
    await Promise.all([1, 2].map((count) => buildCopy(join(folder, `copy-${'of-the-sources-'.repeat(count)}${count}`), builds(out)[count - 1])));
  } finally {
    rmSync(folder, { recursive: true, force: true });
  }
}

/** Where the modules of the two builds are left. */
export function builds(out) {
  return [join(out, 'modules-1'), join(out, 'modules-2')];
}

async function buildCopy(copy, result) {
  mkdirSync(copy, { recursive: true });
  const archive = join(copy, 'sources.tar');
  await must('The last commit could not be exported.', 'git', ['archive', '--format=tar', `--output=${archive}`, 'HEAD']);
  await must('The last commit could not be unpacked.', 'tar', ['-xf', archive, '-C', copy]);
  rmSync(archive);
  // Programs only: nothing that is compiled comes from there.
  symlinkSync(join(root, 'node_modules'), join(copy, 'node_modules'));
  await longStep(
    `Building the modules in ${copy} (some minutes)`,
    'The modules of the last commit could not be built.',
    process.execPath,
    ['scripts/build.mjs', '--modules'],
    { cwd: copy, env: { PATH: environment.PATH, CARGO_TARGET_DIR: join(copy, 'target') } },
  );
  rmSync(result, { recursive: true, force: true });
  mkdirSync(result, { recursive: true });
  await must('The modules could not be kept.', 'cp', ['-R', `${join(copy, PACKED)}/.`, result]);
}

/** The hash of every module below a folder, by its path there. */
export function hashesOf(folder) {
  if (!existsSync(folder)) return {};
  const paths = readdirSync(folder, { recursive: true }).map((path) => String(path).replaceAll('\\', '/')).filter((path) => path.endsWith('_bg.wasm'));
  return Object.fromEntries(paths.sort().map((path) => [path, createHash('sha256').update(readFileSync(join(folder, path))).digest('hex')]));
}

/** A sentence for every module whose bytes are not the same in both builds and in what is packed. */
export function moduleProblems(out) {
  const [first, second] = builds(out).map(hashesOf);
  const packed = hashesOf(join(root, PACKED));
  const names = [...new Set([first, second, packed].flatMap((hashes) => Object.keys(hashes)))].sort();
  if (names.length === 0) return ['There are no modules to compare: run `npm run build`.'];
  return names.flatMap((name) => {
    if (!first[name] || first[name] !== second[name]) return [`${name} differs between two builds of the same commit.`];
    if (packed[name] !== first[name]) return [`${PACKED}/${name} is not what the last commit builds: delete it and run \`npm run build\`.`];
    return [];
  });
}
