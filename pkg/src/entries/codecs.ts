// Image files under Node: the WebAssembly build that has everything of the others and reads and writes files.

import type { DecodeOptions, Picture, PngOptions } from '../../types/codecs.js';
import { Api } from '../calls/api.js';
import { taken } from '../calls/taking.js';
import { checkedBytes, entriesOf, invalidInput, invalidOption, isListOf, isWhole, LONGEST_SIDE, reading } from '../common/checks.js';
import { colourBytes } from '../common/palette.js';
import { scaled } from '../common/scaling.js';
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
  const { allowDamaged, range, maxSize } = reading(() => decoding(options));
  const picture = (await core.call((glue) => glue.decodeImage(bytes, allowDamaged, range, maxSize !== undefined))) as Picture;
  return { ...picture, ...scaled(picture, maxSize) } as Picture;
}

/** Whether an error is of a picture that could be scaled down. */
export function isTooLarge(code: string, message: string): boolean {
  return code === 'frame-size-unsupported' && (message.match(/\d+/g) ?? []).slice(0, 2).some((side) => Number(side) > LONGEST_SIDE);
}

function decoding(options: unknown): { allowDamaged: boolean; range: Uint16Array; maxSize: number | undefined } {
  const { allowDamaged = false, range = [], maxSize } = entriesOf(options, ['allowDamaged', 'range', 'maxSize']);
  if (typeof allowDamaged !== 'boolean') throw invalidOption('allowDamaged', 'true or false', allowDamaged);
  const isSample = (value: unknown): value is number => isWhole(value, 0, 65_535);
  if (!isListOf(range, isSample) || ![0, 2].includes(range.length))
    throw invalidOption('range', 'two whole numbers from 0 to 65535', range);
  if (maxSize !== undefined && !isWhole(maxSize, 1, LONGEST_SIDE))
    throw invalidOption('maxSize', `a whole number of pixels from 1 to ${LONGEST_SIDE}`, maxSize);
  return { allowDamaged, range: Uint16Array.from(range), maxSize };
}

export async function encodePng(width: number, height: number, data: Uint8Array, options?: PngOptions): Promise<Uint8Array> {
  if (!isWhole(width, 1, LONGEST_PNG_SIDE) || !isWhole(height, 1, LONGEST_PNG_SIDE)) {
    throw invalidInput(`width and height must be whole numbers of pixels from 1 to ${LONGEST_PNG_SIDE}`);
  }
  const bytes = takenBytes('the pixels', data);
  const colours = reading(() => {
    const { palette } = entriesOf(options, ['palette']);
    return palette === undefined ? undefined : colourBytes(palette);
  });
  return core.call((glue) => {
    if (colours) return glue.encodeIndexedPng(width, height, bytes, colours);
    return bytes.length === width * height ? glue.encodeGreyPng(width, height, bytes) : glue.encodeColourPng(width, height, bytes);
  });
}

/** The module may be loaded only later: the bytes are taken now. */
function takenBytes(which: string, bytes: unknown): Uint8Array {
  return taken([checkedBytes(which, bytes)], false)[0] as Uint8Array;
}
