// Joins the compiled sources into few files: each one is a request, and a browser that loads the package unbundled is ready only
// after the last; part of `npm run build`.

import { copyFileSync, writeFileSync } from 'node:fs';
import { dirname, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';
import { rolldown } from 'rolldown';

const folder = (name) => fileURLToPath(new URL(`../${name}/`, import.meta.url));
const sources = (names) =>
  Object.fromEntries(Object.entries(names).map(([name, source]) => [name, resolve(folder('build'), `${source}.js`)]));
/** The entries of package.json, and the files that workers are started from: each with its source. */
const ENTRIES = sources({
  web: 'entries/web',
  node: 'entries/node',
  slim: 'entries/slim',
  inline: 'entries/inline',
  codecs: 'entries/codecs',
  colours: 'entries/colours',
  'worker-node': 'worker/worker-node',
  element: 'element/element',
  'element-class': 'element/element-class',
  'element-inline': 'element/inline',
  react: 'element/react',
  'formats/index': 'formats/index',
});
const PROGRAM = sources({ cli: 'cli/main', 'cli-work': 'cli/work' });
/**
 * Become part of the package: a browser that loads it unbundled finds no package by its name. parse-xml is taken from its sources, because
 * what it publishes are no modules; of fflate what browsers get, which Node runs too.
 */
const BUNDLED = { '@rgrove/parse-xml': '@rgrove/parse-xml/src/index.ts', fflate: 'fflate/esm/browser.js' };
/** Shared by the encoders of masks and the calls. */
const SHARED = ['common/'];
/** Shared by encoders and readers of masks. */
const BOTH_WAYS = ['formats/file-names.js'];
/** One mask in another form: also for the calls, which do not need the readers of files of annotation tools. */
const ONE_MASK = ['formats/png-reader.js', 'formats/reading/(?:mask|smoothed|coco-rle).js'];
/** Shared by all entries with calls, but for what they load with the first clip or picture. */
const CALLS = [
  'module/',
  'calls/(?!(?:clip/notes|session/(?!open|frames|frame-cache)[\\w-]+|nothing|pictures)\\.js)',
  'pool/',
  'entries/package.js',
];

const within = (places) => new RegExp(`/build/(?:${places.join('|')})`.replaceAll('/', '[\\\\/]'));
const worker = await rolldown({ input: resolve(folder('build'), 'worker/worker.js'), platform: 'browser' });
const { output } = await worker.generate({ format: 'iife', minify: true, comments: false, codeSplitting: false });
// One file: bundlers that copy the files that code points to copy it alone.
const [{ code }] = output;
const once = `${code}\nURL.revokeObjectURL(location);`;
writeFileSync(resolve(folder('build'), 'element/inline-worker.js'), `export const code = ${JSON.stringify(once)};\n`);

const bundle = await rolldown({
  input: { ...ENTRIES, ...PROGRAM },
  external: [/^node:/, 'react'],
  plugins: [
    {
      name: 'entries',
      // An entry that another one imports stays the one file that package.json names. Importers end up in the top folder.
      resolveId: (id, importer) => {
        const file = importer && resolve(dirname(importer), id);
        if (Object.hasOwn(BUNDLED, id)) return resolve(folder('../node_modules'), BUNDLED[id]);
        const entry = Object.keys(ENTRIES).find((name) => ENTRIES[name] === file);
        return entry && { id: `./${entry}.js`, external: 'relative' };
      },
    },
  ],
  platform: 'neutral',
  resolve: { extensionAlias: { '.js': ['.js', '.ts'] } },
  // No comments that name compiled sources, which are not in the package.
  experimental: { attachDebugInfo: 'none' },
  // A warning stops the build, as does a circle of imports.
  checks: { circularDependency: true },
  onLog: (level, log, standard) => {
    // The first line of an entry stays its first line: `'use client'` is for React.
    if (log.code !== 'MODULE_LEVEL_DIRECTIVE') standard(level === 'warn' ? 'error' : level, log);
  },
});
await bundle.write({
  dir: folder('dist'),
  cleanDir: true,
  entryFileNames: '[name].js',
  chunkFileNames: ({ moduleIds }) => {
    const folder = ['cli', 'element'].find((name) => moduleIds.some((id) => within([`${name}/`]).test(id)));
    return folder ? `${folder}-[name].js` : '[name].js';
  },
  comments: false,
  minify: false,
  minifyInternalExports: false,
  codeSplitting: {
    groups: [
      { name: 'shared', test: within(SHARED), priority: 1 },
      { name: 'calls', test: within(CALLS) },
      // A page that writes masks need not load what reads them: it has a file of its own, and so has what the two share.
      { name: 'png-writer', test: within(['formats/png-writer.js']), priority: 1 },
      { name: 'mask', test: within(ONE_MASK), priority: 1 },
      { name: 'file-names', test: within(BOTH_WAYS), priority: 1 },
      { name: 'annotations', test: within(['formats/reading/']) },
      { name: 'encoders', test: within(['formats/(?!index)']) },
      // Whatever loads it loads it once, and whoever bundles the package can put another copy in its place.
      { name: 'fflate', test: /[\\/]node_modules[\\/]fflate[\\/]/, priority: 2 },
    ],
  },
});
await bundle.close();
writeFileSync(resolve(folder('dist'), 'worker.js'), code);

// The package has the project's licences.
for (const name of ['LICENSE-APACHE', 'LICENSE-MIT', 'THIRD-PARTY-NOTICES'])
  copyFileSync(`${folder('..')}${name}`, `${folder('.')}${name}`);
