// Joins the compiled sources into few files: each one is a request, and a browser that loads the package unbundled is ready only
// after the last; part of `npm run build`.

import { fileURLToPath } from 'node:url';
import { rolldown } from 'rolldown';

const folder = (name) => fileURLToPath(new URL(`../${name}/`, import.meta.url));
/** What package.json names, and the files that workers are started from. */
const ENTRIES = ['web', 'node', 'slim', 'inline', 'worker', 'worker-node', 'element', 'element-class', 'codecs', 'formats/index'];
const PROGRAM = ['cli', 'cli-work', 'cli-batch-work'];
/** What an encoder of masks shares with the calls. */
const SHARED = ['checks', 'errors', 'palette'];
/** What all entries with calls share. */
const CALLS = ['glue', 'glue-points', 'api', 'tasks', 'taking', 'messages', 'core', 'loading', 'labels', 'version', 'segmenter', 'pool', 'threads', 'ordered'];

const named = (names) => new RegExp(`[\\\\/]build[\\\\/](?:${names.join('|')})\\.js$`);
const bundle = await rolldown({
  input: Object.fromEntries([...ENTRIES, ...PROGRAM].map((name) => [name, `${folder('build')}${name}.js`])),
  external: [/^node:/, 'fflate'],
  plugins: [
    {
      name: 'entries',
      // An entry that another one imports stays the one file that package.json names. Importers lie in the top folder.
      resolveId: (id, importer) =>
        importer && ENTRIES.some((name) => id === `./${name}.js`) ? { id, external: 'relative' } : undefined,
    },
  ],
  platform: 'neutral',
});
await bundle.write({
  dir: folder('dist'),
  cleanDir: true,
  entryFileNames: '[name].js',
  chunkFileNames: '[name].js',
  comments: false,
  minify: false,
  minifyInternalExports: false,
  codeSplitting: {
    groups: [
      { name: 'shared', test: named(SHARED), priority: 1 },
      { name: 'calls', test: named(CALLS) },
    ],
  },
});
await bundle.close();
