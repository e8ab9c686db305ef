// npm run release: everything that a release does before it publishes. Publishing is left to .github/workflows/release.yml, which runs this
// for a tag and then hands the files in out/release to the registries: nobody needs a token.

import { readFileSync, rmSync } from 'node:fs';
import { join } from 'node:path';
import { parseArgs } from 'node:util';

import { buildModules, buildPackage } from './lib/builds.mjs';
import { prepareNpmPackages } from './lib/npm-packages.mjs';
import { prepare } from './lib/prepare.mjs';
import { projectText, root } from './lib/project.mjs';
import { filesIn, packCrate, packNpm } from './lib/release/archives.mjs';
import { changelogState } from './lib/release/changelog.mjs';
import { LICENCES, WITH_NOTICES, licenceProblems, missingInArchive } from './lib/release/licences.mjs';
import { buildTwice, builds, hashesOf, moduleProblems } from './lib/release/modules.mjs';
import { checkNpmArchive } from './lib/release/package-checks.mjs';
import { publicationLines } from './lib/release/publication.mjs';
import { writeSboms } from './lib/release/sbom.mjs';
import { makeWheel } from './lib/release/wheel.mjs';
import { Stop, command, run } from './lib/run.mjs';
import { OUT as SITE, buildSite, missingNotices } from './lib/site.mjs';
import { versionProblem, versions } from './lib/versions.mjs';

const OUT = join(root, 'out', 'release');
const USAGE = `npm run release -- --dry-run | --tag vX.Y.Z [--only STEP,…]

  --dry-run   rehearses a release of what is here; may be combined with --tag
  --tag       prepares the release of this tag: nothing may be uncommitted, and the changelog must be dated
  --only      only these steps: `;

/** In this order. A step returns what it has found, a line each, and throws `Stop` with what is wrong. */
const STEPS = {
  versions: { title: 'one version everywhere', run: checkVersions, quick: true },
  changelog: { title: 'the changelog is of this version, and dated', run: checkChangelog, quick: true },
  tree: { title: 'everything is committed', run: checkTree, quick: true },
  licences: { title: 'licences and notices', run: checkLicences, quick: true },
  build: { title: 'the modules, built twice', run: buildModulesTwice },
  modules: { title: 'the modules have the same bytes', run: compareModules },
  archives: { title: 'the archives of npm and Cargo', run: packArchives },
  types: { title: 'publint and Are The Types Wrong?', run: checkPackage },
  wheel: { title: 'the Python wheel', run: addWheel },
  site: { title: 'the site, and its notices', run: addSite },
  sbom: { title: 'lists of what is shipped (CycloneDX)', run: listComponents },
};

await command(async (args) => {
  const options = parse(args);
  if (typeof options === 'number') return options;
  await prepareNpmPackages();
  const release = { ...options, files: [] };
  release.found = await versions();
  release.version = release.found['Cargo.toml'];
  const whole = release.only.length === Object.keys(STEPS).length;
  if (whole) rmSync(OUT, { recursive: true, force: true });
  const failed = await runSteps(release);
  if (failed.length > 0) {
    console.error(`\nNot ready: ${failed.join(', ')}.`);
    return 1;
  }
  if (whole) conclude(release);
  return 0;
});

/** The options, or an exit code if the command ends at once. */
function parse(args) {
  const names = Object.keys(STEPS);
  const wrong = (sentence) => {
    console.error(`${sentence}\n\n${USAGE}${names.join(', ')}`);
    return 2;
  };
  let values;
  try {
    ({ values } = parseArgs({ args, options: { 'dry-run': { type: 'boolean' }, tag: { type: 'string' }, only: { type: 'string' } } }));
  } catch (error) {
    return wrong(error.message);
  }
  const only = values.only?.split(',') ?? names;
  const unknown = only.find((name) => !names.includes(name));
  if (unknown !== undefined) return wrong(`There is no step '${unknown}'.`);
  if (!values['dry-run'] && !values.tag) return wrong('Nothing is published from here: push a tag, and the workflow release.yml publishes.');
  if (values.tag && !/^v\d+\.\d+\.\d+$/.test(values.tag)) return wrong(`A tag is called like v0.1.0, not '${values.tag}'.`);
  return { tag: values.tag, only };
}

