// Label images and JSON, as the program wrote them, read back.

import type { Levels } from '../../types/formats.js';
import { VeroneseError, veroneseError } from '../common/errors.js';
import { readInput } from './files.js';
import { decodeIndices } from '../formats/png-reader.js';
import { crispLevels } from '../formats/reading/smoothed.js';

/** The labels in an indexed PNG, or in one of another program. Throws what reading and decoding throw, the file named. */
export async function readLabels(
  path: string,
  options?: { foreign: boolean; levels: Levels | undefined },
): Promise<{ labels: Uint8Array; width: number; height: number }> {
  const bytes = await readInput(path);
  try {
    const { indices, isGrey, ...size } = decodeIndices(bytes, options);
    return { labels: isGrey ? crispLevels(indices, size, options?.levels) : indices, ...size };
  } catch (thrown) {
    const { code, message } = veroneseError(thrown);
    throw new VeroneseError(code, `'${path}' ${message}`);
  }
}

/** The value in a file of JSON. Throws `invalid-json`. */
export async function readJson(path: string): Promise<unknown> {
  const bytes = await readInput(path);
  try {
    return JSON.parse(new TextDecoder().decode(bytes));
  } catch {
    throw new VeroneseError('invalid-json', `'${path}' is not JSON`);
  }
}
