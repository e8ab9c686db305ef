// The public types, written by hand. Callers may rely on everything in this file.

/**
 * RGBA bytes, row by row. An `ImageData` fits. Sides from 16 to 4096 pixels.
 *
 * The bytes stay the caller's: a call copies them before it returns, so you may overwrite them afterwards. They may be a view of a
 * larger buffer (only the view is copied), or shared or resizable memory (copied in its state at that moment).
 */
export interface Pixels {
  data: Uint8ClampedArray | Uint8Array;
  width: number;
  height: number;
}

/**
 * In Node, an image file in place of its pixels: its path, its address, a `Blob`, or a stream of its bytes, such as a `Readable` or the body of a
 * response. Read as `veronese/codecs` does. Elsewhere code `invalid-input`, but for a `Blob`.
 */
export type FrameFile = string | URL | BlobLike | AsyncIterable<Uint8Array>;

/**
 * In browsers and their workers, a picture in place of its pixels: an `ImageBitmap`, a `VideoFrame`, an image file as a `Blob` or `File`, an
 * `HTMLImageElement`, an `HTMLCanvasElement` or an `OffscreenCanvas`. It is copied before the call returns, so you may close it afterwards. One
 * that is closed is refused with code `invalid-input`, one that cannot be decoded or read with code `unreadable-image`.
 */
export type FramePicture = BlobLike | ImageBitmapLike | VideoFrameLike | ImageLike | CanvasLike;

/** A frame that is segmented. */
export type FrameInput = Pixels | FrameFile | FramePicture;

/** The part of a `Blob` that tells it from others, without depending on the types of the DOM or Node. */
export interface BlobLike {
  readonly size: number;
  readonly type: string;
  arrayBuffer(): Promise<ArrayBuffer>;
}

/** The same of an `ImageBitmap`. */
export interface ImageBitmapLike {
  readonly width: number;
  readonly height: number;
  close(): void;
}

/** The same of a `VideoFrame`. */
export interface VideoFrameLike {
  readonly displayWidth: number;
  readonly displayHeight: number;
  close(): void;
}

/** The same of an `HTMLImageElement`. */
export interface ImageLike {
  readonly naturalWidth: number;
  readonly naturalHeight: number;
  decode(): Promise<void>;
}

/** The same of an `HTMLCanvasElement` or an `OffscreenCanvas`. */
export interface CanvasLike {
  width: number;
  height: number;
  getContext(kind: '2d'): object | null;
}

/** Progress of a call: a stage has just begun. */
export interface Progress {
  /** The stage's stable camelCase name, also its key in `milliseconds`. */
  stage: string;
  /** Index of the stage in this call, from 0. */
  index: number;
  /** Number of stages of this call. */
  of: number;
}

/** Options of every call. */
export interface CallOptions {
  /**
   * Cancels the call, which then rejects with code `cancelled`. A {@link Segmenter} stops at once. A direct call occupies its thread
   * and checks the signal between stages.
   */
  signal?: AbortSignal | undefined;
  /** Called when a stage begins. If it throws, the call ends with that exception. */
  onProgress?: ((progress: Progress) => void) | undefined;
  /**
   * Transfers the arrays instead of copying them; default `false`. When the call returns, the whole `ArrayBuffer`s of the frames,
   * the measurements and the evidence are detached and their arrays are empty, whatever the outcome. A call leaves them alone only if
   * it rejects its arguments or is already cancelled. Segmentations are never transferred. Memory that cannot be transferred is copied:
   * shared memory, the memory of a WebAssembly module, and the pools of Node's `Buffer`.
   */
  transfer?: boolean | undefined;
}

