// Takes the JavaScript that wasm-bindgen wrote beside each module into dist, with two changes, and the core module as text;
// part of `npm run build`.

import { mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { deflateSync } from 'node:zlib';

const MODULES = [
  { from: '../wasm/veronese.js', to: '../dist/glue.js' },
  { from: '../wasm/codecs/veronese_codecs.js', to: '../dist/glue-codecs.js' },
];

mkdirSync(new URL('../dist/', import.meta.url), { recursive: true });
for (const { from, to } of MODULES) {
  writeFileSync(new URL(to, import.meta.url), adapted(readGlue(new URL(from, import.meta.url))));
}

// The module inside of JavaScript, for veronese/inline.
const module = readFileSync(new URL('../wasm/veronese_bg.wasm', import.meta.url));
const packed = deflateSync(module, { level: 9 }).toString('base64');
writeFileSync(new URL('../dist/inline-module.js', import.meta.url), `export const packed = '${packed}';\n`);

function adapted(glue) {
  // Where the module lies is said in one place (web.ts, node.ts). A second URL would make bundlers look for a second file.
  const place = /module_or_path = new URL\('[^']+', import\.meta\.url\);/g;
  if (glue.match(place)?.length !== 1 || !glue.includes('wasmInstance, wasm;')) {
    console.error('veronese: the glue of this wasm-bindgen looks different: read pkg/scripts/glue.mjs');
    process.exit(1);
  }
  const withoutPlace = glue.replace(place, "throw new Error('no module was given');");
  // The glue keeps its one instance for ever. After a panic an instance cannot be trusted: let the package ask for a new one.
  return `${withoutPlace}\nexport function forgetInstance() {\n    wasm = undefined;\n}\n`;
}

function readGlue(file) {
  try {
    return readFileSync(file, 'utf8');
  } catch {
    console.error(`veronese: ${file.pathname} is missing: build the WebAssembly modules first (npm run build at the top)`);
    process.exit(1);
  }
}
