// The examples of README.md, by what stands behind the language of their fences.

import { readFileSync } from 'node:fs';

const text = readFileSync(new URL('../../README.md', import.meta.url), 'utf8');

/** The content security policy for a page whose package is on another origin, with that origin in place of the CDN's. */
export function policyFor(origin) {
  return /^Content-Security-Policy: (.*https:.*)$/m.exec(text)[1].replaceAll(/https:\/\/[^ ;]+/g, origin);
}

/** The code of all fences of a kind: `js node`, `sh run`. */
export function examples(kind) {
  return [...text.matchAll(/^```([^\n]*)\n([\s\S]*?)^```$/gm)].filter(([, info]) => info === kind).map(([, , code]) => code);
}
