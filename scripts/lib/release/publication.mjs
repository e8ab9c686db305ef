// What a release publishes, and which addresses exist only after it.

import { createHash } from 'node:crypto';
import { readFileSync } from 'node:fs';
import { basename } from 'node:path';

import { linksInTexts } from '../identity.mjs';

/** A line for each file: where it goes, its size and its hash. */
export function publicationLines(files) {
  return files.map(({ path, place }) => {
    const content = readFileSync(path);
    const hash = createHash('sha256').update(content).digest('hex');
    return `${place}: ${basename(path)}, ${(content.length / 1024).toFixed(0)} KiB, sha256 ${hash}`;
  });
}

/** Addresses in the documentation that a publication makes: of the repository, the site, and the pages of the packages. */
export function futureLinks({ repository, site, crate, npm, python }) {
  const pages = [`docs.rs/${crate}`, `/crates/${crate}`, `/package/${npm}`, `/project/${python}`];
  return linksInTexts().filter((link) => link.startsWith(repository) || link.startsWith(site) || pages.some((page) => link.includes(page)));
}
