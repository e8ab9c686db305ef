// CVAT's MOTS PNG archive: for every frame a 16-bit grey image, 1000 × class + track; class 1 is the first of labels.txt.

import { type Zippable, zipSync } from 'fflate';
import type { FormatMeta, LabelFrame } from '../../types/formats.js';
import { VeroneseError } from '../common/errors.js';
import { checkFrames, imageOf, masksOf, nameOf } from './input.js';
import { checkPath } from './names.js';
import { png } from './png.js';

const CLASS = 1000;
/** The largest value is 1000 × 65 + 65: more classes do not fit 16 bits. */
const MOST = 64;
/** Archives hold times: the earliest that a zip can have, so that the same masks give the same bytes. In local time, as fflate reads it. */
const EPOCH = { mtime: new Date(1980, 0, 1) };

/** Class and track of a label have the same number: each motion is an object of its own. */
export function encodeCvatMots(frames: readonly LabelFrame[], meta: FormatMeta = {}): Uint8Array {
  const { width, height } = checkFrames(frames);
  const perFrame = frames.map(({ labels }) => masksOf(labels, width, height, meta));
  const present = [...new Set(perFrame.flatMap((masks) => masks.map(({ label }) => label)))].sort((a, b) => a - b);
  if (present.length > MOST) throw new VeroneseError('invalid-input', `MOTS holds ${MOST} labels at most, not ${present.length}`);
  const names = present.map((label) => nameOf(label, meta).replace(/[\s\p{Cc}]+/gu, ' '));
  const files: Zippable = { 'default/instances/labels.txt': [new TextEncoder().encode(`${names.join('\n')}\n`), EPOCH] };
  const taken = new Set<string>();
  perFrame.forEach((masks, index) => {
    const samples = new Uint8Array(width * height * 2);
    for (const mask of masks) {
      const number = present.indexOf(mask.label) + 1;
      const value = number * CLASS + number;
      mask.pixels.forEach((set, at) => {
        if (!set) return;
        const pixel = (mask.top + Math.floor(at / mask.width)) * width + mask.left + (at % mask.width);
        samples[2 * pixel] = value >> 8;
        samples[2 * pixel + 1] = value & 255;
      });
    }
    const name = (frames[index]?.image ?? (index === 0 ? imageOf(meta) : `frame-${index}`)).replace(/\.[^./]*$/, '');
    checkPath(name);
    if (taken.has(name)) throw new VeroneseError('invalid-input', `two frames have the name '${name}'`);
    taken.add(name);
    files[`default/instances/${name}.png`] = [png(width, height, samples, { depth: 16 }), EPOCH];
  });
  return zipSync(files);
}
