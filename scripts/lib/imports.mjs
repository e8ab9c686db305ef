// Who may import whom: ARCHITECTURE.md holds the tables of the crate's modules and of the package's folders, and this compares the
// sources with them.

import { readdirSync } from 'node:fs';
import { join, posix } from 'node:path';

import { projectText, root } from './project.mjs';

const DOCUMENT = 'ARCHITECTURE.md';

/** Whether the sources import what the tables say, no more and no less. Prints what differs. */
export function importsAgree() {
  const document = projectText(DOCUMENT);
  const problems = [
    ...differences('src', tableOf(document, 'imports'), importsOfCrate('src')),
    ...differences('pkg/src', tableOf(document, 'imports-of-package'), importsOfPackage('pkg/src')),
  ];
  for (const problem of problems) console.error(problem);
  return problems.length === 0;
}

/** What differs between a table and the sources in `folder`, a sentence each. */
function differences(folder, table, imports) {
  const problems = [];
  for (const [module, found] of imports) {
    const allowed = table.get(module);
    if (!allowed) problems.push(`${DOCUMENT} has no line for ${folder}/${module}.`);
    for (const name of found) if (allowed && !allowed.has(name)) problems.push(`${folder}/${module} imports ${name}, which ${DOCUMENT} does not allow.`);
  }
  for (const [module, allowed] of table) {
    const found = imports.get(module);
    if (!found) problems.push(`${DOCUMENT} has a line for ${folder}/${module}, which does not exist.`);
    for (const name of allowed) if (found && !found.has(name)) problems.push(`${DOCUMENT} says that ${folder}/${module} imports ${name}; it does not.`);
  }
  return problems;
}

/** The lines `module → imports` of the block with this mark. */
function tableOf(document, mark) {
  const block = new RegExp(`\`\`\`${mark}\\n([\\s\\S]*?)\`\`\``).exec(document)?.[1] ?? '';
  const table = new Map();
  for (const line of block.split('\n').filter(Boolean)) {
    const [modules, imported] = line.split('→').map((half) => half.trim().split(/\s+/).filter(Boolean));
    for (const module of modules) table.set(module, new Set(imported ?? []));
  }
  return table;
}

/** For every top module of the crate the other top modules that its sources name, tests left out. */
function importsOfCrate(folder) {
  const names = readdirSync(join(root, folder)).map((name) => name.replace(/\.rs$/, ''));
  const modules = new Set(names.filter((name) => name !== 'lib'));
  const imports = new Map([...modules].map((name) => [name, new Set()]));
  for (const file of readdirSync(join(root, folder), { recursive: true })) {
    const path = String(file).replaceAll('\\', '/');
    if (!path.endsWith('.rs') || path === 'lib.rs' || path.includes('/tests/')) continue;
    const own = path.split('/')[0].replace(/\.rs$/, '');
    const source = withoutTests(projectText(`${folder}/${path}`));
    // Both `crate::name` and the names in `crate::{name, name::item}`.
    for (const [, path] of source.matchAll(/\bcrate::(\w+|\{[^;]*)/g)) {
      for (const [name] of path.matchAll(/(?<!::)\b\w+/g)) if (modules.has(name) && name !== own) imports.get(own).add(name);
    }
  }
  return imports;
}

/** For every folder of the package's sources the other folders that its files import, values or types. */
function importsOfPackage(folder) {
  const imports = new Map();
  for (const file of readdirSync(join(root, folder), { recursive: true })) {
    const path = String(file).replaceAll('\\', '/');
    if (!path.endsWith('.ts')) continue;
    const own = path.split('/')[0];
    if (!imports.has(own)) imports.set(own, new Set());
    for (const [, place] of projectText(`${folder}/${path}`).matchAll(/(?:\bfrom |\bimport\()'(\.[^']+)'/g)) {
      const [other] = posix.join(posix.dirname(path), place).split('/');
      // What lies outside are the types that the package publishes.
      if (other !== own && other !== '..') imports.get(own).add(other);
    }
  }
  return imports;
}

/** A source without its comments and its test module. */
function withoutTests(source) {
  const code = source.replace(/^\s*\/\/.*$/gm, '');
  const tests = /^#\[cfg\(test\)\]\n(pub\(crate\) )?mod \w+ \{$/m.exec(code);
  return tests ? code.slice(0, tests.index) : code;
}
