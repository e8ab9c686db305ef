import { readFileSync } from 'node:fs';

export default JSON.parse(readFileSync(new URL('../../identity.json', import.meta.url), 'utf8'));