export interface SegmentOptions extends CallOptions {
  /** Number of motions, 1 to 10; `'auto'` (the default) estimates it. */
  motions?: 'auto' | number | undefined;
  /** `'best'` (the default) for accuracy, `'fast'` for live use. */
  quality?: 'fast' | 'best' | undefined;
  /**
   * Uses label 255 for a pixel that is hidden or outside in the second frame, has no texture around it, or whose label would more
   * likely be wrong than right; default `false`.
   */
  markUnknown?: boolean | undefined;
  /**
   * Takes the main subject for the one object, as for a cut-out, and all else for ground: what else moves is not told apart from it. Of a
   * pair, `group` is then 1 for its motions. Default `false`.
   */
  subject?: boolean | undefined;
  /** Adds `confidence` to the result: how sure the label of every pixel is; default `false`. */
  confidence?: boolean | undefined;
  /**
   * Scales larger frames down so that their longest side has so many pixels, 16 to 4096. They may then have sides up to 16384; without it,
   * sides above 4096 are the error `frame-size-unsupported`. All that goes in and comes out besides (labels, boxes, motions, masks, corrections) is
   * in pixels of the scaled frames, whose size the result says.
   */
  maxSize?: number | undefined;
}

export interface FitOptions extends CallOptions {
  /** Number of motions, 1 to 10; `'auto'` (the default) estimates it. */
  motions?: 'auto' | number | undefined;
  /** `'paper'`: the algorithm of the paper; `'best'` (the default): ours. */
  method?: 'paper' | 'best' | undefined;
  /** Random seed, a whole number from 0; default 1. */
  seed?: number | undefined;
}

/**
 * `[a11, a12, a13, a21, a22, a23]`: the pixel (x, y) of the first frame is displaced by u = a11·x + a12·y + a13,
 * v = a21·x + a22·y + a23 pixels in the second. (0, 0) is the centre of the top-left pixel, x right, y down.
 */
export type Matrix = [number, number, number, number, number, number];

/** Milliseconds of the whole call and of each of its stages. */
export interface Milliseconds {
  total: number;
  [stage: string]: number;
}

/** A candidate number of motions; a smaller score is better. */
export interface Candidate {
  motions: number;
  score: number;
}

/** One motion of a {@link Segmentation}. */
export interface SegmentedMotion {
  label: number;
  matrix: Matrix;
  /** Number of its pixels. */
  pixels: number;
  /** Their share of all pixels, 0 to 1. */
  share: number;
  /** Root mean square of the motion-compensated intensity difference over its pixels, in grey levels (0 to 255). */
  residual: number;
  /** Bounding box of its pixels: x, y, width, height. */
  bbox: [number, number, number, number];
  /** Motions of one rigid background share a group; group 0 has the most pixels. */
  group: number;
}

/** The common border of two motions of a {@link Segmentation}. */
export interface Junction {
  /** The labels of the two motions, the smaller first. */
  labels: [number, number];
  /**
   * Probability, 0 to 1, that the two motions are of one thing: one object, or one background. Groups also depend on whether the flow is
   * continuous; where the probability is in between, ask a person.
   */
  likelihood: number;
  /** Length of the border in pixels of the frame, measured at the working size. */
  border: number;
}

/** What was assumed of what was given, or why nothing was found. */
export interface Note {
  /**
   * In kebab-case; where no object or one motion was found `no-contrast`, `cut`, `no-motion`, `small-steps` or `one-motion`; `object-is-ground`
   * of an object of a clip that is likely to be none; `object-missing` where edits name numbers that no object has.
   */
  code: string;
  /** A sentence. */
  message: string;
  /** Of `small-steps`, where it is known: every frame of this number alone would show more. */
  step?: number;
}

/** The result of {@link segmentPair}: plain data, nothing to free. */
export interface Segmentation {
  version: 1;
  width: number;
  height: number;
  /** Number of motions. */
  count: number;
  /** By decreasing number of pixels: `motions[i].label === i`. */
  motions: SegmentedMotion[];
  /** Neighbouring motions, by labels. Borders of a few pixels are left out. */
  junctions: Junction[];
  /**
   * Description lengths of both frames in nats, from one motion to one more than were found, each with its own labels. The number
   * found need not have the smallest score, because the stages decide in sequence and not by this list alone.
   */
  evidence: { candidates: Candidate[] };
  /** Number of pixels with label 255. */
  unlabelled: number;
  milliseconds: Milliseconds;
  settings: {
    motions: 'auto' | number;
    quality: 'fast' | 'best';
    markUnknown: boolean;
    subject: boolean;
    software: string;
  };
  /** Where there is one motion and more were possible: why. */
  notes?: Note[];
  /** One label per pixel, row by row; 255 is unlabelled. */
  labels: Uint8Array;
  /**
   * Only with `confidence: true`: the confidence of every pixel's label, row by row. It is 255 times the probability that its motion
   * is the right one, given how well all motions explain the pixel and its surroundings. Of an object (any group but that of the
   * background) it is the probability that it is one, and not a part of the background at another depth. The probabilities are
   * calibrated on real pairs and generated scenes: of the pixels with probability P, a share of about P is right. 0 for unlabelled pixels.
   */
  confidence?: Uint8Array;
}

