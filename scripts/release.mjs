// npm run release: everything that a release does before it publishes, by the registries' own dry runs. Publishing is left to
// .github/workflows/release.yml, which runs this for a tag and then hands what is in out/release to npm: nobody needs a token.

import { mkdirSync, readdirSync, rmSync } from 'node:fs';
import { join } from 'node:path';
import { parseArgs } from 'node:util';

import { buildPackage, buildWheel } from './lib/builds.mjs';
import { changelogProblem } from './lib/changelog.mjs';
import { prepare } from './lib/prepare.mjs';
import { projectText, root } from './lib/project.mjs';
import { OWN } from './lib/python-packages.mjs';
import { Stop, command, must, run } from './lib/run.mjs';
import { buildSite } from './lib/site.mjs';
import { versionProblem, versions } from './lib/versions.mjs';

const OUT = join(root, 'out', 'release');
const USAGE = `npm run release -- --dry-run | --tag vX.Y.Z

  --dry-run   rehearses a release of what is here
  --tag       prepares the release of this tag: nothing may be uncommitted, and the changelog must be dated`;

await command(async (args) => {
  const { tag } = options(args);
  const { ownPython } = await prepare({ ownPython: true });
  if (ownPython.problem) throw new Stop(ownPython.problem);
  const found = await versions();
  const version = found['Cargo.toml'];
  const problems = [
    versionProblem(found),
    tag && tag !== `v${version}` ? `The tag is ${tag}, and the version is ${version}.` : undefined,
    tag && changelogProblem(projectText('CHANGELOG.md'), version),
    tag && (await treeProblem()),
  ].filter(Boolean);
  if (problems.length > 0) throw new Stop(problems.join('\n'));
  await publishNowhere(tag);
  await buildSite();
  console.log(
    `\n${tag ? `${tag} is ready` : `A release of ${version} would be ready`}: ${readdirSync(OUT).join(', ')}, the crate, and the site.`,
  );
  return 0;
});

function options(args) {
  try {
    const { values } = parseArgs({ args, options: { 'dry-run': { type: 'boolean' }, tag: { type: 'string' } } });
    if (values.tag && !/^v\d+\.\d+\.\d+$/.test(values.tag)) throw new Error(`A tag is called like v0.1.0, not '${values.tag}'.`);
    if (Object.keys(values).length !== 1)
      throw new Error('Nothing is published from here: push a tag, and the workflow release.yml publishes.');
    return values;
  } catch (error) {
    throw new Stop(`${error.message}\n\n${USAGE}`);
  }
}

async function treeProblem() {
  const { code, stdout } = await run('git', ['status', '--porcelain'], { output: 'collect' });
  return code === 0 && stdout === '' ? undefined : `Not committed:\n${stdout}`;
}

/** Packs all packages, and has each registry's program do all of a publication but the last step. */
async function publishNowhere(tag) {
  rmSync(OUT, { recursive: true, force: true });
  mkdirSync(OUT, { recursive: true });
  await buildPackage();
  await must('The npm package could not be packed.', 'npm', ['pack', '--ignore-scripts', '--pack-destination', OUT], {
    cwd: join(root, 'pkg'),
  });
  const archive = join(OUT, readdirSync(OUT)[0]);
  await must('npm would not publish the package.', 'npm', ['publish', '--dry-run', '--ignore-scripts', '--access', 'public', archive]);
  const dirty = tag ? [] : ['--allow-dirty'];
  await must('Cargo would not publish the crate.', 'cargo', ['publish', '--dry-run', '--locked', '--package', 'veronese', ...dirty]);
  await must('The wheel could not be kept.', 'cp', [await buildWheel(OWN.python), OUT]);
}
