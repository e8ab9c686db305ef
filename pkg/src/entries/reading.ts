// Node: a module from a path, a file: URL or the network.

import { readFile } from 'node:fs/promises';
import type { Read } from '../module/loading.js';

export const read: Read = async (place) => {
  const text = String(place);
  if (/^(https?|data|blob):/i.test(text)) return fetch(text);
  return new Uint8Array(await readFile(/^file:/i.test(text) ? new URL(text) : text));
};
