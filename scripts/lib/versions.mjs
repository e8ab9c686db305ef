// The version: crate, packages and page are released together and have the same one.

import { inProject, projectText } from './project.mjs';

const MANIFESTS = ['package.json', 'pkg/package.json', 'www/package.json'];
/** Those that do not exist are left out. */
const CRATES = ['Cargo.toml', 'wasm/Cargo.toml', 'python/Cargo.toml'];
/** The files that name a version of the package. */
const NAMED = [
  ['pkg/README.md', /veronese@(\d[\w.-]*)\//g],
  ...['element', 'embedding'].map((name) => [`site/pages/guide/${name}.md`, /veronese@(\d[\w.-]*)\//g]),
  ...['hosts', 'svelte', 'vue'].map((name) => [`examples/${name}/package.json`, /"veronese": "\^([^"]+)"/g]),
  ['fuzz/Cargo.lock', /name = "veronese"\r?\nversion = "([^"]+)"/g],
];

/** Every file that has the version, and the version there. */
export async function versions() {
  // Loaded when it is needed: this file is also imported before npm has installed anything.
  const { parse } = await import('smol-toml');
  const toml = (path) => parse(projectText(path));
  const shared = toml('Cargo.toml').workspace?.package?.version;
  const found = {};
  for (const path of CRATES.filter(inProject)) {
    const { name, version } = toml(path).package;
    found[path] = version?.workspace ? shared : version;
    found[`${lockOf(path)} (${name})`] = toml(lockOf(path)).package.find((locked) => locked.name === name && !locked.source)?.version;
  }
  for (const path of MANIFESTS) found[path] = JSON.parse(projectText(path)).version;
  const { packages } = JSON.parse(projectText('package-lock.json'));
  for (const path of MANIFESTS) found[`package-lock.json (${path})`] = packages[path.replace(/\/?package\.json$/, '')]?.version;
  for (const [path, pattern] of NAMED.filter(([name]) => inProject(name))) {
    for (const [, number] of projectText(path).matchAll(pattern))
      found[path] = found[path] === undefined || found[path] === number ? number : 'several';
  }
  const python = inProject('python/pyproject.toml') ? toml('python/pyproject.toml').project : undefined;
  if (python && !python.dynamic?.includes('version')) found['python/pyproject.toml'] = python.version;
  return found;
}

/** A sentence if they differ, from each other or from `wanted`. */
export function versionProblem(found, wanted = found['Cargo.toml']) {
  const others = Object.entries(found).filter(([, number]) => number !== wanted);
  if (others.length === 0) return undefined;
  return `The version is ${wanted}, but ${others.map(([file, number]) => `${number ?? 'missing'} in ${file}`).join(', ')}.`;
}

/** A crate that is no member of the workspace has a lock file of its own. */
function lockOf(path) {
  const own = path.replace('Cargo.toml', 'Cargo.lock');
  return inProject(own) ? own : 'Cargo.lock';
}
