// Names and addresses of the project, from the manifests that are published.

import { readFileSync } from 'node:fs';

const read = (path) => readFileSync(new URL(`../../${path}`, import.meta.url), 'utf8');
const { name, homepage, repository } = JSON.parse(read('pkg/package.json'));

const named = (manifest) => /^name = "(.*)"$/m.exec(read(manifest))[1];

export default {
  npm: name,
  site: homepage,
  repository: repository.url.replace(/^git\+|\.git$/g, ''),
  crate: named('Cargo.toml'),
  python: named('python/pyproject.toml'),
};
