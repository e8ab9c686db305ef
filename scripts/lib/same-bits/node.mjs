// Answers the cases of a folder in Node and prints their hashes: node node.mjs DIR [MODULE.wasm]. Without a module, with the package's own.

import { readFile } from 'node:fs/promises';
import { join } from 'node:path';

import { bitsOf } from './bits.mjs';

const [folder, module] = process.argv.slice(2);
const cases = JSON.parse(await readFile(join(folder, 'cases.json'), 'utf8'));
const entry = await import(`../../../pkg/dist/${module === undefined ? 'node' : 'slim'}.js`);
if (module !== undefined) await entry.init(await readFile(module));
const found = {};
for (const asked of cases) found[asked.name] = await bitsOf(entry, asked, async (file) => new Uint8Array(await readFile(join(folder, file))));
process.stdout.write(JSON.stringify(found));
