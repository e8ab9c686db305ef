// MOTS as text, a line for each mask: ids are 1000 × class + instance.

import { VeroneseError } from '../common/errors.js';
import { cocoRle } from './coco-rle.js';
import { type Encoder, type Extent, idOf, lines, Numbering } from './frames.js';
import { nameOf, type Settings } from './metadata.js';

const CLASS = 1000;
/** More classes do not fit the 16 bits of MOTS as PNG. */
const MOST = 64;

/** Numbers of objects: 1000 × class + instance. */
class MotsIds {
  readonly #classes: Numbering;

  /** Of a list that leaves no room for the classes of all objects, only those that objects have are numbered. */
  constructor({ classes, names = {}, labels = Object.keys(names).map(Number) }: Settings) {
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

  /** The names of the classes, a line for each. */
  get text(): string {
    return lines(this.#classes.entries);
  }
}

/** A line is "frame id class height width run-lengths"; frames count from 1. */
export function mots(settings: Settings): Encoder {
  const ids = new MotsIds(settings);
  const written: string[] = [];
  const images: string[] = [];
  return {
    add(frame) {
      images.push(frame.image);
      for (const mask of frame.masks) {
        const id = ids.of(mask.name, mask.label);
        written.push(`${frame.index + 1} ${id} ${Math.floor(id / CLASS)} ${frame.height} ${frame.width} ${cocoRle(mask, frame).counts}`);
      }
    },
    finish: (extent) => [
      { name: 'mots/gt/gt.txt', content: lines(written) },
      { name: 'mots/gt/labels.txt', content: ids.text },
      { name: 'mots/seqinfo.ini', content: seqinfo(settings, extent, images) },
    ],
  };
}

/** The properties of a sequence that readers need. They want the frame rate as a whole number. */
function seqinfo({ clip, rate }: Settings, { width, height, length }: Extent, images: readonly string[]): string {
  const [extension = '.jpg'] = /\.[^./\\]+$/.exec(images[0] ?? '') ?? [];
  const entries = {
    name: oneLine(clip),
    imDir: 'img1',
    frameRate: Math.max(1, Math.round(rate)),
    seqLength: length,
    imWidth: width,
    imHeight: height,
    imExt: oneLine(extension),
  };
  return lines(['[Sequence]', ...Object.entries(entries).map(([key, value]) => `${key}=${value}`)]);
}

/** A name that does not end the line it stands in. */
function oneLine(name: string): string {
  return name.replace(/[\s\p{Cc}]+/gu, ' ');
}
