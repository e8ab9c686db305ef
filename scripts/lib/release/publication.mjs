// What a release publishes.

import { createHash } from 'node:crypto';
import { readFileSync } from 'node:fs';
import { basename } from 'node:path';

/** A line for each file: where it goes, its size and its hash. */
export function publicationLines(files) {
  return files.map(({ path, place }) => {
    const content = readFileSync(path);
    const hash = createHash('sha256').update(content).digest('hex');
    return `${place}: ${basename(path)}, ${(content.length / 1024).toFixed(0)} KiB, sha256 ${hash}`;
  });
}
