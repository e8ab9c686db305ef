import { readFileSync } from 'node:fs';

const text = readFileSync(new URL('../../CHANGELOG.md', import.meta.url), 'utf8');

/** Without its title, which the page has. */
export default text.replace(/^# .*\n/, '');
