// Names and addresses of the project: identity.json has them, and this compares what repeats them.

import { readdirSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';

import { inProject, projectText, root } from './project.mjs';

/** What identity.json says. */
export const identity = () => JSON.parse(projectText('identity.json'));

/** What repeats an address, beside the manifests: every text for people at these places. */
const TEXTS = ['.', '.github', '.github/ISSUE_TEMPLATE', 'docs', 'pkg', 'python', 'www', 'examples', 'site/pages', 'site/pages/guide', 'site/layouts/method'];
const KINDS = /\.(md|ya?ml|html|toml|json)$/;
const GENERATED = new Set(['package-lock.json', 'identity.json']);

/** A sentence for everything that differs from identity.json. */
export async function identityProblems() {
  const own = identity();
  return [...(await manifestProblems(own)), ...files().flatMap((file) => addressProblems(file, projectText(file), own))];
}

/** Names and addresses in the manifests, from which registries make their pages. */
async function manifestProblems({ repository, site, crate, npm, python }) {
  const { parse } = await import('smol-toml');
  const cargo = parse(projectText('Cargo.toml'));
  const manifest = JSON.parse(projectText('pkg/package.json'));
  const facts = [
    ['Cargo.toml', 'name', cargo.package.name, crate],
    ['Cargo.toml', 'repository', cargo.package.repository, repository],
    ['pkg/package.json', 'name', manifest.name, npm],
    ['pkg/package.json', 'repository', manifest.repository?.url, `git+${repository}.git`],
    ['pkg/package.json', 'bugs', manifest.bugs, `${repository}/issues`],
    ['pkg/package.json', 'homepage', manifest.homepage, site],
  ];
  if (inProject('python/pyproject.toml')) {
    const { project } = parse(projectText('python/pyproject.toml'));
    facts.push(['python/pyproject.toml', 'name', project.name, python]);
    facts.push(['python/pyproject.toml', 'Repository', project.urls?.Repository, repository]);
  }
  return facts.flatMap(([file, field, found, wanted]) =>
    found === wanted ? [] : [`${file}: ${field} is ${found === undefined ? 'missing' : `'${found}'`}; identity.json has '${wanted}'.`],
  );
}

/** Addresses of a repository or a site with this project's name that are not those of identity.json. */
export function addressProblems(file, text, { repository, site }) {
  const { host, pathname } = new URL(repository);
  const pages = new URL(site).host.replace(/^[^.]+\./, '');
  const name = literal(pathname.split('/').at(-1));
  const addresses = text.matchAll(new RegExp(`https://(?:${literal(host)}/[\\w.-]+|[\\w-]+\\.${literal(pages)})/${name}(?![\\w-])`, 'g'));
  return [...new Set([...addresses].map(([address]) => address))]
    .filter((address) => address !== repository && address !== site.replace(/\/$/, ''))
    .map((address) => `${file}: ${address} is not an address of identity.json.`);
}

/** Replaces the addresses that the manifests have by those of identity.json, everywhere; returns the files that changed. */
export async function writeAddresses() {
  const { parse } = await import('smol-toml');
  const { repository, site } = identity();
  const before = { repository: parse(projectText('Cargo.toml')).package.repository, site: JSON.parse(projectText('pkg/package.json')).homepage };
  return files().filter((file) => {
    const text = projectText(file);
    const changed = text.replaceAll(before.repository, repository).replaceAll(before.site, site);
    if (changed !== text) writeFileSync(join(root, file), changed);
    return changed !== text;
  });
}

/** Every address in these texts, once. */
export function linksInTexts() {
  const links = files().flatMap((file) => projectText(file).match(/https:\/\/[^\s<>()"'`\]]+/g) ?? []);
  return [...new Set(links.map((link) => link.replace(/[.,;:]+$/, '')))].sort();
}

function literal(text) {
  return text.replace(/[.*+?^${}()|[\]\\]/g, '\\$&');
}

function files() {
  return TEXTS.filter(inProject).flatMap((folder) => textsIn(folder).map((name) => (folder === '.' ? name : `${folder}/${name}`)));
}

function textsIn(folder) {
  return readdirSync(join(root, folder), { withFileTypes: true })
    .filter((entry) => entry.isFile() && KINDS.test(entry.name) && !GENERATED.has(entry.name))
    .map(({ name }) => name);
}
