// Types of `veronese/formats`: masks in the formats of annotation tools. docs/formats.md describes each format.

import type { Matrix } from './index.js';

/** The formats that are written, called as those of `veronese convert --to`. */
export type Format =
  | 'coco'
  | 'coco-polygon'
  | 'youtube-vis'
  | 'cvat'
  | 'cvat-polygon'
  | 'cvat-video'
  | 'mots'
  | 'label-studio'
  | 'label-studio-polygon'
  | 'yolo'
  | 'davis'
  | 'masks';

/** The motion of a label to the next frame. Those of a `Segmentation` fit. */
export interface FormatMotion {
  label: number;
  matrix: Matrix;
}

/** One frame. A `Segmentation` fits, and so do the frames of a `Clip`. */
export interface LabelFrame {
  /** One label for each pixel, row by row; 255 is no mask. */
  labels: Uint8Array;
  width: number;
  height: number;
  /** Name of the frame's file. Default: `first.png` of a single frame, of many `00000.png`, `00001.png` … by `index`. */
  image?: string;
  /** Default: the place among the frames, from 0. */
  index?: number;
  /** Default: those of `objects` and `background`. */
  motions?: readonly FormatMotion[];
  /** As a frame of a clip has them. */
  objects?: readonly { id: number; matrix?: Matrix | null }[];
  /** Motion of label 0, as a frame of a clip has it. */
  background?: Matrix | null;
}

/** The frames of a clip in their order. Each is encoded before the next is taken, so that a long clip need not be in memory. */
export type LabelFrames = Iterable<LabelFrame> | AsyncIterable<LabelFrame>;

/** What is known beside the labels, and how they are written. All of it is optional; what a format has no use for has no effect. */
export interface Metadata {
  /** Names by label; default `motion-0`, `motion-1` … Labels with the same name are instances of one class. */
  names?: Readonly<Record<number, string>>;
  /**
   * All classes in the order of their numbers, each once: formats that list classes or number them have these first, also those without
   * a mask, so that they are the same for all files of a data set. Default: those of `labels` or of the masks.
   */
  classes?: readonly string[];
  /** The labels that become masks. Default: all but 0, the background, and 255, which never becomes one. `davis` has all labels. */
  labels?: readonly number[];
  /**
   * Whether labels are the numbers of objects through all frames, which are kept as ids; where ids begin at 1, label 0 becomes 255. Default:
   * true, but false for a single frame. Formats that hold nothing but tracks always keep them.
   */
  tracked?: boolean;
  /** Name of the clip or of its video file; default `clip`. */
  clip?: string;
  /** Frames per second; default from `timestamps`, else 25 in formats that require a rate. */
  frameRate?: number;
  /** Time of each frame in seconds, none below the one before it; default from `frameRate`. */
  timestamps?: readonly number[];
  /**
   * Distance in pixels, in x and in y, by which polygons may deviate from the border to have fewer vertices; default 0: exact. ½ pixel, to
   * which pixels know the border, comes to any other. Masks have the same vertices along a common border. More than 4 million vertices
   * in one document (20 million in one of many frames), which only masks of noise need, reject with `invalid-input`.
   */
  tolerance?: number;
  /** Of `cvat-video`: polygons (the default) or boxes. */
  shape?: 'polygon' | 'box';
  /** Of Label Studio: the names in the project's labelling configuration (default `tag` and `image`). */
  fromName?: string;
  toName?: string;
  /** Of Label Studio: who made the prediction; default `veronese`. */
  modelVersion?: string;
}

/** A file that was made. */
export interface EncodedFile {
  /** Its path, relative and divided by `/`, that stays below the folder where it is written, on every system. */
  name: string;
  content: string | Uint8Array<ArrayBuffer>;
}

/**
 * Masks as the files of an annotation tool, those that `veronese convert` writes: of one frame as of a pair, of many as of a clip. They share no
 * memory with the frames; what is not an async iterable is read before this returns.
 *
 * Rejects with `invalid-option` for the format and the metadata, with `invalid-input` for frames (also one whose name leads elsewhere or is
 * another's, where frames have files of their own, and none at all), and with `frame-size-mismatch` where they differ in size.
 */