/** One motion of a {@link MotionFit}. */
export interface FittedMotion {
  label: number;
  matrix: Matrix;
  /** Number of measurements that belong to it. */
  measurements: number;
  /** How many of the six parameters the measurements determine; below 6, the others are arbitrary. */
  determined: number;
}

/** The result of {@link fitMotions}. */
export interface MotionFit {
  version: 1;
  /** Number of motions. */
  count: number;
  /** By decreasing number of measurements: `motions[i].label === i`. */
  motions: FittedMotion[];
  evidence: { singularValues: number[]; candidates: Candidate[] };
  /** Results of the paper's steps; only with `method: 'paper'`. */
  stages?: { factorisation: Matrix[]; refined: Matrix[] };
  milliseconds: Milliseconds;
  settings: { motions: 'auto' | number; method: 'paper' | 'best'; seed: number; software: string };
  /** One label per measurement, in input order; 255 is an outlier. */
  labels: Uint8Array;
}

/**
 * Image measurements: x, y of each in `positions`, I_x, I_y, I_t of each in `derivatives`. Copied before a call returns, like {@link
 * Pixels}.
 */
export interface PointMeasurements {
  positions: Float64Array;
  derivatives: Float64Array;
}

/**
 * The frames of a clip, all of one size, in order. An iterable or async iterable is a stream: the next frame is asked for while one is worked
 * on, and may reuse its buffer. `{ length, read(index) }` is a whole clip: each frame is read for its pairs, then for its labels, and
 * in any order for corrections, and must be the same each time; some are read once more to say why nothing was found. An array is a stream
 * unless an option needs a whole clip.
 */
export type ClipSource =
  | Iterable<FrameInput | Promise<FrameInput>>
  | AsyncIterable<FrameInput>
  | { readonly length: number; read(index: number): FrameInput | Promise<FrameInput> };

/** Progress of a clip: work on a frame begins. */
export interface ClipProgress {
  /** Index of the frame, from 0. */
  frame: number;
  /** Number of frames, if the source has a `length`. */
  of: number | undefined;
  /**
   * The work that begins. A stream has the stage `pairs` alone. A whole clip has `pairs` for all frames, `corrections` for those that
   * corrections reach, and `labels` for all frames as they are returned.
   */
  stage: 'pairs' | 'corrections' | 'labels';
}

/** Where the annotations of a frame spread: to the frames before and after it, to one side alone, or nowhere. */
export type ClipPropagation = 'both' | 'forward' | 'backward' | 'none';

/** Labels of one frame of a clip that a person is certain of. */
export interface ClipCorrection {
  /** Index of the frame, from 0. Each frame has one correction of each object at most, and one label map. */
  frame: number;
  /**
   * The object that it is about, 1 to 254, and no other. Without it the labels are a map: it is about the objects that it names,
   * and its zeros are where none of these is. A map of 0 and 255 alone is an eraser: at its zeros there is no object.
   */
  object?: number | undefined;
  /** Default: that of a label map or mask of the frame, otherwise `'both'`. */
  propagate?: ClipPropagation | undefined;
  /**
   * One label per pixel, row by row: the number of an object, a number that no object has for a new object, 0 where none of the objects is
   * that it is about, or 255 where nothing is certain. With `object` there are the labels 0, 255 and its number; without 255, as of an
   * outline, they are its mask, to the pixel. It replaces what was painted in the frame of the same object, or as a map; one that is 255
   * everywhere takes it back.
   */
  labels: Uint8Array;
}

/** A pixel, and whether it belongs to the object: 1 if it does, -1 if not. */
export type ClipClick = readonly [x: number, y: number, sign: 1 | -1];

