// `veronese convert`: labels.png and result.json of a pair, in the forms that annotation tools read.

import { join } from 'node:path';
import type { SegmentedMotion } from '../../types/index.js';
import { groupLabels } from '../calls/labels.js';
import { isWhole, UNLABELLED } from '../common/checks.js';
import { VeroneseError } from '../common/errors.js';
import { davisPalette } from '../common/palette.js';
import { decodeImage } from '../entries/codecs.js';
import type { ConvertCommand } from './arguments.js';
import { checkFolder, type Output, type OutputFile, readInput } from './files.js';
import { FORMATS, type Masks } from './formats.js';

/** What is read of result.json. */
interface Result {
  width: number;
  height: number;
  motions: SegmentedMotion[];
}

/** Writes the files; returns one line of JSON that names them. */
export async function convert(command: ConvertCommand, output: Output): Promise<string> {
  const folder = command.out ?? command.folder;
  checkFolder(folder);
  const masks = await read(command);
  const files: OutputFile[] = command.to.flatMap((name) => FORMATS[name](masks));
  await output.write(folder, files, { beside: true });
  return `${JSON.stringify({ version: 1, folder, files: files.map(({ name }) => name) })}\n`;
}

async function read({ folder, grouped, image }: ConvertCommand): Promise<Masks> {
  const [picture, report] = [join(folder, 'labels.png'), join(folder, 'result.json')];
  const { data, width, height } = await decodeImage(await readInput(picture));
  const result = parsed(await readInput(report), report);
  if (width !== result.width || height !== result.height) {
    const sizes = `${width}×${height} and ${result.width}×${result.height}`;
    throw new VeroneseError('frame-size-mismatch', `'${picture}' and '${report}' differ in size: ${sizes} pixels`);
  }
  const labels = indices(data, picture);
  const groups = groupsOf(result.motions);
  const single = belongs(labels, new Map(result.motions.map(({ label, pixels }) => [label, pixels])));
  if (!single && !belongs(labels, new Map(groups.map(({ label, pixels }) => [label, pixels])))) {
    throw new VeroneseError('invalid-input', `'${picture}' and '${report}' are not of the same result`);
  }
  const meta = image === undefined ? {} : { image };
  if (single && !grouped) return { labels, width, height, meta: { ...meta, motions: result.motions } };
  const shown = single ? groupLabels({ labels, motions: result.motions }) : labels;
  const names = Object.fromEntries(groups.map(({ label }) => [label, `group-${label}`]));
  return { labels: shown, width, height, meta: { ...meta, motions: groups, names } };
}

function parsed(bytes: Uint8Array, path: string): Result {
  let result: Partial<Result> | null;
  try {
    result = JSON.parse(new TextDecoder().decode(bytes)) as Partial<Result> | null;
  } catch {
    throw new VeroneseError('invalid-json', `'${path}' is not JSON`);
  }
  const whole = (value: unknown): boolean => Number.isSafeInteger(value) && (value as number) >= 0;
  const label = (value: unknown): boolean => isWhole(value, 0, UNLABELLED - 1);
  const numbers = (value: unknown, count: number): boolean => Array.isArray(value) && value.length === count && value.every(Number.isFinite);
  const motion = (m: Partial<SegmentedMotion> | null): boolean =>
    label(m?.label) && label(m?.group) && whole(m?.pixels) && numbers([m?.share, m?.residual], 2) && numbers(m?.bbox, 4) && numbers(m?.matrix, 6);
  if (whole(result?.width) && whole(result?.height) && Array.isArray(result?.motions) && result.motions.every(motion)) return result as Result;
  throw new VeroneseError('invalid-input', `'${path}' is not a result of 'veronese pair'`);
}

/** Palette indices from the colours; those of the DAVIS palette are all different. */
function indices(rgba: Uint8Array | Uint8ClampedArray, path: string): Uint8Array {
  const index = new Map(davisPalette().map(([r, g, b], k) => [(r << 16) | (g << 8) | b, k]));
  return Uint8Array.from({ length: rgba.length / 4 }, (_, p) => {
    const found = index.get(((rgba[4 * p] as number) << 16) | ((rgba[4 * p + 1] as number) << 8) | (rgba[4 * p + 2] as number));
    if (found === undefined) throw new VeroneseError('invalid-input', `'${path}' has colours that are no labels`);
    return found;
  });
}

/** Every group as one motion: that of its largest member. */
function groupsOf(motions: readonly SegmentedMotion[]): SegmentedMotion[] {
  const groups = new Map<number, SegmentedMotion>();
  for (const motion of motions) {
    const known = groups.get(motion.group);
    if (!known) groups.set(motion.group, { ...motion, label: motion.group });
    else groups.set(motion.group, joined(known, motion));
  }
  return [...groups.values()].sort((a, b) => a.label - b.label);
}

function joined(a: SegmentedMotion, b: SegmentedMotion): SegmentedMotion {
  const [left, top] = [Math.min(a.bbox[0], b.bbox[0]), Math.min(a.bbox[1], b.bbox[1])];
  const right = Math.max(a.bbox[0] + a.bbox[2], b.bbox[0] + b.bbox[2]);
  const bottom = Math.max(a.bbox[1] + a.bbox[3], b.bbox[1] + b.bbox[3]);
  const pixels = a.pixels + b.pixels;
  const residual = Math.sqrt((a.pixels * a.residual ** 2 + b.pixels * b.residual ** 2) / Math.max(pixels, 1));
  return { ...a, pixels, share: a.share + b.share, residual, bbox: [left, top, right - left, bottom - top] };
}

/** Whether the labels are these, with these numbers of pixels; 255 aside. */
function belongs(labels: Uint8Array, pixels: ReadonlyMap<number, number>): boolean {
  const counts = new Map<number, number>();
  for (const label of labels) if (label !== 255) counts.set(label, (counts.get(label) ?? 0) + 1);
  return [...counts].every(([label, count]) => pixels.get(label) === count) && [...pixels].every(([label, count]) => (counts.get(label) ?? 0) === count);
}
