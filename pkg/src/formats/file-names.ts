// Names that become files in an archive: one that stays in its folder here may lead elsewhere on the system that unpacks it.

import { VeroneseError } from '../common/errors.js';

/** Longest part of a path, less an extension of four characters, and longest path; bytes that every file system takes. */
const LONGEST = { part: 251, path: 4000 };

/** Patterns that no name may have, each with the sentence's end. */
const WRONG: readonly [RegExp, string][] = [
  [/\p{Cc}/u, 'has control characters'],
  [/\\/, 'has a backslash; folders are divided by /'],
  [/^[a-z]:/i, 'begins with a drive'],
  [/^$|^\/|\/\/|\/$/, 'is empty or has an empty part'],
  [/(^|\/)\.\.?(\/|$)/, 'leads elsewhere'],
  [/[. ](\/|$)/, 'has a part that ends with a dot or a space'],
  [/(^|\/)(con|prn|aux|nul|com\d|lpt\d)(\.|\/|$)/i, 'has a part that is a device on Windows'],
];

/** Throws `invalid-input` unless the path, without its extension, stays below the folder where it is unpacked, on every system. */
export function checkPath(path: string): void {
  const bytes = (text: string) => new TextEncoder().encode(text).length;
  const tooLong = bytes(path) > LONGEST.path || path.split('/').some((part) => bytes(part) > LONGEST.part);
  const problem = WRONG.find(([pattern]) => pattern.test(path))?.[1] ?? (tooLong && 'is too long');
  if (problem) throw new VeroneseError('invalid-input', `${JSON.stringify(path.slice(0, 80))} cannot be the name of a file: it ${problem}`);
}
