//! The formats of clips as data. The encoder is the package's, the same that `veronese convert` uses. Loaded on first use.

import { type Format, encode } from 'veronese/formats';
import type { ClipFormat } from './clip-export.js';
import { videoFormats } from './clip-video.js';

/** Of polygons: the distance in pixels by which they may leave a mask's border, as of `veronese convert`. */
const TOLERANCE = 0.5;

/** All formats that this browser can write, in the order of the menu. */
export async function clipFormats(): Promise<readonly ClipFormat[]> {
  return [...FORMATS, ...(await videoFormats())];
}

/** `counted`: the format counts the frames of the video, so that all from its first one on are written. */
function entry(id: Format, title: string, hint: string, { counted = false } = {}): ClipFormat {
  return {
    id,
    title,
    hint,
    // What they are called does not depend on what is in the frames.
    async names({ meta: { timestamps: _, ...metadata }, stems }) {
      const frames = stems.map((stem) => ({ labels: new Uint8Array(1), width: 1, height: 1, image: `${stem}.png` }));
      return (await encode(id, frames, metadata)).map(({ name }) => name);
    },
    async make(exported) {
      const sequence = counted ? exported.fromStart : exported;
      const files = await encode(id, sequence.frames(), { ...sequence.meta, ...(counted && { clip: exported.clip.name }), tolerance: TOLERANCE });
      return Object.fromEntries(files.map(({ name, content }) => [name, content]));
    },
  };
}

const FORMATS: readonly ClipFormat[] = [
  entry('cvat-video', 'CVAT, tracks', 'CVAT for video 1.1: a track with polygons for each object.', { counted: true }),
  entry('youtube-vis', 'YouTube-VIS', 'The objects of the clip as compressed run lengths in the form of COCO.'),
  entry('coco', 'COCO, RLE', 'Every frame is an image; objects have a track_id.'),
  entry('mots', 'MOTS', 'The text form of MOTS, with the names of the classes.'),
  entry('davis', 'DAVIS', 'An indexed PNG for each frame: the index is the number of the object.'),
  entry('yolo', 'YOLO segmentation', 'A text file for each frame with a line per object, and the names of the classes.'),
  entry('label-studio', 'Label Studio', 'A task for each frame with brush labels as predictions.'),
];