/**
 * Points to an object in one frame of a clip: its mask there is found at once, and the object is followed through the clip. Clicks and a box
 * together describe one object; it needs a box or a click that is its own. A prompt stays one: the next of the same object and frame
 * replaces it, and one without clicks and box takes it back. It is about no other object.
 */
export type ClipPrompt = {
  /** Index of the frame, from 0. Each frame has one prompt of each object at most. */
  frame: number;
  /** Default: that of a label map or mask of the frame, otherwise `'both'`. */
  propagate?: ClipPropagation | undefined;
} & (
  | {
      /** The number of the object, 1 to 254; one that no object has makes a new object. */
      object: number;
      /**
       * Pixels that belong to the object or do not; those that do are in the box, if there is one. In this order each adds the part around
       * it to the mask, or takes it away, unless the mask is as it says already.
       */
      clicks?: readonly ClipClick[] | undefined;
      /** First column, first row, width and height of a rectangle that has all of the object, pixels. */
      box?: readonly [x: number, y: number, width: number, height: number] | undefined;
    }
  // in short
  | {
      /** The number of the object. */
      label: number;
      box: readonly [x: number, y: number, width: number, height: number];
    }
  | {
      /** The number of the object. */
      label: number;
      /** Column and row of a pixel of the object. */
      click: readonly [x: number, y: number];
    }
);

/** A frame that a person finds right: its index, or with all its labels as the person saw them, one per pixel, row by row. */
export type ClipAccepted = number | { frame: number; labels?: Uint8Array | undefined };

/**
 * Given masks of one frame of a clip, with numbers of your own: those of all objects in an image of labels, or that of one object. A frame
 * may have several of single objects; a later one covers an earlier one, and what is in none of them is background.
 */
export type ClipMask = {
  /** Index of the frame, from 0. */
  frame: number;
  /** Default: `'both'`; the last one of a frame counts. */
  propagate?: ClipPropagation | undefined;
} & (
  | {
      /**
       * One label per pixel, row by row: 0 for the background, 1 to 254 for an object, 255 where it is unlabelled. Or a picture, such as
       * `ImageData`: if all its pixels are grey, the grey level is the label; otherwise all colours must be of the DAVIS palette
       * ({@link davisPalette}), and their index is the label, the lower one where there are two. Fully transparent pixels are unlabelled.
       */
      labels: Uint8Array | Pixels;
    }
  | {
      /** A PNG file whose samples are labels: indexed or grey, of up to 8 bits. */
      png: Uint8Array;
    }
  | {
      /** Number of the object, 1 to 254. */
      id: number;
      /** Its run lengths as COCO has them: `size` is height and width, `counts` are compressed or a list. */
      rle: { size: readonly [height: number, width: number]; counts: string | readonly number[] };
    }
);

/**
 * Changes of whole objects. Numbers that no object has change nothing, and are in a note (`object-missing`); a list that begins with one merges
 * nothing.
 */
export interface ClipEdits {
  /** Lists of objects that are one; the first number is kept. */
  merge?: readonly (readonly number[])[] | undefined;
  /** Objects that are none: they become background, and take no pixel of others. */
  delete?: readonly number[] | undefined;
  /** The same as `delete`. */
  background?: readonly number[] | undefined;
  /**
   * Names by number, for {@link ClipTrack.name}. A name protects an object: annotations of others do not change its pixels. Where this is
   * given, it replaces the names of a `state`.
   */
  names?: Readonly<Record<number, string>> | undefined;
  /** As the option `locked`. */
  locked?: readonly number[] | undefined;
}

