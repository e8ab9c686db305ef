// MOTS in text: a line for each mask, "frame id class height width run-lengths"; frames count from 1.

import type { ClipMeta, Encoded, FormatMeta, LabelFrames, MotFiles } from '../../types/formats.js';
import { VeroneseError } from '../common/errors.js';
import { cocoRle } from './coco-rle.js';
import { gathered, type Gathering, idOf, Numbering } from './frames.js';
import { nameOf } from './input.js';
import { oneLine, seqinfo } from './mot-challenge.js';

const CLASS = 1000;
/** The largest value is 1000 × 65 + 255: more classes do not fit the 16 bits of the PNG form. */
const MOST = 64;

/** Numbers of objects: 1000 × class + instance. */
export class MotsIds {
  readonly #classes: Numbering;

  /** Of a list that leaves no room for the classes of all objects, only those that objects have are numbered. */
  constructor({ classes = [], names = {}, labels = Object.keys(names).map(Number) }: FormatMeta) {
    const used = new Set(labels.map((label) => oneLine(nameOf(label, { names }))));
    const listed = classes.map(oneLine);
    const fits = new Set([...listed, ...used]).size <= MOST;
    this.#classes = new Numbering(fits ? listed : listed.filter((name) => used.has(name)));
  }

  of(name: string, label: number): number {
    const number = this.#classes.of(oneLine(name));
    if (number > MOST) throw new VeroneseError('invalid-input', `MOTS holds ${MOST} classes at most`);
    return number * CLASS + idOf(label);
  }

  /** Of the classes, each on one line. */
  get names(): string[] {
    return this.#classes.entries;
  }
}

export function encodeMots<Frames extends LabelFrames>(frames: Frames, meta?: ClipMeta): Encoded<Frames, MotFiles> {
  return gathered(frames, meta, (clip): Gathering<MotFiles> => {
    const ids = new MotsIds(clip);
    const lines: string[] = [];
    const images: string[] = [];
    return {
      add({ index, image, width, height, masks }) {
        images.push(image);
        for (const mask of masks) {
          const id = ids.of(mask.name, mask.label);
          lines.push(`${index + 1} ${id} ${Math.floor(id / CLASS)} ${height} ${width} ${cocoRle(mask, width, height).counts}\n`);
        }
      },
      finish: (extent) => ({ gt: lines.join(''), seqinfo: seqinfo(clip, extent, images), names: ids.names }),
    };
  });
}
