// CVAT's MOTS PNG archive: for every frame a 16-bit grey image, 1000 × class + track; class 1 is the first of labels.txt.

import { type Zippable, zipSync } from 'fflate';
import type { ClipMeta, Encoded, LabelFrames } from '../../types/formats.js';
import { keyOf } from '../common/checks.js';
import { VeroneseError } from '../common/errors.js';
import { gathered, type Gathering, Numbering } from './frames.js';
import { MotsIds } from './mots.js';
import { checkPath } from './names.js';
import { png } from './png.js';

const LABELS = 'default/instances/labels.txt';
/** Archives hold times: the earliest that a zip can have, so that the same masks give the same bytes. In local time, as fflate reads it. */
const EPOCH = { mtime: new Date(1980, 0, 1) };

export function encodeCvatMots<Frames extends LabelFrames>(frames: Frames, meta?: ClipMeta): Encoded<Frames, Uint8Array> {
  return gathered(frames, meta, (clip): Gathering<Uint8Array> => {
    const ids = new MotsIds(clip);
    // Where labels are no objects, each is a class of its own and its number is that of its track as well.
    const tracks = new Numbering();
    const taken = new Set<string>();
    const files: Zippable = { [LABELS]: new Uint8Array() };
    return {
      add({ image, width, height, masks }) {
        const samples = new Uint8Array(width * height * 2);
        for (const mask of masks) {
          const value = ids.of(mask.name, clip.tracked ? mask.label : tracks.of(String(mask.label)));
          mask.pixels.forEach((set, at) => {
            if (!set) return;
            const pixel = (mask.top + Math.floor(at / mask.width)) * width + mask.left + (at % mask.width);
            samples[2 * pixel] = value >> 8;
            samples[2 * pixel + 1] = value & 255;
          });
        }
        const name = image.replace(/\.[^./]*$/, '');
        checkPath(name);
        const path = `default/instances/${name}.png`;
        if (taken.has(keyOf(name))) throw new VeroneseError('invalid-input', `two frames have the name '${name}'`);
        taken.add(keyOf(name));
        files[path] = [png(width, height, samples, { depth: 16 }), EPOCH];
      },
      finish() {
        files[LABELS] = [new TextEncoder().encode(ids.names.map((name) => `${name}\n`).join('')), EPOCH];
        return zipSync(files);
      },
    };
  });
}
