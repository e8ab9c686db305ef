// Takes the JavaScript that wasm-bindgen wrote beside each module to the compiled sources, with the calls that are used and what makes and
// forgets an instance added to it, and the modules as text; part of `npm run build`.

import { mkdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { deflateSync } from 'node:zlib';

const CLIP_CALLS = [
  'openClip',
  'applyClip',
  'moveClip',
  'takeClip',
  'lookAtClip',
  'annotationsOfClip',
  'saveClip',
  'closeClip',
  'solvePair',
  'beginStream',
  'pushStream',
  'finishStream',
];
const FRAME_CALLS = ['segmentPair', ...CLIP_CALLS];
const POINT_CALLS = ['fitMotions'];
const FILE_CALLS = ['decodeImage', 'encodeIndexedPng', 'encodeGreyPng', 'encodeColourPng'];
const MODULES = [
  { from: '../wasm/veronese.js', to: '../build/module/glue.js', calls: FRAME_CALLS },
  { from: '../wasm/points/veronese_points.js', to: '../build/module/glue-points.js', calls: POINT_CALLS },
  {
    from: '../wasm/codecs/veronese_codecs.js',
    to: '../build/entries/glue-codecs.js',
    calls: [...FRAME_CALLS, ...POINT_CALLS, ...FILE_CALLS],
  },
];

// Nothing may find files that are no longer compiled.
rmSync(new URL('../build/', import.meta.url), { recursive: true, force: true });
for (const folder of ['module', 'entries']) mkdirSync(new URL(`../build/${folder}/`, import.meta.url), { recursive: true });
for (const { from, to, calls } of MODULES) {
  writeFileSync(new URL(to, import.meta.url), adapted(readGlue(new URL(from, import.meta.url)), calls));
}

// The modules inside of JavaScript, for veronese/inline.
const packed = (file) => deflateSync(readFileSync(new URL(file, import.meta.url)), { level: 9 }).toString('base64');
const inside = { frames: packed('../wasm/veronese_bg.wasm'), points: packed('../wasm/points/veronese_points_bg.wasm') };
const lines = Object.entries(inside).map(([name, text]) => `export const ${name} = '${text}';\n`);
writeFileSync(new URL('../build/entries/inline-module.js', import.meta.url), lines.join(''));

/** What wasm-bindgen wrote, and after it one object of the calls. The bundle has nothing of what this object does not use, such as its loader. */
function adapted(glue, calls) {
  const used = [
    'function __wbg_finalize_init(instance, module)',
    'function __wbg_get_imports()',
    'wasmInstance, wasm;',
    ...calls.map((name) => `export function ${name}(`),
  ];
  const missing = used.filter((part) => !glue.includes(part));
  if (missing.length > 0) {
    console.error(`veronese: the glue of this wasm-bindgen looks different (${missing}): read pkg/scripts/glue.mjs`);
    process.exit(1);
  }
  return `${glue}
async function instantiate(module) {
    // The package's modules are made of one source: each could be taken for another.
    if (!WebAssembly.Module.exports(module).some(({ name }) => name === '${calls[0]}')) throw new Error('it has no ${calls[0]}');
    if (wasm === undefined) __wbg_finalize_init(await WebAssembly.instantiate(module, __wbg_get_imports()), module);
    return wasm;
}

// The glue keeps its one instance for ever. After a panic an instance cannot be trusted: the package asks for a new one.
function forgetInstance() {
    wasm = undefined;
}

export const glue = { instantiate, forgetInstance, ${calls.join(', ')} };
`;
}

function readGlue(file) {
  try {
    return readFileSync(file, 'utf8');
  } catch {
    console.error(`veronese: ${file.pathname} is missing: build the WebAssembly modules first (npm run build at the top)`);
    process.exit(1);
  }
}
