//! Quoting for command lines.

/** The word, quoted if a POSIX shell needs that. */
export function quoted(word: string): string {
  return /^[\w./-]+$/.test(word) && !word.startsWith('-') ? word : `'${word.replaceAll("'", "'\\''")}'`;
}
