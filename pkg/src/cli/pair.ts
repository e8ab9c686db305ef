// One pair of frames as the command line treats it: files in, a report and files out. Runs in a thread.

import type { Picture } from '../../types/codecs.js';
import type { Segmentation } from '../../types/index.js';
import { groupLabels, maskOf, overlay } from '../calls/labels.js';
import { VeroneseError, veroneseError } from '../common/errors.js';
import { davisPalette } from '../common/palette.js';
import { api, decodeImage, encodeColourPng, encodeGreyPng, encodeIndexedPng } from '../entries/codecs.js';
import type { OutputFile } from './files.js';

export interface PairSettings {
  options: { motions: 'auto' | number; quality: 'fast' | 'best'; markUnknown: boolean; confidence: boolean };
  /** Whether the images show groups instead of motions. */
  grouped: boolean;
  overlay: boolean;
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
  const pictures: Picture[] = [];
  for (const input of inputs) pictures.push(await decoded(input));
  const [first, second] = pictures as [Picture, Picture];
  const segmentation = await api.segmentPair(first, second, settings.options);
  const { labels: _, confidence: __, ...report } = segmentation;
  return { report, images: withImages ? await images(settings, segmentation, first) : [] };
}

async function images({ grouped, overlay: wanted }: PairSettings, segmentation: Segmentation, first: Picture): Promise<OutputFile[]> {
  const { width, height, motions } = segmentation;
  const labels = grouped ? groupLabels(segmentation) : segmentation.labels;
  const numbers = new Set(motions.map(({ label, group }) => (grouped ? group : label)));
  const files = [{ name: 'labels.png', bytes: await encodeIndexedPng(width, height, labels, davisPalette()) }];
  for (const number of numbers) {
    files.push({ name: `mask-${number}.png`, bytes: await encodeGreyPng(width, height, maskOf(labels, number)) });
  }
  if (segmentation.confidence) {
    files.push({ name: 'confidence.png', bytes: await encodeGreyPng(width, height, segmentation.confidence) });
  }
  if (wanted) {
    const rgb = overlay(first.data, labels);
    files.push({ name: 'overlay.png', bytes: await encodeColourPng(width, height, rgb) });
  }
  return files;
}

/** The picture in a file; the error of one that is none names it. */
export async function decoded({ name, bytes }: InputFile): Promise<Picture> {
  try {
    return await decodeImage(bytes);
  } catch (thrown) {
    const { code, message } = veroneseError(thrown);
    throw new VeroneseError(code, `${name}: ${message}`);
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
