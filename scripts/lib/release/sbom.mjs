// Lists of what is shipped, in the form of CycloneDX: one of the crates in the modules and programs, one of the npm package.
// npm writes its own. cargo-cyclonedx is the one program of CycloneDX that reads Cargo's data instead of guessing from lock files.

import { mkdirSync, readFileSync, readdirSync, rmSync, writeFileSync } from 'node:fs';
import { basename, join } from 'node:path';

import { root } from '../project.mjs';
import { must } from '../run.mjs';
import { prepareCycloneDx } from '../rust.mjs';

/** Writes them and returns `{ path, name, count }` of each: what it is about, and how many components it has. */
export async function writeSboms(out) {
  mkdirSync(out, { recursive: true });
  await prepareCycloneDx();
  return [await npmSbom(out), ...(await crateSboms(out))];
}

async function npmSbom(out) {
  const args = ['sbom', '--sbom-format', 'cyclonedx', '--sbom-type', 'library', '--omit', 'dev', '--workspace', 'pkg'];
  const { stdout } = await must('npm could not list its packages.', 'npm', args, { output: 'collect' });
  return keep(join(out, 'veronese-npm.cdx.json'), JSON.parse(stdout));
}

/** cargo-cyclonedx writes a file beside each manifest of the workspace; those that are not of shipped crates are dropped. */
async function crateSboms(out) {
  const name = 'release.cdx';
  const args = ['cyclonedx', '--format', 'json', '--all-features', '--target', 'all', '--override-filename', name];
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
    if (folder !== 'scenes') kept.push(keep(join(out, `${list.metadata.component.name}-crates.cdx.json`), list));
  }
  return kept;
}

/** Without what differs between two lists of the same things: when and where they were made. */
function keep(path, list) {
  delete list.serialNumber;
  if (list.metadata) delete list.metadata.timestamp;
  writeFileSync(path, `${JSON.stringify(list, null, 2)}\n`);
  return { path, name: basename(path), count: list.components?.length ?? 0 };
}
