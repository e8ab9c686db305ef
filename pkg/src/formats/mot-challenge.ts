// MOTChallenge: a line for each box, "frame,id,left,top,width,height,1,class,1". Frames, ids, classes and pixels count from 1.

import type { ClipMeta, Encoded, LabelFrames, MotFiles } from '../../types/formats.js';
import { type Clip, type Extent, gathered, type Gathering, idOf, Numbering } from './frames.js';

export function encodeMotChallenge<Frames extends LabelFrames>(frames: Frames, meta?: ClipMeta): Encoded<Frames, MotFiles> {
  return gathered(frames, meta, (clip): Gathering<MotFiles> => {
    const classes = new Numbering(clip.classes?.map(oneLine));
    const lines: string[] = [];
    const images: string[] = [];
    return {
      add({ index, image, masks }) {
        images.push(image);
        for (const { label, name, left, top, width, height } of masks) {
          // Not ignored; of this class; all of it visible, as far as anyone knows.
          const rest = [1, classes.of(oneLine(name)), 1];
          lines.push(`${[index + 1, idOf(label), left + 1, top + 1, width, height, ...rest].join(',')}\n`);
        }
      },
      finish: (extent) => ({ gt: lines.join(''), seqinfo: seqinfo(clip, extent, images), names: classes.entries }),
    };
  });
}

/** The properties of a sequence that readers need. They want the frame rate as a whole number. */
export function seqinfo({ name, rate }: Clip, { width, height, length }: Extent, images: readonly string[]): string {
  const [extension = '.jpg'] = /\.[^./\\]+$/.exec(images[0] ?? '') ?? [];
  const entries = {
    name: oneLine(name),
    imDir: 'img1',
    frameRate: Math.max(1, Math.round(rate)),
    seqLength: length,
    imWidth: width,
    imHeight: height,
    imExt: oneLine(extension),
  };
  return `[Sequence]\n${Object.entries(entries).map(([key, value]) => `${key}=${value}\n`).join('')}`;
}

/** A name that does not end the line it stands in. */
export function oneLine(name: string): string {
  return name.replace(/[\s\p{Cc}]+/gu, ' ');
}