/** Options of {@link segmentClip}; `motions` is the number of motions in each pair of consecutive frames. */
export interface ClipOptions extends Omit<SegmentOptions, 'confidence' | 'onProgress'> {
  /** Gives the label 255 to pixels whose evidence does not tell an object from the background. Default: false. */
  markUnknown?: boolean | undefined;
  /**
   * Number of frames that each frame waits for, 0 to 8, or `'all'`: as many as matter, of a whole clip. More frames give better masks.
   * Default: 8 for a stream, `'all'` for a whole clip. A number makes a stream of `{ length, read(index) }`, unless one of the options
   * below is given: they need a whole clip.
   */
  lookAhead?: number | 'all' | undefined;
  /**
   * Masks of objects in some frames, with numbers of your own: they hold there to the pixel, and the objects keep their numbers and are
   * followed through the clip. They take over what was found of them; what was found under one of their numbers gets the lowest free one.
   * `corrections`, `edits` and `locked` have the numbers that result.
   */
  masks?: readonly ClipMask[] | undefined;
  /**
   * Labels painted in some frames, with the numbers of an earlier run. It holds there to the pixel, and the objects that it is about are
   * followed from there through the clip. All count together, in any order. A correction of a frame that has a mask goes before it where it
   * says anything.
   *
   * Nothing that a person painted, gave, prompted, named, accepted or locked changes when something else is said; an object that was found
   * automatically changes by the pixels that another one takes from it or gives back.
   */
  corrections?: readonly (ClipCorrection | ClipPrompt)[] | undefined;
  /** Clicks and boxes that point to objects in some frames, after what is painted. They may be among the corrections as well. */
  prompts?: readonly ClipPrompt[] | undefined;
  /**
   * Frames that are right. From then on only what is painted or pointed to in such a frame changes labels there, and the objects in it are
   * followed from it as from a correction. Without `labels` a frame has those of now: as masks and a `state` have it, before corrections. Where
   * this is given, it replaces what a `state` has accepted; frames that stay accepted stay as they are.
   */
  accepted?: readonly ClipAccepted[] | undefined;
  /** Changes of whole objects, after the corrections. */
  edits?: ClipEdits | undefined;
  /**
   * Numbers of objects of which nothing changes a pixel, but annotations of themselves in the same call. New annotations of an object that the
   * `state` has locked are the error `object-locked`, and so it is to delete it or to merge it. Where this or that of the edits is
   * given, it replaces what a `state` has locked.
   */
  locked?: readonly number[] | undefined;
  /**
   * The bytes that {@link Clip.state} gave for the same frames. No pair is solved: frames are read for their labels and for corrections alone, and
   * `motions`, `quality`, `subject` and `lookAhead` are those of the state. Annotations stay until they are replaced or taken back;
   * corrections refer to the numbers before any edit, and edits stay. Bytes that are damaged or of another version
   * of this package are an `invalid-option`, as is a frame that has other pixels than the one that was segmented, when it is read.
   */
  state?: Uint8Array | undefined;
  /** Returns only the frames that `masks`, `corrections`, `prompts`, `accepted` and `edits` change. Default: false. */
  changesOnly?: boolean | undefined;
  /**
   * Called with the index of each frame that masks, corrections, prompts and edits change, as soon as they do: the annotated frame first, then
   * those to which it spreads. A frame may change again before it is returned; the clip returns frames in order, afterwards. `segmented`
   * gives the frame as it is now, until what the call returns is settled, and the clip waits for that. If it throws, the clip ends with that
   * exception.
   */
  onChange?: ((frame: number, segmented: () => Promise<ClipFrame>) => void | Promise<void>) | undefined;
  /**
   * Called with the results of the pairs of each frame, nearly all the work, as bytes. Kept and handed back by `knownPairs` they let a run
   * that was interrupted continue with the same results. Several workers solve frames in any order; calls may then overlap.
   */
  onPairs?: ((index: number, pairs: Uint8Array) => void | Promise<void>) | undefined;
  /**
   * Gives what `onPairs` was called with, if it is known. Bytes that are damaged, of another version of this package, or of other options,
   * another frame or other frames before it count as unknown. Asked when a frame is read, which may be some frames ahead.
   */
  knownPairs?: ((index: number) => Uint8Array | undefined | Promise<Uint8Array | undefined>) | undefined;
  /**
   * Called with each frame but the last as soon as its pairs are solved: the masks that they tell alone, to show while the clip is
   * segmented. They lack the evidence of other frames, and their objects may get other numbers. Each takes the time of its labels.
   */
  onPreview?: ((frame: ClipFrame) => void | Promise<void>) | undefined;
  /** `true`: frames are transferred; those of a whole clip only when they are read for their labels. See {@link CallOptions}. */
  transfer?: boolean | undefined;
  /** Called for each frame before work on it begins. If it throws, the clip ends with that exception. */
  onProgress?: ((progress: ClipProgress) => void) | undefined;
}

