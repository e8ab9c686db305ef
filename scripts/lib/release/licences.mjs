// Licences: every package has both texts and the notices of what it contains, in the tree and in the archive.

import { inProject, projectText } from '../project.mjs';

/** In every archive of sources. */
export const LICENCES = ['LICENSE-APACHE', 'LICENSE-MIT'];

/** In every archive that contains works of others. */
export const WITH_NOTICES = [...LICENCES, 'THIRD-PARTY-NOTICES'];

/** The folders from which packages are made; those that do not exist are left out. */
const FOLDERS = ['pkg', 'python'];

/** A sentence for every text that is missing or not that of the project. */
export function licenceProblems() {
  const missing = WITH_NOTICES.filter((name) => !inProject(name)).map((name) => `${name} is missing.`);
  const copies = FOLDERS.filter(inProject).flatMap((folder) => WITH_NOTICES.filter(inProject).map((name) => [name, `${folder}/${name}`]));
  return [...missing, ...copies.flatMap(([name, copy]) => copyProblem(name, copy))];
}

function copyProblem(name, copy) {
  if (!inProject(copy)) return [`${copy} is missing.`];
  // Each package has notices of its own, which `npm run notices -- --check` compares with what it contains.
  if (name === 'THIRD-PARTY-NOTICES' || projectText(copy) === projectText(name)) return [];
  return [`${copy} is not ${name}.`];
}

/** A sentence for every text of `wanted` that an archive with these files does not have. */
export function missingInArchive(archive, files, wanted) {
  return wanted.filter((name) => !files.some((file) => file.split('/').at(-1) === name)).map((name) => `${archive} has no ${name}.`);
}
