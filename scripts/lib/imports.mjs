// Compares the imports of the crate's modules with the table in ARCHITECTURE.md.

import { readdirSync } from 'node:fs';
import { join } from 'node:path';

import { projectText, root } from './project.mjs';

const DOCUMENT = 'ARCHITECTURE.md';

/** Whether the modules in `src` import exactly what the table says. Prints the differences. */
export function importsAgree() {
  const table = tableOf(projectText(DOCUMENT));
  const problems = differences(table, importsOf('src'));
  for (const problem of problems) console.error(problem);
  return problems.length === 0;
}

/** The differences between the table and the sources, one sentence each. */
function differences(table, imports) {
  const problems = [];
  for (const [module, found] of imports) {
    const allowed = table.get(module);
    if (!allowed) problems.push(`${DOCUMENT} has no line for src/${module}.`);
    for (const name of found) if (allowed && !allowed.has(name)) problems.push(`src/${module} imports ${name}, which ${DOCUMENT} does not allow.`);
  }
  for (const [module, allowed] of table) {
    const found = imports.get(module);
    if (!found) problems.push(`${DOCUMENT} has a line for src/${module}, which does not exist.`);
    for (const name of allowed) if (found && !found.has(name)) problems.push(`${DOCUMENT} says that src/${module} imports ${name}; it does not.`);
  }
  return problems;
}

/** The lines `module → imports` of the block marked `imports`. */
function tableOf(document) {
  const block = /```imports\n([\s\S]*?)```/.exec(document)?.[1] ?? '';
  const table = new Map();
  for (const line of block.split('\n').filter(Boolean)) {
    const [modules, imported] = line.split('→').map((half) => half.trim().split(/\s+/).filter(Boolean));
    for (const module of modules) table.set(module, new Set(imported ?? []));
  }
  return table;
}

/** For every top-level module of the crate, the other top-level modules that its sources name, without tests. */
function importsOf(folder) {
  const names = readdirSync(join(root, folder)).map((name) => name.replace(/\.rs$/, ''));
  const modules = new Set(names.filter((name) => name !== 'lib'));
  const imports = new Map([...modules].map((name) => [name, new Set()]));
  for (const file of readdirSync(join(root, folder), { recursive: true })) {
    const path = String(file).replaceAll('\\', '/');
    if (!path.endsWith('.rs') || path === 'lib.rs' || path.endsWith('_tests.rs')) continue;
    const own = path.split('/')[0].replace(/\.rs$/, '');
    const source = withoutTests(projectText(`${folder}/${path}`));
    // Both `crate::name` and the names in `crate::{name, name::item}`.
    for (const [, path] of source.matchAll(/\bcrate::(\w+|\{[^;]*)/g)) {
      for (const [name] of path.matchAll(/(?<!::)\b\w+/g)) if (modules.has(name) && name !== own) imports.get(own).add(name);
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
