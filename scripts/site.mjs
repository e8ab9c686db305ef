// npm run site: makes the whole site in out/site: pages, the app, references and the search. Links are relative, so that it works in any
// folder of any server. Options:
//   --serve [--port N]   serves it as well (4180)
//   --pages              only what stands in site/: the app and the references stay as they are

import { cpSync, existsSync, mkdirSync, readFileSync, readdirSync, rmSync, writeFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { join } from 'node:path';
import { parseArgs } from 'node:util';

import { buildModules, buildPackage, buildPage, buildStagesModule } from './lib/builds.mjs';
import { SITE, prepareNpmPackages } from './lib/npm-packages.mjs';
import { prepare } from './lib/prepare.mjs';
import { root } from './lib/project.mjs';
import { referenceOfCrate, referenceOfPackage } from './lib/references.mjs';
import { Stop, command, must, say } from './lib/run.mjs';
import { serve } from './lib/static-server.mjs';

const OUT = join(root, 'out', 'site');
const HOST = '127.0.0.1';
/** What the pages take of the samples. */
const SAMPLE = 'www/public/samples/passing-cars';
const PAIRS = ['intel-two-cars', 'parallax'];

await command(async (args) => {
  const { serves, port, onlyPages } = options(args);
  await prepare();
  await prepareNpmPackages(SITE);
  await buildModules();
  await buildPackage();
  await buildPage();
  await buildStagesModule();
  const beside = ['app', 'reference'];
  if (existsSync(OUT)) for (const name of readdirSync(OUT)) if (!onlyPages || !beside.includes(name)) rmSync(join(OUT, name), { recursive: true });
  mkdirSync(OUT, { recursive: true });
  if (!onlyPages) {
    cpSync(join(root, 'www/dist'), join(OUT, 'app'), { recursive: true });
    await referenceOfPackage(join(OUT, 'reference', 'package'));
    await referenceOfCrate(join(OUT, 'reference', 'crate'));
  }
  const site = join(root, SITE);
  await must('The pages could not be made.', 'npx', ['--no-install', 'eleventy', '--quiet'], { cwd: site });
  await bundleScripts(site);
  copyParts();
  await must('The search could not be made.', 'npx', ['--no-install', 'pagefind', '--silent', '--site', OUT, '--output-subdir', 'pagefind'], { cwd: site });
  say('out/site/index.html');
  if (!serves) return;
  await serve(OUT, { host: HOST, port, headers: {} });
  console.log(`http://${HOST}:${port}/`);
  await new Promise(() => {});
});

/** The scripts of the pages, each figure in a file of its own. */
async function bundleScripts(site) {
  const { build } = createRequire(join(site, 'package.json'))('esbuild');
  const figures = readdirSync(join(site, 'client/figures')).filter((name) => name.endsWith('.mjs') && name !== 'kit.mjs');
  const entries = ['site', 'start', 'method', 'worker', ...figures.map((name) => `figures/${name.replace('.mjs', '')}`)];
  await build({
    entryPoints: entries.map((name) => join(site, 'client', `${name}.mjs`)),
    outbase: join(site, 'client'),
    outdir: join(OUT, 'client'),
    bundle: true,
    splitting: true,
    format: 'esm',
    minify: true,
    target: 'es2022',
    chunkNames: '[name]-[hash]',
    external: ['../package/*', '../../package/*'],
  });
}

/** The module, the package, samples and pictures. */
function copyParts() {
  const copy = (from, to) => cpSync(join(root, from), join(OUT, to), { recursive: true });
  copy('site/module', 'module');
  for (const name of readdirSync(join(root, 'pkg/dist')).filter((name) => name.endsWith('.js'))) copy(`pkg/dist/${name}`, `package/dist/${name}`);
  copy('pkg/wasm/veronese_bg.wasm', 'package/wasm/veronese_bg.wasm');
  copy(SAMPLE, 'samples/passing-cars');
  for (const pair of PAIRS) copy(`www/public/samples/${pair}`, `samples/${pair}`);
  copy('www/public/icon.svg', 'images/icon.svg');
  copy('www/src/styles/wordmark/cormorant-garamond.woff2', 'images/wordmark.woff2');
  writeFileSync(join(OUT, '.nojekyll'), '');
}

function options(args) {
  try {
    const { values } = parseArgs({ args, options: { serve: { type: 'boolean', default: false }, port: { type: 'string', default: '4180' }, pages: { type: 'boolean', default: false } } });
    const port = Number(values.port);
    if (!Number.isInteger(port) || port < 1 || port > 65535) throw new Stop(`--port must be a whole number from 1 to 65535, not ${values.port}.`);
    return { serves: values.serve, port, onlyPages: values.pages };
  } catch (thrown) {
    throw thrown instanceof Stop ? thrown : new Stop(thrown.message);
  }
}
