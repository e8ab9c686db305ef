import { readFileSync } from 'node:fs';

const { version } = JSON.parse(readFileSync(new URL('../../pkg/package.json', import.meta.url), 'utf8'));

export default { package: version };
