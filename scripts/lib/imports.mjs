// Who may import whom: ARCHITECTURE.md has tables of the crate's modules and of the folders of the package and the page. This
// compares the sources with them, and rejects cycles between the files of the package and of the page.

import { readdirSync } from 'node:fs';
import { join, posix } from 'node:path';

import { projectText, root } from './project.mjs';
import { say } from './run.mjs';

const DOCUMENT = 'ARCHITECTURE.md';

/** Whether the sources import what the tables say, no more and no less. Prints what differs. */
export function importsAgree() {
  const document = projectText(DOCUMENT);
  const [packageFiles, pageFiles] = [importsOfFiles('pkg/src'), importsOfFiles('www/src')];
  const problems = [
    ...differences('src', tableOf(document, 'imports'), importsOfCrate('src')),
    ...differences('pkg/src', tableOf(document, 'imports-of-package'), importsOfFolders(packageFiles)),
    ...differences('www/src', tableOf(document, 'imports-of-page'), importsOfFolders(pageFiles)),
    ...cycles('pkg/src', packageFiles),
    ...cycles('www/src', pageFiles),
  ];
  for (const problem of problems) say(problem);
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
  const above = new Set();
  for (const [module, allowed] of table) {
    const found = imports.get(module);
    for (const name of allowed) if (!above.has(name)) problems.push(`${DOCUMENT} has no line for ${folder}/${name} above that for ${folder}/${module}, which imports it.`);
    above.add(module);
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
    if (!path.endsWith('.rs') || path === 'lib.rs' || path.endsWith('/tests.rs')) continue;
    const own = path.split('/')[0].replace(/\.rs$/, '');
    const source = withoutTests(projectText(`${folder}/${path}`));
    // Both `crate::name` and the names in `crate::{name, name::item}`.
    for (const [, path] of source.matchAll(/\bcrate::(\w+|\{[^;]*)/g)) {
      for (const [name] of path.matchAll(/(?<!::)\b\w+/g)) if (modules.has(name) && name !== own) imports.get(own).add(name);
    }
  }
  return imports;
}

/** For every TypeScript file below `folder` the files there that it imports, values or types. */
function importsOfFiles(folder) {
  const imports = new Map();
  for (const file of readdirSync(join(root, folder), { recursive: true })) {
    const path = String(file).replaceAll('\\', '/');
    if (!path.endsWith('.ts') || path.endsWith('.d.ts')) continue;
    const places = projectText(`${folder}/${path}`).matchAll(/(?:\bfrom |\bimport(?: |\())'(\.[^']+)'/g);
    const others = [...places].map(([, place]) => posix.join(posix.dirname(path), place).replace(/\.js$/, '.ts'));
    // What lies outside are the types that the package publishes.
    imports.set(path, new Set(others.filter((other) => !other.startsWith('..'))));
  }
  return imports;
}

/** The same for folders. A file that lies in none stands for itself. */
function importsOfFolders(files) {
  const folderOf = (path) => path.split('/')[0].replace(/\.ts$/, '');
  const imports = new Map();
  for (const [path, others] of files) {
    const own = folderOf(path);
    if (!imports.has(own)) imports.set(own, new Set());
    for (const other of others) if (folderOf(other) !== own) imports.get(own).add(folderOf(other));
  }
  return imports;
}

/** The first cycle that each file closes, a sentence each. */
function cycles(folder, files) {
  const problems = [];
  const done = new Set();
  const visit = (path, trail) => {
    if (trail.includes(path)) {
      const cycle = [...trail.slice(trail.indexOf(path)), path];
      problems.push(`Files of ${folder} import each other: ${cycle.join(' → ')}.`);
      return;
    }
    if (done.has(path)) return;
    for (const other of files.get(path) ?? []) visit(other, [...trail, path]);
    done.add(path);
  };
  for (const path of files.keys()) visit(path, []);
  return problems;
}

/** A source without its comments and its test module. */
function withoutTests(source) {
  const code = source.replace(/^\s*\/\/.*$/gm, '');
  const tests = /^#\[cfg\(test\)\]\n(pub\(crate\) )?mod \w+ \{$/m.exec(code);
  return tests ? code.slice(0, tests.index) : code;
}
