import { readFileSync } from 'node:fs';

import identity from './identity.mjs';

const text = readFileSync(new URL('../../CHANGELOG.md', import.meta.url), 'utf8');

/** Without its title, which the page has; with links to files of the repository as addresses. */
export default text
  .replace(/^# .*\n/, '')
  .replaceAll(/^## \[([^\]]+)\]/gm, '## $1')
  .replaceAll(/\]\((?!https?:|#)([^)]+)\)/g, `](${identity.repository}/blob/main/$1)`);
