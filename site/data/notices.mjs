// Licences of the project, of what its module, package and app contain, and of what the site adds.

import { readFileSync } from 'node:fs';

const read = (path) => readFileSync(new URL(`../../${path}`, import.meta.url), 'utf8');
const version = (folder) => JSON.parse(read(`${folder}/package.json`)).version;

const PAGEFIND = 'site/node_modules/pagefind';
const TYPEDOC = 'pkg/test/hosts/node_modules/typedoc';
const LUNR = 'pkg/test/hosts/node_modules/lunr';

export default {
  project: ['LICENSE-MIT', 'LICENSE-APACHE', 'THIRD-PARTY-NOTICES'].map((name) => ({ name, text: read(name) })),
  site: [
    { name: `Pagefind ${version(PAGEFIND)}, the search`, licence: 'MIT', source: 'https://github.com/Pagefind/pagefind', text: read(`${PAGEFIND}/LICENSE/LICENSE`) },
    {
      name: `TypeDoc ${version(TYPEDOC)}, the scripts and styles of the reference of the package`,
      licence: 'Apache-2.0',
      source: 'https://github.com/TypeStrong/typedoc',
      text: read(`${TYPEDOC}/LICENSE`),
    },
    { name: `Lunr ${version(LUNR)}, the search of that reference`, licence: 'MIT', source: 'https://github.com/olivernn/lunr.js', text: read(`${LUNR}/LICENSE`) },
  ],
};
