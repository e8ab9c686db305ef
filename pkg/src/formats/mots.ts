// MOTS as text, a line for each mask: ids are 1000 × class + instance.

import { invalidInput } from '../common/checks.js';
import { cocoRle } from './coco-rle.js';
import { type Encoder, type Extent, idOf, lines, Numbering } from './frames.js';
import { nameOf, type Settings } from './metadata.js';

const CLASS = 1000;
/** More classes do not fit the 16 bits of MOTS as PNG. */
const MOST = 64;

/** A line is "frame id class height width run-lengths"; frames count from 1. */
export function mots(settings: Settings): Encoder {
  const classes = new Numbering(classesOf(settings));
  const written: string[] = [];
  const images: string[] = [];
  return {
    add(frame) {
      images.push(frame.image);
      for (const mask of frame.masks) {
        const number = classes.of(oneLine(mask.name));
        if (number > MOST) throw invalidInput(`MOTS holds ${MOST} classes at most`);
        const id = number * CLASS + idOf(mask.label);
        written.push(`${frame.index + 1} ${id} ${number} ${frame.height} ${frame.width} ${cocoRle(mask, frame).counts}`);
      }
    },
    finish: (extent) => [
      { name: 'mots/gt/gt.txt', content: lines(written) },
      { name: 'mots/gt/labels.txt', content: lines(classes.entries) },
      { name: 'mots/seqinfo.ini', content: seqinfo(settings, extent, images) },
    ],
  };
}

/** Of a list that leaves no room for the classes of all objects, only those that objects have are numbered. */
function classesOf({ classes, names = {}, labels = Object.keys(names).map(Number) }: Settings): string[] {
  const used = new Set(labels.map((label) => oneLine(nameOf(label, { names }))));
  const listed = classes.map(oneLine);
  return new Set([...listed, ...used]).size <= MOST ? listed : listed.filter((name) => used.has(name));
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
