// The pages of docs with measured figures: their marked parts are written from docs/figures. Each module here has a page's parts by name: the
// figures file that a part is made of, and the function that makes it.

import { renameSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';

import { figuresOf } from '../figures.mjs';
import { projectText, root } from '../project.mjs';
import { Stop, say } from '../run.mjs';
import { PARTS as annotating } from './annotating.mjs';
import { PARTS as clips } from './clips.mjs';
import { PARTS as experiments } from './experiments.mjs';
import { PARTS as masks } from './masks.mjs';
import { PARTS as performance } from './performance.mjs';
import { PARTS as scaling } from './scaling.mjs';

const PAGES = {
  'docs/annotating.md': annotating,
  'docs/clips.md': clips,
  'docs/experiments.md': experiments,
  'docs/masks.md': masks,
  'docs/performance.md': performance,
  'docs/scaling.md': scaling,
};

/** The tables that are made of some figures, for the terminal. */
export function tablesOf(name, figures) {
  const parts = Object.values(PAGES).flatMap((page) => Object.entries(page));
  const own = parts.filter(([, [file]]) => file === name);
  return own
    .map(([, [, text]]) => text(figures))
    .filter((text) => text !== '')
    .join('\n\n');
}

/** Writes all pages and says which of them changed. */
export function writePages() {
  for (const [path, text] of stale()) {
    writeFileSync(join(root, `${path}.new`), text);
    renameSync(join(root, `${path}.new`), join(root, path));
    console.log(`Written to ${path}.`);
  }
}

/** Whether every page is what the figures give. */
export function pagesAgree() {
  const found = stale();
  for (const [path] of found) say(`${path} is not what docs/figures gives: npm run figures writes it.`);
  return found.length === 0;
}

/** The pages that would change, with their new text. */
function stale() {
  const written = Object.entries(PAGES).map(([path, parts]) => {
    const texts = Object.entries(parts).map(([name, [file, text]]) => [name, text(figuresOf(file))]);
    return [path, marked(projectText(path), path, Object.fromEntries(texts))];
  });
  return written.filter(([path, text]) => text !== projectText(path));
}

/** The text of a page with other text between `<!-- begin NAME … -->` and `<!-- end NAME -->`, for the parts of these names. */
function marked(page, path, parts) {
  let text = page;
  for (const [name, part] of Object.entries(parts)) {
    const place = new RegExp(`(<!-- begin ${name}\\b[^>]*-->\n)(?:[^]*?\n)??(<!-- end ${name} -->)`);
    if (!place.test(text)) throw new Stop(`${path} has no part '${name}' between markers.`);
    text = text.replace(place, (_, begin, end) => `${begin}\n${part.trim()}\n\n${end}`);
  }
  return text;
}
