// Types of `veronese/formats`: masks in the formats of annotation tools. docs/formats.md describes each format.

import type { Matrix } from './index.js';

/** A motion stored with the masks. The motions of a `Segmentation` fit. */
export interface FormatMotion {
  label: number;
  matrix: Matrix;
  pixels?: number;
  share?: number;
  residual?: number;
  bbox?: [number, number, number, number];
  group?: number;
}

/** Optional information about the labels. */
export interface FormatMeta {
  /** Name of the image that the masks lie on; default `first.png`. */
  image?: string;
  /** Names by label; default `motion-0`, `motion-1` … Labels with the same name are instances of one class. */
  names?: Readonly<Record<number, string>>;
  /**
   * All classes in the order of their numbers, each once: formats that list classes or number them have these first, also those without
   * a mask, so that they are the same for all files of a data set. Default those of the masks.
   */
  classes?: readonly string[];
  /** The motions of the masks. */
  motions?: readonly FormatMotion[];
  /** The labels to write; default all but 255, which never becomes a mask. `encodeDavis`, `encodeFlow` and `encodeVeronese` write all labels. */
  labels?: readonly number[];
}

/** One frame of a video: one label per pixel, row by row. A label stands for the same object in all frames. */
export interface LabelFrame {
  labels: Uint8Array;
  width: number;
  height: number;
  /** Name of the frame's file. */
  image?: string;
  /** The motions from this frame to the next; default those of the `meta`. */
  motions?: readonly FormatMotion[];
}

/** The frames of a clip in their order. Each is encoded before the next is taken, so that a long clip need not be in memory. */
export type LabelFrames = Iterable<LabelFrame> | AsyncIterable<LabelFrame>;

/** The document of frames, or a promise of it if they are an async iterable. */
export type Encoded<Frames extends LabelFrames, Document> = Frames extends AsyncIterable<LabelFrame> ? Promise<Document> : Document;

/** Optional information about a clip. */
export interface ClipMeta extends FormatMeta {
  /** Name of the clip or of its video file; default `clip`. */
  clip?: string;
  /** Frames per second; default from `timestamps`, else 25 in formats that require a rate. */
  frameRate?: number;
  /** Time of each frame in seconds, none below the one before it; default from `frameRate`. */
  timestamps?: readonly number[];
  /**
   * Whether labels are the numbers of objects, to be kept as ids; default false. Where ids begin at 1, label 0 becomes 255. Formats that
   * hold nothing but tracks always keep them.
   */
  tracked?: boolean;
}

export interface FormatOptions<Shape extends string> {
  shape?: Shape;
  /**
   * Distance in pixels, in x and in y, by which polygons may deviate from the border to have fewer vertices; default 0: exact. ½ pixel, to
   * which pixels know the border, comes to any other. Masks have the same vertices along a common border. More than 4 million vertices
   * in one document (20 million in one of many frames), which only masks of noise need, throw `invalid-input`.
   */
  tolerance?: number;
}

export interface CocoRle {
  size: [height: number, width: number];
  counts: string;
}

export interface CocoRleCounts {
  size: [height: number, width: number];
  counts: number[];
}

export interface CocoDocument {
  info: { description: string };
  images: { id: number; file_name: string; width: number; height: number }[];
  categories: { id: number; name: string }[];
  annotations: {
    id: number;
    image_id: number;
    category_id: number;
    iscrowd: 0 | 1;
    area: number;
    bbox: [number, number, number, number];
    segmentation: CocoRle | number[][];
    attributes?: { track_id?: number; matrix?: Matrix };
  }[];
}

export interface CocoVideoDocument {
  info: { description: string };
  videos: { id: number; width: number; height: number; length: number; file_names: string[] }[];
  categories: { id: number; name: string }[];
  annotations: {
    id: number;
    video_id: number;
    category_id: number;
    iscrowd: 0 | 1;
    width: number;
    height: number;
    segmentations: (CocoRle | null)[];
    bboxes: ([number, number, number, number] | null)[];
    areas: (number | null)[];
  }[];
}

export interface CvatShape {
  type: 'mask';
  /** The label's name. Requests to CVAT need the project's `label_id` instead. */
  label: string;
  frame: number;
  occluded: boolean;
  source: 'auto';
  points: number[];
}

export interface LabelStudioResult {
  id: string;
  type: 'brushlabels' | 'polygonlabels';
  from_name: string;
  to_name: string;
  original_width: number;
  original_height: number;
  image_rotation: 0;
  value:
    | { format: 'rle'; rle: number[]; brushlabels: string[] }
    | { points: [number, number][]; closed: true; polygonlabels: string[] };
}

export interface LabelStudioTask {
  data: { image: string };
  predictions: { model_version: string; result: LabelStudioResult[] }[];
}

