// Label images and JSON, as the program wrote them, read back.

import type { LabelImage, Levels } from '../../types/formats.js';
import { VeroneseError } from '../common/errors.js';
import { readInput } from './files.js';
import { decodeIndices } from '../formats/png-reader.js';
import { naming } from '../formats/reading/frame.js';
import { labelsOfPng } from '../formats/reading/mask.js';

/** The labels in an indexed PNG, or in one of another program. Throws what reading and decoding throw, the file named. */
export async function readLabels(path: string, options?: { foreign: boolean; levels: Levels | undefined }): Promise<LabelImage> {
  const bytes = await readInput(path);
  return naming(path, () => (options?.foreign ? labelsOfPng(bytes, options.levels) : decodeIndices(bytes)));
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
