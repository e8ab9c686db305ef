// Image files under Node: the WebAssembly build that has everything of the others and reads and writes files.

import type { DecodeOptions, Picture } from '../../types/codecs.js';
import { Api } from '../calls/api.js';
import { taken } from '../calls/taking.js';
import { checkedBytes, entriesOf, invalidInput, invalidOption, isListOf, isWhole, reading } from '../common/checks.js';
import { colourBytes } from '../common/palette.js';
import { Core } from '../module/core.js';
import { glue } from './glue-codecs.js';
import { read } from './reading.js';

/** The format's own. */
const LONGEST_PNG_SIDE = 2 ** 31 - 1;

/** The build's own core, for threads that share its compiled module. */
export const core = new Core(glue, read, new URL('../wasm/codecs/veronese_codecs_bg.wasm', import.meta.url));

/** The calls of the package on this build: what decodes also segments, so the command line loads one module only. */
export const api = new Api(core, core);

export async function decodeImage(file: Uint8Array, options?: DecodeOptions): Promise<Picture> {
  const bytes = takenBytes('the file', file);
  const { allowDamaged, range } = reading(() => decoding(options));
  return (await core.call((glue) => glue.decodeImage(bytes, allowDamaged, range))) as Picture;
}

function decoding(options: unknown): { allowDamaged: boolean; range: Uint16Array } {
  const { allowDamaged = false, range = [] } = entriesOf(options, ['allowDamaged', 'range']);
  if (typeof allowDamaged !== 'boolean') throw invalidOption('allowDamaged', 'true or false', allowDamaged);
  const isSample = (value: unknown): value is number => isWhole(value, 0, 65_535);
  if (!isListOf(range, isSample) || ![0, 2].includes(range.length)) throw invalidOption('range', 'two whole numbers from 0 to 65535', range);
  return { allowDamaged, range: Uint16Array.from(range) };
}

export async function encodeIndexedPng(
  width: number,
  height: number,
  indices: Uint8Array,
  palette: readonly (readonly [number, number, number])[],
): Promise<Uint8Array> {
  checkSize(width, height);
  const bytes = takenBytes('the indices', indices);
  const colours = reading(() => colourBytes(palette, 3));
  return core.call((glue) => glue.encodeIndexedPng(width, height, bytes, colours));
}

export async function encodeGreyPng(width: number, height: number, grey: Uint8Array): Promise<Uint8Array> {
  checkSize(width, height);
  const bytes = takenBytes('the pixels', grey);
  return core.call((glue) => glue.encodeGreyPng(width, height, bytes));
}

export async function encodeColourPng(width: number, height: number, pixels: Uint8Array): Promise<Uint8Array> {
  checkSize(width, height);
  const bytes = takenBytes('the pixels', pixels);
  return core.call((glue) => glue.encodeColourPng(width, height, bytes));
}

/** The module may be loaded only later: the bytes are taken now. */
function takenBytes(which: string, bytes: unknown): Uint8Array {
  return taken([checkedBytes(which, bytes)], false)[0] as Uint8Array;
}

/** Sides of more bits would lose them on the way into the module. */
function checkSize(width: unknown, height: unknown): void {
  if (isWhole(width, 1, LONGEST_PNG_SIDE) && isWhole(height, 1, LONGEST_PNG_SIDE)) return;
  throw invalidInput(`width and height must be whole numbers of pixels from 1 to ${LONGEST_PNG_SIDE}`);
}