/** An object in one frame of a clip. */
export interface ClipObject {
  /** 1 to 254, the same in all frames. */
  id: number;
  /** Number of its pixels. */
  pixels: number;
  /** Bounding box of its pixels: x, y, width, height. */
  bbox: [number, number, number, number];
  /** Mean probability that its pixels belong to an object, 0 to 1. */
  confidence: number;
  /** Motion of its largest part to the next frame; null if there is none. In a stream, its motion from the frame before, continued. */
  matrix: Matrix | null;
}

/** One frame of a clip, segmented. */
export interface ClipFrame {
  /** Index of the frame, from 0. */
  index: number;
  /** One label per pixel, row by row: 0 for the background, 255 for a pixel marked as unknown, otherwise the number of an object. */
  labels: Uint8Array;
  width: number;
  height: number;
  /** The visible objects by number. */
  objects: ClipObject[];
  /** Motion of the background to the next frame; null if there is none. In a stream, its motion from the frame before, continued. */
  background: Matrix | null;
}

/** One object through a clip. */
export interface ClipTrack {
  id: number;
  /** As in {@link ClipEdits}. */
  name?: string;
  /** Index of the first frame that shows it. */
  first: number;
  /** Index of the last frame that shows it. */
  last: number;
  /** One entry for each frame that shows it. */
  frames: ({ frame: number } & Omit<ClipObject, 'id'>)[];
}

/** The objects and the background of a clip, from {@link Clip.tracks}. */
export interface ClipTracks {
  /** By number, which is the order of appearance. */
  objects: ClipTrack[];
  /** Motion of the background from a frame to the next one, where there is one. */
  background: { frame: number; matrix: Matrix }[];
  /** Number of objects beyond 254, which count as background. Known when the clip is finished. */
  dropped: number;
  /** Of a finished clip: which edits change nothing; without annotations also why there are no objects, or which of them are likely to be none. */
  notes?: Note[];
}

/** Pixels of an object in a frame that annotations have changed. */
export interface ClipChange {
  /** Index of the frame, from 0. */
  frame: number;
  /** The number of the object, 0 for the background. */
  object: number;
  /** Number of pixels that it has now and had not. */
  gained: number;
  /** Number of pixels that it had and has no more. */
  lost: number;
}

/**
 * The frames of a clip, in order, as they are finished. Leaving the loop or calling `return()` frees what the clip holds, some megabytes
 * and its worker. An iterator that is dropped before its end does so when it is collected as garbage; its source is not closed then.
 */
export interface Clip extends AsyncGenerator<ClipFrame, void, undefined> {
  /** The objects of the frames returned so far: complete after the last frame, whose objects have no matrix. */
  tracks(): ClipTracks;
  /**
   * A whole clip as bytes, corrections and edits included, for the option `state`: some kilobytes per frame, for the same version of this
   * package. Undefined before the first frame has been returned, and for a stream.
   */
  state(): Promise<Uint8Array | undefined>;
  /**
   * The changes by masks, corrections, prompts and accepted labels, by frame, then by object, with the numbers before any edit; edits are not
   * counted. Empty before the first frame has been returned, and for a stream.
   */
  changes(): Promise<ClipChange[]>;
}

/** The source of the WebAssembly module. */
export type WasmSource = URL | string | Response | ArrayBuffer | ArrayBufferView | WebAssembly.Module;

/** The stable error codes, the same as on the command line. */
export type ErrorCode =
  // the input
  | 'frame-size-mismatch'
  | 'frame-size-unsupported'
  | 'pixel-count-mismatch'
  | 'measurement-count-mismatch'
  | 'too-few-measurements'
  | 'not-finite'
  | 'invalid-option'
  | 'invalid-input'
  | 'object-locked' // a new annotation of a locked object of a clip
  | 'unreadable-image'
  // the environment
  | 'wasm-load-failed'
  | 'worker-failed'
  | 'worker-busy'
  | 'cancelled'
  | 'internal'
  // the custom element and the command line
  | 'unreadable-video'
  | 'too-few-frames'
  // the command line only
  | 'usage'
  | 'wrong-usage' // of an option that the command does not have
  | 'file-not-found'
  | 'unreadable-file'
  | 'invalid-json'
  | 'write-failed'
  | 'file-exists'
  | 'pairs-failed'
  | 'ffmpeg-missing';

