// One pair of frames as the command line treats it: files in, a report and files out. Runs in a thread.

import type { Picture } from '../../types/codecs.js';
import type { Note, Segmentation } from '../../types/index.js';
import { groupLabels, maskOf } from '../calls/labels.js';
import { LONGEST_SIDE } from '../common/checks.js';
import { VeroneseError, veroneseError } from '../common/errors.js';
import { davisPalette } from '../common/palette.js';
import { api, decodeImage, encodePng, isTooLarge } from '../entries/codecs.js';
import type { OutputFile } from './files.js';
import { overlay } from './overlay.js';

export interface PairSettings {
  options: { motions: 'auto' | number; quality: 'fast' | 'best'; markUnknown: boolean; subject: boolean; confidence: boolean };
  /** Whether the images show groups instead of motions. */
  grouped: boolean;
  overlay: boolean;
  /** Whether pictures count of which a part is missing. */
  allowDamaged: boolean;
  /** Longest side to which pictures are scaled down. */
  maxSize: number | undefined;
}

export interface InputFile {
  name: string;
  bytes: Uint8Array;
}

export type Report = Omit<Segmentation, 'labels' | 'confidence'>;

/** Segments first and second; `withImages` also makes the image files. */
export async function segmentFiles(
  inputs: readonly InputFile[],
  settings: PairSettings,
  withImages: boolean,
): Promise<{ report: Report; images: OutputFile[] }> {
  const { pictures, notes } = await decodedAlike(inputs, settings);
  const [first, second] = pictures as [Picture, Picture];
  const segmentation = await api.segmentPair(first, second, settings.options);
  const { labels: _, confidence: __, ...rest } = segmentation;
  const all = [...notes, ...(rest.notes ?? [])];
  const report = { ...rest, ...(all.length > 0 && { notes: all }) };
  return { report, images: withImages ? await images(settings, segmentation, first) : [] };
}

async function images({ grouped, overlay: wanted }: PairSettings, segmentation: Segmentation, first: Picture): Promise<OutputFile[]> {
  const { width, height, motions } = segmentation;
  const labels = grouped ? groupLabels(segmentation) : segmentation.labels;
  const numbers = new Set(motions.map(({ label, group }) => (grouped ? group : label)));
  const files = [{ name: 'labels.png', bytes: await encodePng(width, height, labels, { palette: davisPalette() }) }];
  for (const number of numbers) {
    files.push({ name: `mask-${number}.png`, bytes: await encodePng(width, height, maskOf(labels, number)) });
  }
  if (segmentation.confidence) {
    files.push({ name: 'confidence.png', bytes: await encodePng(width, height, segmentation.confidence) });
  }
  if (wanted) {
    const rgb = overlay(first.data, labels);
    files.push({ name: 'overlay.png', bytes: await encodePng(width, height, rgb) });
  }
  return files;
}

/** The pictures in files, with samples of 16 bits on one scale. */
async function decodedAlike(
  inputs: readonly InputFile[],
  { allowDamaged, maxSize }: PairSettings,
): Promise<{ pictures: Picture[]; notes: Note[] }> {
  const notes: Note[] = [];
  const read = async (range?: Range) => {
    const pictures: Picture[] = [];
    notes.length = 0;
    for (const input of inputs) pictures.push(await decoded(input, { allowDamaged, maxSize, range, onNote: (note) => notes.push(note) }));
    return pictures;
  };
  const pictures = await read();
  const range = narrowRange(pictures.map((picture) => picture.range));
  if (!range) return { pictures, notes };
  const stretched = await read(range);
  return { pictures: stretched, notes: [...notes, rangeNote(range)] };
}

export type Range = readonly [number, number];

/** Samples of 16 bits are stretched where they fill less than this share of their range. */
const NARROW = 0.25;

/** The range of samples of 16 bits in all of some pictures, where it is a small part of what there is. */
export function narrowRange(ranges: readonly (Range | undefined)[]): Range | undefined {
  const all = ranges.filter((range) => range !== undefined);
  if (all.length === 0 || all.length < ranges.length) return undefined;
  const [low, high] = [Math.min(...all.map(([low]) => low)), Math.max(...all.map(([, high]) => high))];
  return high > low && high - low < NARROW * 65_536 ? [low, high] : undefined;
}

export function rangeNote([low, high]: Range): Note {
  return { code: 'range-stretched', message: `the samples of 16 bits go from ${low} to ${high} only: these are taken for black and white` };
}

export interface Decoding {
  allowDamaged?: boolean | undefined;
  maxSize?: number | undefined;
  range?: Range | undefined;
  /** Hears what was assumed of the file. */
  onNote?: (note: Note) => void;
}

/** The picture in a file; the error of one that is none names it. */
export async function decoded(
  { name, bytes }: InputFile,
  { allowDamaged = false, maxSize, range, onNote }: Decoding = {},
): Promise<Picture> {
  const options = { maxSize, ...(range && { range }) };
  try {
    return await decodeImage(bytes, options);
  } catch (thrown) {
    const { code, message } = veroneseError(thrown);
    const remedy = maxSize === undefined && isTooLarge(code, message) ? `; '--max-size ${LONGEST_SIDE}' scales it down` : '';
    const damage = new VeroneseError(code, `${name}: ${message}${remedy}`);
    if (code !== 'unreadable-image') throw damage;
    const picture = await decodeImage(bytes, { ...options, allowDamaged: true }).catch(() => undefined);
    if (!picture) throw damage;
    if (!allowDamaged) throw new VeroneseError(code, `${damage.message}; '--allow-damaged' takes it as it is`);
    onNote?.({ code: 'damaged-image', message: `${damage.message}; what is missing is grey` });
    return picture;
  }
}

/** One line of JSON. What is no number in JSON would become null without a word: that is a mistake of ours. */
export function jsonLine(report: object): string {
  const text = JSON.stringify(report, (key, value: unknown) => {
    if (typeof value !== 'number' || Number.isFinite(value)) return value;
    throw new VeroneseError('internal', `the result's '${key}' is ${value}`);
  });
  return `${text}\n`;
}
