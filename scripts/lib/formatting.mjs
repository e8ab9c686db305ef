// The layout of TypeScript and JavaScript: oxfmt writes it, .oxfmtrc.json says how.

import { run } from './run.mjs';

/** Folders whose layout is checked. */
export const FORMATTED = ['benches', 'examples', 'pkg/bin', 'pkg/scripts', 'pkg/src', 'python', 'scripts'];

const KINDS = '*.{ts,tsx,mjs,js,jsx}';

/** Writes the layout of what is in some folders. Returns whether that went well. */
export function format(folders) {
  return formatter(folders, '--write');
}

/** Whether the folders have it. Says which files have not. */
export function layoutAgrees(folders = FORMATTED) {
  return formatter(folders, '--check');
}

async function formatter(folders, mode) {
  if (folders.length === 0) return true;
  const { code } = await run('oxfmt', [mode, '--no-error-on-unmatched-pattern', ...folders.map((folder) => `${folder}/**/${KINDS}`)]);
  return code === 0;
}