/**
 * Every error that this package throws or rejects with. Exceptions from the caller's own listeners and sources of pairs are passed on
 * unchanged.
 */
export class VeroneseError extends Error {
  constructor(code: ErrorCode, message: string, options?: ErrorOptions);
  readonly code: ErrorCode;
}

/** Version of the package. */
export const version: string;

/**
 * Loads the WebAssembly module of all calls except {@link fitMotions}. Every call does so itself; call this to load early or from your
 * own source. Further calls have no effect: the first source that loaded stays.
 *
 * Rejects with code `wasm-load-failed`; a later call tries again.
 */
export function init(source?: WasmSource | Promise<WasmSource>): Promise<void>;

/** {@link init} for the module of {@link fitMotions}, `veronese/veronese_points_bg.wasm`, which no other call needs. */
export function initPoints(source?: WasmSource | Promise<WasmSource>): Promise<void>;

/**
 * Segments two frames by motion: how many motions there are, what each one is, and which pixels follow it. To correct masks, segment the two
 * frames as a clip ({@link segmentClip}), which takes corrections.
 */
export function segmentPair(first: FrameInput, second: FrameInput, options?: SegmentOptions): Promise<Segmentation>;

/**
 * Segments a clip: objects that move get a number that they keep from their first frame to their last. Objects are numbered by first
 * appearance, then by size, then by their topmost, leftmost pixel.
 *
 * A stream returns a frame when the frames it waits for have come (`lookAhead`), the rest at the end. A whole clip, with
 * `{ length, read(index) }`, solves all pairs before it returns the first frame, and takes corrections. Frames are taken from the source
 * only when the reader waits for one, and one more while the last is worked on, so that decoding and segmenting overlap. If the source
 * throws or a frame is unusable, the frames before it come first, then the error. Fewer than two frames are the error `too-few-frames`, but for
 * a look-ahead of 0: a camera may be turned off at any time.
 *
 * The call occupies its thread while it works on a frame; `signal` is checked between frames. Another direct call that fails inside the
 * module or is cancelled there in the meantime takes the clip with it, which then rejects with code `internal`; a {@link Segmenter} keeps
 * its clip.
 */
export function segmentClip(frames: ClipSource, options?: ClipOptions): Clip;

/** Solves the paper's Problem 1 on your own measurements. */
export function fitMotions(measurements: PointMeasurements, options?: FitOptions): Promise<MotionFit>;

/** Replaces each pixel's label with its group number; 255 stays. Throws code `invalid-input`. */
export function groupLabels(segmentation: Pick<Segmentation, 'labels' | 'motions'>): Uint8Array;

/** The 256 colours of the DAVIS benchmark's masks; label 0 is black. */
export function davisPalette(): [number, number, number][];

/**
 * Two frames. Other properties of the object come back with its outcome. The frames are copied (or transferred, with `transfer`) before the
 * next input is requested, so a source may reuse one set of buffers for all pairs.
 */
export interface PairInput {
  first: FrameInput;
  second: FrameInput;
}

/** Options of {@link segmentPairs} for all pairs. */
export interface PairsOptions extends Omit<SegmentOptions, 'onProgress'> {
  /** Called when a stage of a pair begins; `pair` counts from 0. If it throws, that pair fails with the exception as `cause`. */
  onProgress?: ((progress: Progress & { pair: number }) => void) | undefined;
}

/** The outcome of one pair: a segmentation or an error. An error does not affect the other pairs. */
export type PairOutcome<Input extends PairInput = PairInput> =
  | { index: number; input: Input; segmentation: Segmentation; error?: undefined }
  | { index: number; input: Input; error: VeroneseError; segmentation?: undefined };

