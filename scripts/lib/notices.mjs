// THIRD-PARTY-NOTICES: the licences of what others wrote and Veronese ships, from the sources that Cargo and npm have downloaded.
// The builds write it. cargo-about does the same for crates, but takes minutes to compile and knows no packages of npm.

import { readdirSync, readFileSync, writeFileSync } from 'node:fs';
import { dirname, join } from 'node:path';

import { projectText, root } from './project.mjs';
import { must } from './run.mjs';

/** In the npm package, on the page and on the site. */
export const NOTICES = 'THIRD-PARTY-NOTICES';
const NOTICES_OF_WHEEL = 'python/THIRD-PARTY-NOTICES';

/** In the package's scripts, but no dependency of theirs. */
const BUNDLED = ['@rgrove/parse-xml', 'fflate'];

/** Words that only the text of that licence has: the first that a component offers is taken. */
const LICENCES = {
  'BSD-2-Clause': /Redistribution and use in source and binary forms(?![^]*name of)/,
  ISC: /Permission to use, copy, modify, and\/or distribute/,
  MIT: /Permission is hereby granted, free of charge/,
  'BSD-3-Clause': /Redistribution and use in source and binary forms/,
  'Apache-2.0': /Apache License\s+Version 2\.0/,
  'Unicode-3.0': /UNICODE LICENSE V3/,
  'OFL-1.1': /SIL OPEN FONT LICENSE Version 1\.1/,
  'MPL-2.0': /Mozilla Public License Version 2\.0/,
};

/** In everything compiled, and in no list of packages: it comes with the compiler, with crates of others under the same licences. */
const standardLibrary = (crates) => ({
  name: 'Rust standard library',
  version: `(core, alloc and std, with ${crates})`,
  licence: 'MIT OR Apache-2.0',
  source: 'https://github.com/rust-lang/rust',
  texts: [
    `Copyright (c) The Rust Project Contributors\n\n${/Permission is hereby granted[^]*/.exec(projectText('LICENSE-MIT'))[0].trim()}`,
  ],
});

/** The targets of wheels. */
const NATIVE = [
  'x86_64-unknown-linux-gnu',
  'aarch64-unknown-linux-gnu',
  'x86_64-apple-darwin',
  'aarch64-apple-darwin',
  'x86_64-pc-windows-msvc',
];

/** The letters of the page's name; README.md there says how they were made. */
const WORDMARK = () =>
  component(
    'Cormorant Garamond',
    '4.001 (Bold, six letters)',
    'OFL-1.1',
    'https://github.com/CatharsisFonts/Cormorant',
    join(root, 'www/src/styles/wordmark'),
  );

async function partsOfProject() {
  const modules = await crates(['--manifest-path', 'wasm/Cargo.toml', '--features', 'codecs'], 'wasm32-unknown-unknown');
  return [
    ['In the WebAssembly modules', [standardLibrary('compiler_builtins, dlmalloc and hashbrown'), ...modules]],
    ["In the page's scripts", packages()],
    ['In the name at the top of the page', [WORDMARK()]],
  ];
}

async function partsOfWheel() {
  const all = new Map();
  for (const target of NATIVE) {
    for (const crate of await crates(['--manifest-path', 'python/Cargo.toml'], target)) all.set(`${crate.name} ${crate.version}`, crate);
  }
  const std = standardLibrary(
    'addr2line, adler2, cfg_if, compiler_builtins, gimli, hashbrown, libc, memchr, miniz_oxide, object and rustc_demangle',
  );
  return [['In the module', [std, ...[...all.values()].sort(byName)]]];
}

export async function writeNotices() {
  write(NOTICES, await partsOfProject());
}

export async function writeNoticesOfWheel() {
  write(NOTICES_OF_WHEEL, await partsOfWheel());
}