/** Runs the steps and returns the titles of those that failed. What takes minutes is not begun after a failure. */
async function runSteps(release) {
  const failed = [];
  for (const [name, { title, run: runStep, quick }] of Object.entries(STEPS)) {
    if (!release.only.includes(name)) continue;
    if (failed.length > 0 && !quick) break;
    console.log(`\n— ${title}`);
    try {
      for (const line of await runStep(release)) console.log(`  ${line}`);
    } catch (error) {
      if (!(error instanceof Stop)) throw error;
      console.error(error.message);
      failed.push(title);
    }
  }
  return failed;
}

function refuse(problems) {
  if (problems.length > 0) throw new Stop(problems.join('\n'));
}

async function checkVersions({ found, version, tag }) {
  refuse([versionProblem(found), tag && tag !== `v${version}` ? `The tag is ${tag}, and the version is ${version}.` : undefined].filter(Boolean));
  return [`${version} in ${Object.keys(found).join(', ')}`];
}

async function checkChangelog({ version, tag }) {
  const { problem, todo } = changelogState(projectText('CHANGELOG.md'), version, new Date().toISOString().slice(0, 10));
  refuse([problem, tag ? todo : undefined].filter(Boolean));
  return [todo ?? `the newest section is of ${version}, and dated`];
}

async function checkTree(release) {
  const { code, stdout } = await run('git', ['status', '--porcelain'], { output: 'collect' });
  const changed = stdout.split('\n').filter(Boolean);
  if (code !== 0) changed.push('git status does not run here');
  release.dirty = changed.length > 0;
  if (release.tag && release.dirty) refuse([`Not committed:\n${changed.join('\n')}`]);
  return release.dirty ? [`not committed, so not in the modules that are built twice: ${changed.length} files`] : ['nothing is uncommitted'];
}

async function checkLicences() {
  const { code, text } = await run(process.execPath, ['scripts/notices.mjs', '--check'], { output: 'collect' });
  refuse([...licenceProblems(), ...(code === 0 ? [] : [text.trim()])]);
  return [`${WITH_NOTICES.join(', ')}, of the packages that are used now`];
}

async function buildModulesTwice() {
  await prepare({ checks: true });
  await buildModules();
  await buildTwice(OUT);
  return ['built in two fresh folders'];
}

async function compareModules() {
  refuse(moduleProblems(OUT));
  return Object.entries(hashesOf(builds(OUT)[0])).map(([name, hash]) => `${hash}  ${name}`);
}

async function packArchives(release) {
  await buildPackage();
  const archives = [
    { path: await packNpm(OUT), place: 'npm', wanted: WITH_NOTICES },
    { path: await packCrate(OUT, 'veronese', release), place: 'Cargo', wanted: LICENCES },
  ];
  const lines = [];
  for (const { path, place, wanted } of archives) {
    const files = await filesIn(path);
    refuse(missingInArchive(path, files, wanted));
    lines.push(`${place}, ${files.length} files:`, ...files.map((file) => `  ${file}`));
    release.files.push({ path, place });
  }
  return lines;
}

async function checkPackage({ files }) {
  const archive = files.find(({ place }) => place === 'npm') ?? { path: await packNpm(OUT) };
  await checkNpmArchive(archive.path);
  return ['found nothing'];
}

async function addWheel(release) {
  const built = await makeWheel(OUT);
  refuse(missingInArchive(built.wheel, built.files, WITH_NOTICES));
  release.files.push({ path: built.wheel, place: 'PyPI (and the wheels of the other systems)' });
  return [`${built.files.length} files:`, ...built.files.map((file) => `  ${file}`)];
}

async function addSite() {
  await buildSite();
  const missing = await missingNotices(readFileSync(join(SITE, 'licences/index.html'), 'utf8'));
  refuse(missing.map((name) => `The site's page of licences lacks ${name}.`));
  return ['out/site, with all licences and notices'];
}

async function listComponents(release) {
  const lists = await writeSboms(OUT);
  for (const { path } of lists) release.files.push({ path, place: 'the release page' });
  return lists.map(({ name, count }) => `${name}: ${count} components`);
}

function conclude({ version, tag, files }) {
  console.log(`\n${tag ? `${tag} is ready` : `A release of ${version} would be ready`}. In out/release, and published by the workflow:`);
  for (const line of publicationLines(files)) console.log(`  ${line}`);
}
