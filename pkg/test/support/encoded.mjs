// What `encode` makes, as the tests compare it.

import { encode } from 'veronese/formats';

/** The files by name: JSON as its value, other text as text. */
export async function encoded(format, frames, metadata) {
  const files = await encode(format, frames, metadata);
  return Object.fromEntries(files.map(({ name, content }) => [name, name.endsWith('.json') ? JSON.parse(content) : content]));
}

/** The first of the files. */
export async function document(format, frames, metadata) {
  return Object.values(await encoded(format, frames, metadata))[0];
}

/** The files as they are given to `readAnnotations`. */
export async function files(format, frames, metadata) {
  const made = await encode(format, frames, metadata);
  return made.map(({ name, content }) => ({ name, bytes: typeof content === 'string' ? new TextEncoder().encode(content) : content }));
}
