// Writes the parts of a page that a command generates, between markers that name the command.

import { readFileSync, renameSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';

import { root } from './project.mjs';
import { Stop } from './run.mjs';

/** Replaces the text between `<!-- begin NAME … -->` and `<!-- end NAME -->`, for each name of `parts`. */
export function writeMarked(path, parts) {
  let page = readFileSync(join(root, path), 'utf8');
  for (const [name, text] of Object.entries(parts)) {
    const marked = new RegExp(`(<!-- begin ${name}\\b[^>]*-->\n)(?:[^]*?\n)??(<!-- end ${name} -->)`);
    if (!marked.test(page)) throw new Stop(`${path} has no part '${name}' between markers.`);
    page = page.replace(marked, (_, begin, end) => `${begin}\n${text.trim()}\n\n${end}`);
  }
  writeFileSync(join(root, `${path}.new`), page);
  renameSync(join(root, `${path}.new`), join(root, path));
  console.log(`Written to ${path}: ${Object.keys(parts).join(', ')}.`);
}