/** The common part of the browser's and Node's `Worker`, without depending on either's types. */
export interface WorkerLike {
  postMessage(message: unknown): void;
  terminate(): unknown;
}

export interface SegmenterOptions {
  /**
   * Creates the worker, if the bundler or the page requires it: a module worker (in Node a worker thread) that runs `veronese/worker`.
   * By default the package uses the file next to its code.
   */
  worker?: (() => WorkerLike) | undefined;
  /** As in {@link initPoints}; used on the first call of `fitMotions`. */
  points?: WasmSource | Promise<WasmSource> | undefined;
}

export interface PoolOptions extends SegmenterOptions {
  /** Number of workers, 1 to 256; default: the number of processors. */
  jobs?: number | undefined;
  /** As in {@link init}; compiled once for all workers. */
  source?: WasmSource | Promise<WasmSource> | undefined;
}

/**
 * Makes the same calls in a Web Worker, or in a worker thread under Node. The page stays responsive, and a cancelled call stops at
 * once. Calls run one after another.
 */
export class Segmenter {
  /** `source` as in {@link init}; default: the file next to the package's code. Throws code `invalid-option`. */
  constructor(source?: WasmSource | Promise<WasmSource>, options?: SegmenterOptions);
  segmentPair(first: FrameInput, second: FrameInput, options?: SegmentOptions): Promise<Segmentation>;
  fitMotions(measurements: PointMeasurements, options?: FitOptions): Promise<MotionFit>;
  /**
   * As {@link segmentClip}. The worker keeps the clip from the first frame to the last; a second clip waits for that, other calls run
   * between the frames. A cancelled clip stops at once; its worker stays.
   */
  segmentClip(frames: ClipSource, options?: ClipOptions): Clip;
  /**
   * Starts the worker and segments small built-in pairs in it for half a second, so that the engine fully compiles the hot code. Without
   * it, a first call takes several times as long as later ones. One worker warms up for all instances of the module on the page. Another
   * call to the same worker ends it (the promise resolves then), and so does `close()`; a good moment is before frames are decoded.
   */
  warmUp(): Promise<void>;
  /** Ends the worker; running calls reject with code `cancelled`. The next call starts a new worker. */
  close(): void;
}

/**
 * Several workers. Modules are compiled once and instantiated in each worker. Calls start in order and can be cancelled individually;
 * workers are started on demand.
 */
export class SegmenterPool extends Segmenter {
  /** Throws code `invalid-option`. */
  constructor(options?: PoolOptions);
  readonly jobs: number;
  /**
   * As {@link Segmenter.segmentClip}. One worker keeps the clip; the pairs of a whole clip with `lookAhead: 'all'` are solved by all
   * workers that have nothing else to do, some frames ahead, and those end afterwards. The results are the same to the bit with any number
   * of workers.
   */
  segmentClip(frames: ClipSource, options?: ClipOptions): Clip;
  /**
   * Segments many pairs and yields their outcomes in order. At most 2·`jobs` pairs are running or waiting to be fetched, so an async
   * generator that reads frames runs no faster than the workers. A failed pair yields an outcome with `error`, and the iteration
   * continues. `signal` ends everything with code `cancelled`, and so does leaving the loop. If `pairs` throws, the exception follows
   * the outcomes of the pairs it had yielded.
   */
  segmentPairs<Input extends PairInput>(
    pairs: Iterable<Input | Promise<Input>> | AsyncIterable<Input>,
    options?: PairsOptions,
  ): AsyncGenerator<PairOutcome<Input>, void, undefined>;
}

/** {@link SegmenterPool.segmentPairs} with its own pool, which ends with the iterator. */
export function segmentPairs<Input extends PairInput>(
  pairs: Iterable<Input | Promise<Input>> | AsyncIterable<Input>,
  options?: PairsOptions & PoolOptions,
): AsyncGenerator<PairOutcome<Input>, void, undefined>;

// Names of the platform that stand above. Where its own types are loaded, this adds nothing to them. Where they are not (`lib` without DOM,
// no types of Node), it lets a program compile.
declare global {
  interface AbortSignal {}
  interface Response {}
  interface URL {
    href: string;
  }
  namespace WebAssembly {
    interface Module {}
  }
}
