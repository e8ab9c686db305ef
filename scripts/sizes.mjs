// npm run sizes: measures the package's download sizes. --write-docs writes them to docs/figures, and docs/sizes.md from them.

import { readFileSync, statSync } from 'node:fs';
import { dirname, join, relative } from 'node:path';
import { brotliCompressSync, gzipSync } from 'node:zlib';

import { buildPackage } from './lib/builds.mjs';
import { present } from './lib/documented.mjs';
import { prepare } from './lib/prepare.mjs';
import { root } from './lib/project.mjs';
import { command, must } from './lib/run.mjs';

const PKG = join(root, 'pkg');
const ROWS = [
  ['core module, for browser and Node', ['wasm/veronese_bg.wasm']],
  ['measurements module, loaded by `fitMotions`', ['wasm/points/veronese_points_bg.wasm']],
  ['JavaScript of `veronese` in a browser', ['dist/web.js']],
  ['JavaScript of `veronese/worker`', ['dist/worker.js']],
  ['JavaScript of `veronese/slim`', ['dist/slim.js']],
  ['`veronese/inline`, with both modules embedded', ['dist/inline.js']],
  ['`veronese/formats`', ['dist/formats/index.js']],
  ['`veronese/element`', ['dist/element.js']],
  ['`veronese/element` with a clip or in a form', ['dist/element.js', 'dist/element-later.js']],
  ['module with image codecs, for Node only', ['wasm/codecs/veronese_codecs_bg.wasm']],
];

await command(async (args) => {
  await prepare();
  await buildPackage();
  const entries = ROWS.filter(([, files]) => files.every(exists)).map(([entry, files]) => {
    const bytes = [...new Set(files.flatMap((file) => withImports(file)))].map((file) => readFileSync(join(PKG, file)));
    const sum = (measure) => bytes.reduce((total, content) => total + measure(content), 0);
    const [raw, gzip, brotli] = [({ length }) => length, (content) => gzipSync(content, { level: 9 }).length, (content) => brotliCompressSync(content).length].map(sum);
    return { entry, files: bytes.length, raw, gzip, brotli };
  });
  const { stdout } = await must('The package could not be packed.', 'npm', ['pack', '--dry-run', '--json', '--ignore-scripts'], {
    cwd: PKG,
    output: 'collect',
  });
  const [{ size, unpackedSize, entryCount }] = JSON.parse(stdout);
  entries.push({ entry: '`npm install veronese`', files: entryCount, raw: unpackedSize, gzip: size });
  present('sizes', { command: 'npm run sizes', node: process.versions.node }, { entries }, args.includes('--write-docs'));
});

function exists(file) {
  return statSync(join(PKG, file), { throwIfNoEntry: false })?.isFile() === true;
}

/** A file and everything it imports, as paths in the package's folder. */
function withImports(file, seen = new Set()) {
  if (seen.has(file)) return [...seen];
  seen.add(file);
  if (!file.endsWith('.js')) return [...seen];
  const text = readFileSync(join(PKG, file), 'utf8');
  for (const [, place] of text.matchAll(/(?:from |import )"(\.[^"]+)"/g)) {
    withImports(relative(PKG, join(PKG, dirname(file), place)), seen);
  }
  return [...seen];
}
