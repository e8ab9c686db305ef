// The measured figures: what the benchmarks have written to docs/figures, by the name of the file.

import { existsSync, readFileSync, readdirSync } from 'node:fs';

const FOLDER = new URL('../../docs/figures/', import.meta.url);

const names = existsSync(FOLDER) ? readdirSync(FOLDER).filter((name) => name.endsWith('.json')) : [];
export default Object.fromEntries(names.map((name) => [name.replace('.json', ''), JSON.parse(readFileSync(new URL(name, FOLDER), 'utf8'))]));