export interface LabelStudioVideoTask {
  data: { video: string };
  predictions: {
    model_version: string;
    result: {
      id: string;
      type: 'videorectangle';
      from_name: string;
      to_name: string;
      value: {
        framesCount: number;
        /** Seconds. */
        duration: number;
        labels: string[];
        sequence: {
          /** From 1. */
          frame: number;
          /** False where the object is gone in the next frame. */
          enabled: boolean;
          rotation: 0;
          /** Percentages of the width and height. */
          x: number;
          y: number;
          width: number;
          height: number;
          /** Seconds. */
          time: number;
        }[];
      };
    }[];
  }[];
}

/** The text files of a sequence in the formats of MOTChallenge. */
export interface MotFiles {
  /** `gt/gt.txt`: a line for each object in each frame. */
  gt: string;
  /** `seqinfo.ini`. */
  seqinfo: string;
  /** Names of the classes; a class's number is its position, from 1. */
  names: string[];
}

export interface LabelMeShape {
  label: string;
  points: [number, number][];
  group_id: number;
  description: string;
  shape_type: 'mask' | 'polygon';
  flags: Record<string, boolean>;
  mask: string | null;
}

export interface LabelMeDocument {
  version: string;
  flags: Record<string, boolean>;
  shapes: LabelMeShape[];
  imagePath: string;
  imageData: null;
  imageHeight: number;
  imageWidth: number;
}

export interface YoloFiles {
  /** The annotation file: one line per label. */
  text: string;
  /** Names of the classes; the number at the beginning of a line is an index into this list. */
  names: string[];
}

export interface SuperviselyAnnotation {
  description: string;
  tags: never[];
  size: { height: number; width: number };
  objects: {
    classTitle: string;
    geometryType: 'bitmap';
    description: string;
    tags: never[];
    bitmap: { data: string; origin: [number, number] };
  }[];
}

export interface WebAnnotation {
  '@context': string;
  id: string;
  type: 'Annotation';
  body: { type: 'TextualBody'; purpose: 'tagging'; value: string }[];
  target: { source: string; selector: { type: 'SvgSelector'; value: string } };
}

export interface VeroneseDocument {
  format: 'veronese';
  version: 1;
  image: string;
  width: number;
  height: number;
  convention: string;
  motions: FormatMotion[];
  names: Record<number, string>;
  /** Label, length, label, length … row by row. */
  runs: number[];
}

/**
 * COCO's compressed run lengths of one mask; every non-zero pixel is set. Like every call here it throws `invalid-input`, or
 * `invalid-option` for options. Documents are copies and share no memory with their input.
 */
export function encodeCocoRle(mask: Uint8Array, width: number, height: number): CocoRle;

/** The same mask as plain counts. */
export function encodeCocoRleCounts(mask: Uint8Array, width: number, height: number): CocoRleCounts;

/** A COCO instances file with run lengths, or with polygons whose holes are connected by bridges. */
export function encodeCoco(
  labels: Uint8Array,
  width: number,
  height: number,
  meta?: FormatMeta,
  options?: FormatOptions<'rle' | 'polygon'>,
): CocoDocument;

/** A COCO instances file of many images; labels with the same name are one category. Throws `frame-size-mismatch` if they differ in size. */
export function encodeCocoImages<Frames extends LabelFrames>(
  frames: Frames,
  meta?: ClipMeta,
  options?: FormatOptions<'rle' | 'polygon'>,
): Encoded<Frames, CocoDocument>;

/** A YouTube-VIS file. Throws `frame-size-mismatch` if the frames differ in size. */
export function encodeCocoVideo<Frames extends LabelFrames>(frames: Frames, meta?: ClipMeta): Encoded<Frames, CocoVideoDocument>;

/** A CVAT for images 1.1 file. */
export function encodeCvatXml(
  labels: Uint8Array,
  width: number,
  height: number,
  meta?: FormatMeta,
  options?: FormatOptions<'mask' | 'polygon'>,
): string;

/** A CVAT for images 1.1 file of many images. Throws `frame-size-mismatch` if they differ in size. */
export function encodeCvatImages<Frames extends LabelFrames>(
  frames: Frames,
  meta?: ClipMeta,
  options?: FormatOptions<'mask' | 'polygon'>,
): Encoded<Frames, string>;

/**
 * A CVAT for video 1.1 file: one track per label, with one polygon or box for each frame. Bridges join the parts and holes of a polygon.
 * Throws `frame-size-mismatch` if the frames differ in size.
 */
export function encodeCvatVideo<Frames extends LabelFrames>(
  frames: Frames,
  meta?: ClipMeta,
  options?: FormatOptions<'polygon' | 'box'>,
): Encoded<Frames, string>;

/** Shapes for CVAT's REST API and SDK. */
export function encodeCvatPoints(labels: Uint8Array, width: number, height: number, meta?: FormatMeta): CvatShape[];

/**
 * A zip archive in CVAT's MOTS PNG layout, without the frames, with at most 64 labels. Frame names are paths in the archive; a name
 * that would escape it, or that some operating system does not allow, throws `invalid-input`.
 */
export function encodeCvatMots<Frames extends LabelFrames>(frames: Frames, meta?: ClipMeta): Encoded<Frames, Uint8Array>;

