// veronese.json: the label image with the motions, nothing lost. What the other formats cannot carry is here.

import type { FormatMeta, LabelFrame, VeroneseDocument } from '../../types/formats.js';
import { invalidInput, isListOf, isObject, isWhole, LONGEST_SIDE, reading, UNLABELLED } from '../common/checks.js';
import type { VeroneseError } from '../common/errors.js';
import { checkedMeta, checkLabels, copied, imageOf, isMotion } from './input.js';

const FORMAT = 'veronese';
const VERSION = 1;

/** `labels` as runs, row by row: label, length, label, length … */
export function encodeVeronese(labels: Uint8Array, width: number, height: number, meta: FormatMeta = {}): VeroneseDocument {
  checkLabels(labels, width, height);
  const known = checkedMeta(meta);
  const runs: number[] = [];
  for (let start = 0, at = 1; start < labels.length; at++) {
    if (at < labels.length && labels[at] === labels[start]) continue;
    runs.push(labels[start] as number, at - start);
    start = at;
  }
  return {
    format: FORMAT,
    version: VERSION,
    image: imageOf(known),
    width,
    height,
    convention: 'pixel (0, 0) is the centre of the top-left pixel; u = a11 x + a12 y + a13, v = a21 x + a22 y + a23',
    motions: [...(known.motions ?? [])],
    names: known.names ?? {},
    runs,
  };
}

/** Throws `invalid-input` for anything that {@link encodeVeronese} does not write. */
export function decodeVeronese(document: unknown): LabelFrame & { meta: FormatMeta } {
  return reading(() => decoded(document));
}

function decoded(document: unknown): LabelFrame & { meta: FormatMeta } {
  if (!isObject(document) || document['format'] !== FORMAT) throw invalid('it is not a veronese.json');
  if (document['version'] !== VERSION) throw invalid(`version ${String(document['version'])} is unknown, ${VERSION} is known`);
  const { image, width, height, motions, names, runs } = document;
  if (typeof image !== 'string') throw invalid('"image" must be text');
  if (!isWhole(width, 1, LONGEST_SIDE) || !isWhole(height, 1, LONGEST_SIDE)) throw invalid(`"width" and "height" must be from 1 to ${LONGEST_SIDE}`);
  if (!isListOf(motions, isMotion)) throw invalid('"motions" must each have a label and a matrix of six numbers');
  if (!isObject(names) || !Object.values(names).every((name) => typeof name === 'string')) throw invalid('"names" must be texts');
  const labels = expanded(runs, width * height);
  return { labels, width, height, image, meta: { image, motions: motions.map(copied), names: { ...names } as Record<number, string> } };
}

function expanded(runs: unknown, size: number): Uint8Array {
  if (!Array.isArray(runs) || runs.length % 2 !== 0) throw invalid('"runs" must be pairs of numbers');
  const labels = new Uint8Array(size);
  let at = 0;
  for (let pair = 0; pair < runs.length; pair += 2) {
    const [label, length] = [runs[pair], runs[pair + 1]] as [unknown, unknown];
    if (!isWhole(label, 0, UNLABELLED)) throw invalid('"runs" has a label that is none');
    if (!isWhole(length, 1, size - at)) throw invalid('"runs" does not fit the size');
    labels.fill(label, at, at + length);
    at += length;
  }
  if (at !== size) throw invalid('"runs" does not fit the size');
  return labels;
}

function invalid(reason: string): VeroneseError {
  return invalidInput(`the document cannot be read: ${reason}`);
}
