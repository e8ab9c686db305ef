// Makes the site: its pages, the app, the references and the search. scripts/site.mjs and the release call it.

import { cpSync, existsSync, mkdirSync, readdirSync, rmSync, writeFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { join } from 'node:path';

import { buildPage, buildStagesModule } from './builds.mjs';
import { HOSTS, SITE, prepareNpmPackages } from './npm-packages.mjs';
import { prepare } from './prepare.mjs';
import { root } from './project.mjs';
import { referenceOfCrate, referenceOfPackage } from './references.mjs';
import { must } from './run.mjs';

export const OUT = join(root, 'out', 'site');
/** The samples of the start page and of the explainer. */
const SAMPLES = ['passing-cars', 'intel-two-cars', 'parallax'];
/** Made by others' programs. */
const BESIDE = ['app', 'reference/package', 'reference/crate'];

let built;

/** The whole site, once for all who ask for it. */
export function buildSite() {
  return (built ??= makeSite());
}

/** With `onlyPages`, the app and the references stay as they are. */
export async function makeSite({ onlyPages = false } = {}) {
  await prepare();
  await prepareNpmPackages(SITE);
  await prepareNpmPackages(HOSTS);
  await buildPage();
  await buildStagesModule();
  mkdirSync(OUT, { recursive: true });
  const kept = onlyPages ? ['app', 'reference'] : [];
  for (const name of readdirSync(OUT)) if (!kept.includes(name)) rmSync(join(OUT, name), { recursive: true });
  const missing = BESIDE.filter((place) => !existsSync(join(OUT, place)));
  if (missing.includes('app')) cpSync(join(root, 'www/dist'), join(OUT, 'app'), { recursive: true });
  if (missing.includes('reference/package')) await referenceOfPackage(join(OUT, 'reference/package'));
  if (missing.includes('reference/crate')) await referenceOfCrate(join(OUT, 'reference/crate'));
  const site = join(root, SITE);
  await must('The pages could not be made.', 'npx', ['--no-install', 'eleventy', '--quiet'], { cwd: site });
  const esbuild = createRequire(join(site, 'package.json'))('esbuild');
  await bundleScripts(site, esbuild);
  await minifyPackage(esbuild);
  copyParts();
  const search = ['--no-install', 'pagefind', '--silent', '--site', OUT, '--output-subdir', 'pagefind'];
  await must('The search could not be made.', 'npx', search, { cwd: site });
}

/** Licences and notices that the page of licences lacks: those of the project, of its archives and of what the site adds. */
export async function missingNotices(html) {
  const { default: notices } = await import('../../site/data/notices.mjs');
  const text = html
    .replaceAll('&quot;', '"')
    .replaceAll('&#39;', "'")
    .replaceAll('&lt;', '<')
    .replaceAll('&gt;', '>')
    .replaceAll('&amp;', '&');
  return [...notices.project, ...notices.site].filter((one) => !text.includes(one.text.trim())).map(({ name }) => name);
}

/** The scripts of the pages, each figure in a file of its own. */
async function bundleScripts(site, { build }) {
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
    external: ['../package/*', '../../package/*', 'node:*'],
  });
}

/** The package's scripts as they are, but without comments and spaces. */
async function minifyPackage({ build }) {
  const folder = join(root, 'pkg/dist');
  const entryPoints = readdirSync(folder).filter(
    (name) => name.endsWith('.js') && !/^(cli|inline|element-inline|node|worker-node)/.test(name),
  );
  await build({
    entryPoints: entryPoints.map((name) => join(folder, name)),
    outdir: join(OUT, 'package/dist'),
    minify: true,
    format: 'esm',
    target: 'es2022',
  });
}

/** The module, the package, samples and pictures. */
function copyParts() {
  const copy = (from, to) => cpSync(join(root, from), join(OUT, to), { recursive: true });
  copy('site/module', 'module');
  copy('pkg/wasm/veronese_bg.wasm', 'package/wasm/veronese_bg.wasm');
  for (const name of SAMPLES) copy(`www/public/samples/${name}`, `samples/${name}`);
  copy('docs/images/two-cars.png', 'images/two-cars.png');
  copy('www/public/icon.svg', 'images/icon.svg');
  writeFileSync(join(OUT, '.nojekyll'), '');
}