function write(path, parts) {
  const components = parts.flatMap(([, all]) => all);
  const byText = new Map();
  for (const component of components) for (const text of component.texts) byText.set(text, [...(byText.get(text) ?? []), component]);
  const title = ({ name, version }) => `${name} ${version}`;
  const lines = [
    'Veronese is licensed under MIT OR Apache-2.0 (LICENSE-MIT, LICENSE-APACHE). It contains the following works of others.',
    'Source code is where the addresses point to, in the version that is named.',
    ...parts.flatMap(([place, all]) => [`\n${place}:\n`, ...all.map((one) => `- ${title(one)}: ${one.licence}, ${one.source}`)]),
    ...[...byText].map(([text, all]) => `\n${'-'.repeat(80)}\n${all.map(title).join(', ')}\n\n${text}`),
    '',
  ];
  writeFileSync(join(root, path), lines.join('\n'));
}

/** The crates that are compiled into a module: no macros, which run in the compiler, and nothing that only builds or tests need. */
async function crates(of, triple) {
  const cargo = async (name, target, ...args) => {
    const all = [name, '--locked', ...of, target, triple, ...args];
    return (await must(`cargo ${name} failed.`, 'cargo', all, { output: 'collect' })).stdout;
  };
  const tree = await cargo('tree', '--target', '--edges', 'normal,no-proc-macro', '--prefix', 'none', '--format', '{p}');
  const linked = new Set(tree.split('\n').map((line) => line.split(' ', 2).join(' ')));
  return JSON.parse(await cargo('metadata', '--filter-platform', '--format-version', '1'))
    .packages.filter(({ name, version, source }) => source !== null && linked.has(`${name} v${version}`))
    .map((crate) => component(crate.name, crate.version, crate.license, crate.repository, dirname(crate.manifest_path)))
    .sort(byName);
}

function byName(a, b) {
  return `${a.name} ${a.version}` < `${b.name} ${b.version}` ? -1 : 1;
}

/** Packages that npm installs for users of the package, and for the page: without types, which are not in a script. */
function packages() {
  const found = new Map();
  const add = (manifest) => {
    for (const name of Object.keys(manifest.dependencies ?? {})) {
      if (name === 'veronese' || name.startsWith('@types/') || found.has(name)) continue;
      const folder = join(root, 'node_modules', name);
      const { version, license, repository, ...more } = JSON.parse(readFileSync(join(folder, 'package.json'), 'utf8'));
      const source = (repository.url ?? repository).replace(/^git\+|\.git$/g, '');
      found.set(name, component(name, version, license, source, folder));
      add(more);
    }
  };
  add({ dependencies: Object.fromEntries(BUNDLED.map((name) => [name, ''])) });
  for (const place of ['pkg', 'www']) add(JSON.parse(projectText(`${place}/package.json`)));
  return [...found.values()].sort((a, b) => (a.name < b.name ? -1 : 1));
}

/** With the texts of the licences that it is used under: one of each choice, and its own notices. */
function component(name, version, licence, source, folder) {
  const files = readdirSync(folder)
    .filter((file) => /^(licen[sc]e|copying|copyright|notice)/i.test(file))
    .sort();
  const plain = (text) =>
    text
      .replaceAll('\r\n', '\n')
      .replace(/[ \t]+$/gm, '')
      .replace(/^\n+|\n+$/g, '');
  const all = files.map((file) => ({ file, text: plain(readFileSync(join(folder, file), 'utf8')) }));
  const texts = licence.split(' AND ').map((choice) => {
    const taken = Object.keys(LICENCES).find((id) => choice.includes(id) && all.some(({ text }) => LICENCES[id].test(text)));
    if (!taken) throw new Error(`${name} ${version} has no text of ${choice} in ${files.join(', ') || 'any file'}`);
    return all.filter(({ text }) => LICENCES[taken].test(text)).toSorted((a, b) => a.text.length - b.text.length)[0].text;
  });
  const own = all.filter(({ file }) => /^notice/i.test(file)).map(({ text }) => text);
  return { name, version, licence: licence.replaceAll('/', ' OR '), source, texts: [...texts, ...own] };
}