/** The text form of MOTS: masks as COCO run lengths, ids 1000 · class + label. At most 64 classes: of a longer list those that labels have. */
export function encodeMots<Frames extends LabelFrames>(frames: Frames, meta?: ClipMeta): Encoded<Frames, MotFiles>;

/** MOTChallenge boxes. Frames, ids and corners count from 1, as that benchmark has it. */
export function encodeMotChallenge<Frames extends LabelFrames>(frames: Frames, meta?: ClipMeta): Encoded<Frames, MotFiles>;

/** A Label Studio task with its predictions. Names must match the project's labelling configuration. */
export function encodeLabelStudio(
  labels: Uint8Array,
  width: number,
  height: number,
  meta?: FormatMeta,
  options?: FormatOptions<'brush' | 'polygon'> & { fromName?: string; toName?: string; modelVersion?: string },
): LabelStudioTask;

/** A Label Studio task with boxes on a video, a key frame wherever an object is. */
export function encodeLabelStudioVideo<Frames extends LabelFrames>(
  frames: Frames,
  meta?: ClipMeta,
  options?: { fromName?: string; toName?: string; modelVersion?: string },
): Encoded<Frames, LabelStudioVideoTask>;

/** A LabelMe file. */
export function encodeLabelMe(
  labels: Uint8Array,
  width: number,
  height: number,
  meta?: FormatMeta,
  options?: FormatOptions<'mask' | 'polygon'>,
): LabelMeDocument;

/**
 * YOLO segmentation: one line per label; bridges join parts and holes. `classes` gives the names in the order of their numbers, which
 * all images of a data set share; default those of the `meta`, then the names that are there.
 */
export function encodeYolo(
  labels: Uint8Array,
  width: number,
  height: number,
  meta?: FormatMeta,
  options?: { tolerance?: number; classes?: readonly string[] },
): YoloFiles;

/** An 8-bit indexed PNG whose index is the label, in the DAVIS palette. */
export function encodeDavis(labels: Uint8Array, width: number, height: number): Uint8Array;

/**
 * The flow field of the labels' motions, 32-bit floats u and v of each pixel, row by row: `flo` as the Middlebury benchmark has it (the default),
 * or `npy`, NumPy's, of shape (height, width, 2). Pixels whose label has no motion are unknown: 1e10 there, NaN here.
 */
export function encodeFlow(labels: Uint8Array, width: number, height: number, meta?: FormatMeta, options?: { shape?: 'flo' | 'npy' }): Uint8Array;

/** A Supervisely annotation with bitmaps. */
export function encodeSupervisely(labels: Uint8Array, width: number, height: number, meta?: FormatMeta): SuperviselyAnnotation;

/** W3C Web Annotations, one per label, with an SVG selector. */
export function encodeWebAnnotation(
  labels: Uint8Array,
  width: number,
  height: number,
  meta?: FormatMeta,
  options?: { tolerance?: number },
): WebAnnotation[];

/** Stores labels, names and motions without loss. */
export function encodeVeronese(labels: Uint8Array, width: number, height: number, meta?: FormatMeta): VeroneseDocument;

/** Reads a document of {@link encodeVeronese}. Throws `invalid-input` for anything else. */
export function decodeVeronese(document: unknown): LabelFrame & { meta: FormatMeta };

/** A file, or an archive (zip) of some. */
export interface AnnotationFile {
  /** Its path, divided by `/`. */
  name: string;
  bytes: Uint8Array;
}

/** The formats of {@link readAnnotations}: `cvat` is of images or of a video, `png` are masks of any kind, each file a frame. */
export type AnnotationFormat = 'coco' | 'youtube-vis' | 'cvat' | 'labelme' | 'label-studio' | 'datumaro' | 'mots' | 'mots-png' | 'png' | 'supervisely' | 'veronese' | 'yolo';

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
  /** Objects of which a frame has a box and no mask: prompts for `segmentClip`, [first column, first row, width, height]. */
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

export interface AnnotationOptions {
  /** The names of a clip's frames in their order, without extension, for formats that count them (CVAT for video and MOTS); default `00000`, `00001` … */
  frames?: readonly string[];
  /** The size of its frames, for YOLO without the images. */
  size?: { width: number; height: number };
  /**
   * What levels mean that look smoothed, or compressed with loss, in PNG masks: each is an object of its own (`'exact'`), or those from a level on,
   * of the brightest channel, are one object. Without it such a mask is an error.
   */
  levels?: 'exact' | number;
  /** The number of the first frame in MOTS as text, where no line has a frame 0. Default: 1. */
  firstFrame?: 0 | 1;
}

/**
 * Reads masks from files of annotation tools, in the formats that the encoders write: corrections for `segmentClip`. The format is
 * recognised by the content; pictures beside other annotations are ignored. Throws `invalid-input`, `unreadable-image` or
 * `frame-size-mismatch` with the name of the file.
 */
export function readAnnotations(files: Iterable<AnnotationFile>, options?: AnnotationOptions): Annotations;
