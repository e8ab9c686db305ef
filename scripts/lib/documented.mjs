// The end of a benchmark: its tables in the terminal and, with --write-docs, its figures, its pictures and the pages made of them.

import { copyFileSync } from 'node:fs';
import { join } from 'node:path';

import { withOrigin, writeFigures } from './figures.mjs';
import { tablesOf, writePages } from './pages/index.mjs';
import { root } from './project.mjs';
import { Stop } from './run.mjs';

const IMAGES = join(root, 'docs/images');

/** The arguments without --write-docs, and whether it was there; options that leave something out exclude it. */
export function withoutDocs(args, partial) {
  const writeDocs = args.includes('--write-docs');
  const found = partial.find((option) => args.includes(option));
  if (writeDocs && found) throw new Stop(`The documentation has everything: ${found} and --write-docs exclude each other.`);
  return { writeDocs, rest: args.filter((name) => name !== '--write-docs') };
}

/** Prints the tables of what was measured, and writes it with the pages if that was asked for. */
export function present(name, origin, measured, writeDocs) {
  const figures = withOrigin(origin, measured);
  console.log(`\n${tablesOf(name, figures)}`);
  if (!writeDocs) return;
  writeFigures(name, figures);
  writePages();
}

/** Copies pictures from a folder to those of the documentation. */
export function showPictures(folder, names) {
  for (const name of names) copyFileSync(join(folder, name), join(IMAGES, name));
}