export function encode(format: Format, frames: LabelFrame | LabelFrames, metadata?: Metadata): Promise<EncodedFile[]>;

/** A file, or an archive (zip) of some. */
export interface AnnotationFile {
  /** Its path, divided by `/`. */
  name: string;
  bytes: Uint8Array;
}

/** The formats of {@link readAnnotations}: `cvat` is of images or of a video, `png` are masks of any kind, each file a frame. */
export type AnnotationFormat = 'coco' | 'youtube-vis' | 'cvat' | 'label-studio' | 'mots' | 'mots-png' | 'png' | 'yolo';

/** One frame that was annotated. */
export interface AnnotatedFrame {
  width: number;
  height: number;
  /** Draws its labels, anew in each call: 0 is the ground, 255 is unlabelled. Throws what {@link readAnnotations} throws. */
  read(): Uint8Array;
}

export interface Annotations {
  format: AnnotationFormat;
  /** By the names of their files, without folder and extension. */
  frames: Map<string, AnnotatedFrame>;
  /** Of all frames, pixels. */
  size: { width: number; height: number };
  /** Names of the objects, or of their classes, where there are some. */
  names: Record<number, string>;
  /** Objects of which a frame has a box and no mask: prompts for `Clip.annotate`, [first column, first row, width, height]. */
  boxes: { frame: string; object: number; box: [number, number, number, number] }[];
  /** What files were taken for that do not say it themselves, and what was left out. */
  notes: AnnotationNote[];
}

export interface AnnotationNote {
  /** What it is about, in kebab-case: `mask-white`, `mask-colours`, `mask-alpha`, `numbers-changed`, `shapes-left-out`, `file-left-out`,
   * `boxes-taken`, `first-frame-assumed`, `mask-background`, `mots-ignored`. */
  code: string;
  /** A sentence that names the file. */
  message: string;
}

/**
 * What the levels of a mask mean that look smoothed, or compressed with loss: each is an object of its own (`'exact'`), or those from a level
 * on, of the brightest channel, are one object. Where nobody says it such a mask is an error.
 */
export type Levels = 'exact' | number;

export interface AnnotationOptions {
  /** The names of a clip's frames in their order, without extension, for formats that count them (CVAT for video and MOTS); default `00000`, `00001` … */
  frames?: readonly string[];
  /** The size of its frames, for YOLO without the images. */
  size?: { width: number; height: number };
  /** Of PNG masks. */
  levels?: Levels;
  /** The number of the first frame in MOTS as text, where no line has a frame 0. Default: 1. */
  firstFrame?: 0 | 1;
}

/**
 * Reads masks from files of annotation tools, in the formats that {@link encode} writes: annotations for a clip. The format is recognised by
 * the content; pictures beside other annotations are ignored. Throws `invalid-input`, `unreadable-image` or `frame-size-mismatch` with the name
 * of the file, or `invalid-option`.
 */
export function readAnnotations(files: Iterable<AnnotationFile>, options?: AnnotationOptions): Annotations;

/** Labels of one frame, row by row. */
export interface LabelImage {
  labels: Uint8Array;
  width: number;
  height: number;
}

/** A mask in another form than labels. */
export type MaskSource =
  /** A PNG file of up to 8 bits: indices of a palette or grey levels are the labels. */
  | { png: Uint8Array }
  /** COCO's run lengths of one object, compressed or as a list; `id` is its label, default 1. */
  | { rle: { size: readonly [height: number, width: number]; counts: string | readonly number[] }; id?: number }
  /** RGBA pixels, as of an `ImageData`: grey levels, or else colours of the DAVIS palette, whose index is the label. Transparent pixels are 255. */
  | { data: Uint8Array | Uint8ClampedArray; width: number; height: number };

/** Labels of a mask, for `Clip.annotate`. Throws `invalid-input`, `unreadable-image` or `invalid-option`. */
export function readMask(source: MaskSource, options?: { levels?: Levels }): LabelImage;
