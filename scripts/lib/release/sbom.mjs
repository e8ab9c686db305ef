// Lists of what is shipped, in the form of CycloneDX: one of the crates in the modules and programs, one of the npm package.
// npm writes its own. cargo-cyclonedx is the one program of CycloneDX that reads Cargo's data instead of guessing from lock files.

import { mkdirSync, mkdtempSync, readFileSync, readdirSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { basename, join } from 'node:path';

import { projectText, root } from '../project.mjs';
import { must } from '../run.mjs';
import { prepareCycloneDx } from '../rust.mjs';

/** Crates that are never in what is shipped. */
const OWN = ['scenes', 'experiments', 'benches'];

/** Writes them and returns `{ path, name, count }` of each: what it is about, and how many components it has. */
export async function writeSboms(out) {
  mkdirSync(out, { recursive: true });
  await prepareCycloneDx();
  return [await npmSbom(out), ...(await crateSboms(out))];
}

/** In a folder of its own: what users install, and what the package's scripts contain already, which the notices name. */
async function npmSbom(out) {
  const folder = mkdtempSync(join(tmpdir(), 'veronese-sbom-'));
  try {
    const { name, version, description, license, repository, dependencies, devDependencies } = JSON.parse(projectText('pkg/package.json'));
    const notices = projectText('pkg/THIRD-PARTY-NOTICES');
    const contained = Object.fromEntries(Object.entries(devDependencies).filter((entry) => notices.includes(`\n- ${entry.join(' ')}: `)));
    const manifest = { name, version, description, license, repository, dependencies: { ...dependencies, ...contained } };
    writeFileSync(join(folder, 'package.json'), JSON.stringify(manifest));
    const npm = (sentence, ...args) => must(sentence, 'npm', [...args, '--package-lock-only'], { cwd: folder, output: 'collect' });
    await npm('The dependencies of the npm package could not be found.', 'install', '--ignore-scripts', '--no-audit', '--no-fund', '--omit-lockfile-registry-resolved');
    const { stdout } = await npm('npm could not list the dependencies.', 'sbom', '--sbom-format', 'cyclonedx', '--sbom-type', 'library');
    const list = JSON.parse(stdout);
    // npm takes the folder's.
    list.metadata.component.name = name;
    return keep(join(out, `${name}-npm.cdx.json`), list);
  } finally {
    rmSync(folder, { recursive: true, force: true });
  }
}

/** cargo-cyclonedx writes a file beside each manifest of the workspace; those that are not of shipped crates are dropped. */
async function crateSboms(out) {
  const name = 'release.cdx';
  const args = ['cyclonedx', '--format', 'json', '--spec-version', '1.5', '--all-features', '--target', 'all', '--override-filename', name];
  await must('The crates could not be listed.', 'cargo', args, { output: 'collect' });
  const kept = [];
  for (const folder of ['.', ...readdirSync(root, { withFileTypes: true }).filter((entry) => entry.isDirectory()).map((entry) => entry.name)]) {
    const path = join(root, folder, `${name}.json`);
    let list;
    try {
      list = JSON.parse(readFileSync(path, 'utf8'));
    } catch {
      continue;
    }
    rmSync(path);
    if (!OWN.includes(folder)) kept.push(keep(join(out, `${list.metadata.component.name}-crates.cdx.json`), list));
  }
  return kept;
}

/** Without what differs between two lists of the same things: when and where they were made. */
function keep(path, list) {
  delete list.serialNumber;
  if (list.metadata) delete list.metadata.timestamp;
  writeFileSync(path, `${JSON.stringify(list, null, 2)}\n`.replaceAll(`file://${root}`, 'file:///'));
  return { path, name: basename(path), count: list.components?.length ?? 0 };
}
