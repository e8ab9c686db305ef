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
 * The frames of a clip, all of one size: a list, or how many there are and a function that reads any of them. Frames are read more than once,
 * in any order, also one while another is read, and must be the same each time.
 */
export type ClipFrames = readonly FrameInput[] | { readonly length: number; read(index: number): FrameInput | Promise<FrameInput> };

/** Options of {@link openClip}. */
export interface OpenOptions {
  /**
   * Where the clip is kept while it is changed, so that nothing is lost if the program ends: in Node the path of a file, elsewhere a name in the
   * page's own storage (IndexedDB), or a place of your own. If there is a clip already, it is opened. Only one clip at a time can have a journal
   * open. Default: memory alone.
   */
  journal?: string | ClipJournal | undefined;
  /** A clip from {@link Clip.save}, of the same frames. */
  saved?: Uint8Array | undefined;
  /** Gives the label 255 to pixels whose evidence does not tell an object from the background. Default: false. */
  markUnknown?: boolean | undefined;
  /** As in {@link SegmentOptions}: all labels, boxes and annotations are in pixels of the scaled frames. */
  maxSize?: number | undefined;
}

/** Where a clip keeps what happens to it. Calls follow one another. */
export interface ClipJournal {
  /** All that was kept, in order; undefined if there is nothing. */
  read(): Promise<Uint8Array | undefined>;
  /** Keeps records after those before. Resolves when they are safe. */
  append(records: Uint8Array): Promise<void>;
  /** Keeps one record in place of all before, at once or not at all. */
  replace(saved: Uint8Array): Promise<void>;
  /** Is given all that was kept if a part in the middle cannot be read, before it is replaced by what is before that part. */
  keepDamaged?(content: Uint8Array): Promise<void>;
  close?(): void | Promise<void>;
}

/** Options of a range of frames that is segmented. `motions` is the number of motions in each pair of consecutive frames. */
export interface RangeOptions extends Pick<SegmentOptions, 'motions' | 'quality' | 'subject'> {
  /** Index of the first frame of the range; default 0. */
  first?: number | undefined;
  /** Index of the last frame of the range; default that of the clip. */
  last?: number | undefined;
  /** Cancels the step. Solved pairs are kept. */
  signal?: AbortSignal | undefined;
  /**
   * Gives solved pairs of a frame with the one before, from {@link solvePair} with the same options, if there are some: a farm may have solved
   * them. Those that do not fit are solved again.
   */
  pairs?: ((frame: number) => Uint8Array | undefined | Promise<Uint8Array | undefined>) | undefined;
  /** Whether events of type `draft` come, which take some more time. Default: false. */
  drafts?: boolean | undefined;
}

/** A pixel, and whether it belongs to the object: 1 if it does, -1 if not. */
export type ClipClick = readonly [x: number, y: number, sign: 1 | -1];

/**
 * An annotation of one frame. Labels have one byte per pixel of the frame, row by row.
 *
 * - `strokes`, over earlier strokes of the object in the frame: 1 where the object is, 0 where it is not, 255 where that is left open.
 * - `mask`, in place of earlier strokes of the object in the frame: the same values.
 * - `labels`, a map of the frame: the number of an object, 0 for the background, 255 where that is left open. In other frames the objects that it
 *   names follow, and no others. A map of 0 and 255 alone erases all objects at its zeros. `own`: the numbers are yours, and an object found automatically under one of them gets the lowest free number.
 * - `clicks` and `box`, which together point to one object: its mask is found. It needs a box or a click that is its own. Those that belong to it
 *   are in the box, if there is one. They take the place of earlier ones of the object in the frame; without any, those are taken back.
 *
 * An `object` is a number from 1 to 254; one that no object has, such as {@link Clip.nextObject}, makes a new object.
 */
export type ClipAnnotation = {
  /** Index of the frame. */
  frame: number;
  /**
   * Where the annotation spreads: to the frames before and after (the default), to those on one side, or to none. `'exact'`: to none, and no
   * other pixel of the frame changes.
   */
  propagate?: 'both' | 'forward' | 'backward' | 'none' | 'exact' | undefined;
} & (
  | { object: number; strokes: Uint8Array }
  | { object: number; mask: Uint8Array }
  | { labels: Uint8Array; own?: boolean | undefined }
  | { object: number; clicks?: readonly ClipClick[] | undefined; box?: readonly [x: number, y: number, width: number, height: number] | undefined }
);

/** An object's name, class and colour. */
export interface ClipDescription {
  /** A name protects an object: annotations of others do not change its pixels. */
  name?: string | undefined;
  class?: string | undefined;
  /** Red, green and blue, 0 to 255. */
  colour?: readonly [number, number, number] | undefined;
}

/** All annotations and edits of a clip. */
export interface ClipDeclaration {
  annotations?: readonly ClipAnnotation[] | undefined;
  /** Numbers of locked objects. */
  locked?: readonly number[] | undefined;
  /** Descriptions by number of object. */
  descriptions?: Readonly<Record<number, ClipDescription>> | undefined;
  /** Groups of objects that are merged, each under the number of its first. */
  merged?: readonly (readonly number[])[] | undefined;
  /** Numbers of objects that are background. */
  deleted?: readonly number[] | undefined;
  /** Indices of accepted frames. One that is accepted already keeps its labels, except under masks that are given. */
  accepted?: readonly number[] | undefined;
}

/** An object that a clip has or had. */
export interface ClipEntry {
  /** 1 to 254; never given again. */
  number: number;
  /** Empty if it has none. */
  name: string;
  class: string;
  colour?: [number, number, number];
  /** Whether it changes only by annotations that unlock it. */
  locked: boolean;
  /** Whether a person has annotated it in any frame. */
  annotated: boolean;
  /** Its number now: its own, that of the object into which it was merged, or 0 if it was deleted. */
  became: number;
}

/** What is known of a frame of a clip. */
export interface ClipFrameStatus {
  /** Whether it was segmented. */
  hasMasks: boolean;
  /** Whether a person has accepted it. */
  accepted: boolean;
  /** Whether a person has annotated it. */
  annotated: boolean;
  /** Equal revisions have equal labels; 0 before it is segmented. While a step takes effect it is that from before. */
  revision: number;
}

/**
 * A step of a clip, which takes effect in the background. Awaited, it gives the pixels that objects gained and lost when it has taken effect and
 * the journal has it (or has failed: see the event `unkept`), or rejects; then nothing has changed. Iterated, it gives the frames that it has changed, in order, with their labels; a range gives
 * all its frames. Of a range whose frame cannot be read, the frames before get masks, and the step rejects afterwards with that error.
 */
export interface ClipStep extends PromiseLike<readonly ClipChange[]>, AsyncIterable<ClipFrame> {
  /** The annotated frame as soon as its labels have changed, which is before the annotation has spread. */
  readonly shown: Promise<ClipFrame>;
  /** Takes the step back, if it has not taken effect. It rejects with code `cancelled` then. */
  cancel(): void;
}

/** What happens in a clip. */
export type ClipEvent =
  /** Labels of these frames have changed. */
  | { type: 'frames'; frames: readonly number[] }
  /** {@link Clip.objects} has changed. */
  | { type: 'objects' }
  /** Masks of a frame of the range that is being segmented, from its own pairs alone: they may change, and so may their numbers. */
  | { type: 'draft'; frame: ClipFrame }
  /** Work on a frame begins. `of`: the number of frames of the range, if it is one. */
  | { type: 'progress'; stage: 'pairs' | 'annotations'; frame: number; done: number; of: number | undefined }
  /** A step has taken effect, or failed. */
  | { type: 'settled'; step: number; error?: VeroneseError }
  /** So many bytes were written to the journal. */
  | { type: 'kept'; bytes: number }
  /** The journal has failed. The clip goes on, and its records are written with the next ones. */
  | { type: 'unkept'; error: VeroneseError }
  /** The worker was lost, for this reason, and the clip goes on in another one. */
  | { type: 'revived'; reason: VeroneseError }
  /** A frame cannot be read that an annotation from before the clip was opened needs. It is tried again with the next command. */
  | { type: 'paused'; frame: number; error: VeroneseError }
  /** The clip is closed: by {@link Clip.close}, with its segmenter, or because no worker can be had. */
  | { type: 'closed'; reason: VeroneseError };

/**
 * A clip that is segmented, annotated and read, from its opening to its closing. Objects are numbered 1 to 254 and keep their number in all
 * frames; label 0 is the background.
 *
 * Commands return a {@link ClipStep} at once, and take effect one after another in the order in which they were given; while a range is being
 * segmented, other commands go first if their frames have masks. Invalid arguments reject the step with `invalid-option`, annotations of a locked
 * object with `object-locked`. Nothing that a person has painted, named, accepted or locked changes when something else is annotated.
 */
export interface Clip {
  /** Number of frames. */
  readonly length: number;
  /** Size of the frames; 0 before any is segmented. */
  readonly width: number;
  readonly height: number;
  /** All objects that there are and were. The list is replaced when it changes. */
  readonly objects: readonly ClipEntry[];
  /** The status of each frame. The list is replaced when it changes. */
  readonly frames: readonly ClipFrameStatus[];
  /** How many steps can be undone and redone, and how many have not taken effect. */
  readonly steps: { readonly undo: number; readonly redo: number; readonly waiting: number };
  /** The lowest number that no object has had, and none will have by what was given; 0 if none is left. */
  readonly nextObject: number;
  /** Whether a part of the journal could not be read: steps after it are lost. The journal's own copy of all of it is kept. */
  readonly isDamaged: boolean;
  /**
   * Segments a range of at least two frames, for the first time or again. Objects keep their numbers, and annotations of these frames are applied
   * again. A range that was interrupted goes on with the pairs that were solved.
   */
  segment(options?: RangeOptions): ClipStep;
  /** Annotates frames, in one step. */
  annotate(...annotations: ClipAnnotation[]): ClipStep;
  /** Takes back the annotations of a frame, of one object or of all. */
  clear(annotations: { frame: number; object?: number | undefined }): ClipStep;
  /** Accepts frames as correct, or no longer: annotations of other frames do not change them. `'all'`: every frame with masks. */
  accept(frames: readonly number[] | 'all', on?: boolean): ClipStep;
  /** Locks objects, or unlocks them. */
  lock(objects: readonly number[], on?: boolean): ClipStep;
  /** Replaces an object's name, class and colour. `coalesce`: part of the step before, unless that segmented a range. */
  describe(object: number, description: ClipDescription, options?: { coalesce?: boolean | undefined }): ClipStep;
  /** Merges objects under the number of the first. */
  merge(...objects: number[]): ClipStep;
  /** Turns objects into background. */
  delete(...objects: number[]): ClipStep;
  /** Makes a new object of all pieces of an object but the largest in a frame; other frames follow. */
  split(object: number, frame: number): ClipStep;
  /** Replaces everything that was annotated, described, merged, deleted and accepted. */
  replaceAnnotations(declaration: ClipDeclaration): ClipStep;
  /** Takes over a clip from {@link save}, as one step: its masks, and everything that was annotated. Its own steps are left out. */
  restore(saved: Uint8Array): ClipStep;
  /** Takes back what was given last. Resolves to whether there was something. */
  undo(): Promise<boolean>;
  /** Does again the step that was undone last. Resolves to whether there was one. */
  redo(): Promise<boolean>;
  /** Cancels all steps that have not taken effect. */
  cancel(): void;
  /** Ends the range that is being segmented after the frames whose pairs are solved. */
  finish(): void;
  /** The labels of a frame as they are now; they come before all other work. Waits for a range that is coming to the frame. */
  labels(frame: number, options?: { signal?: AbortSignal | undefined }): Promise<ClipFrame>;
  /**
   * The annotations of a frame that have taken effect, as {@link annotate} takes them, under the current numbers of their objects. Strokes are one
   * image for each object.
   */
  annotations(frame: number): Promise<ClipAnnotation[]>;
  /** The objects in all frames that have masks. */
  tracks(): Promise<ClipTracks>;
  /** The clip as bytes, for the option `saved`: its masks, annotations and steps, but no pixels of frames. */
  save(): Promise<Uint8Array>;
  /** Calls a listener with all events; returns what ends that. */
  subscribe(listener: (event: ClipEvent) => void): () => void;
  /**
   * Frees what the clip holds. Steps that have not taken effect reject with code `clip-closed`; the journal keeps them. Resolves when the journal can
   * be opened again.
   */
  close(): Promise<void>;
  [Symbol.dispose](): void;
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
  /** As in {@link ClipEntry}. */
  name?: string;
  /** Index of the first frame that shows it. */
  first: number;
  /** Index of the last frame that shows it. */
  last: number;
  /** One entry for each frame that shows it. */
  frames: ({ frame: number } & Omit<ClipObject, 'id'>)[];
}

/** The objects and the background of a clip or a stream. */
export interface ClipTracks {
  /** By number, which is the order of appearance. */
  objects: ClipTrack[];
  /** Motion of the background from a frame to the next one, where there is one. */
  background: { frame: number; matrix: Matrix }[];
  /** Number of objects beyond 254, which count as background. Of a stream it is known at its end. */
  dropped: number;
  /** Of a clip without annotations: why there are no objects, or which of them are likely to be none. */
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

/** Frames that come once, all of one size, in order, such as those of a camera. The next is asked for while one is worked on. */
export type StreamSource = Iterable<FrameInput | Promise<FrameInput>> | AsyncIterable<FrameInput>;

/** Options of {@link segmentStream}. */
export interface StreamOptions extends Omit<SegmentOptions, 'confidence' | 'onProgress'> {
  /** Number of frames that each frame waits for, 0 to 8 (the default). More frames give better masks. */
  lookAhead?: number | undefined;
  /** Called before work on a frame begins. If it throws, the stream ends with that exception. */
  onProgress?: ((progress: { frame: number }) => void) | undefined;
}

/** The frames of a stream, in order, as they are labelled. Leaving the loop frees what the stream holds. */
export interface ClipStream extends AsyncGenerator<ClipFrame, void, undefined> {
  /** The objects of the frames so far: complete after the last frame, whose objects have no matrix. */
  tracks(): ClipTracks;
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
  | 'clip-closed'
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
 * frames as a clip ({@link openClip}), which takes annotations.
 */
export function segmentPair(first: FrameInput, second: FrameInput, options?: SegmentOptions): Promise<Segmentation>;

/**
 * Opens a clip. Rejects with `invalid-option` for a journal that another clip has open, or for a saved clip of another number of frames.
 *
 * The clip of this call works in its own thread, step by step. A {@link Segmenter} keeps it in a worker, a {@link SegmenterPool} also shares the
 * work of a range among its workers, with the same results to the bit.
 */
export function openClip(frames: ClipFrames, options?: OpenOptions): Promise<Clip>;

/**
 * Segments frames that come once. A frame is returned when the frames that it waits for have come, the rest at the end. If the source throws or
 * a frame is unusable, the frames before it come first, then the error. Fewer than two frames are the error `too-few-frames`, but for a
 * look-ahead of 0.
 */
export function segmentStream(frames: StreamSource, options?: StreamOptions): ClipStream;

/** Options of {@link solvePair}. */
export type PairOptions = Omit<SegmentOptions, 'markUnknown' | 'confidence' | 'onProgress'>;

/**
 * Solves the pairs of a frame of a clip with the one before: nearly all the work of segmenting it. The bytes are for the option `pairs` of
 * {@link Clip.segment}, so that other machines can share the work; they are of the same version of this package.
 */
export function solvePair(before: FrameInput, frame: FrameInput, options?: PairOptions): Promise<Uint8Array>;

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
  solvePair(before: FrameInput, frame: FrameInput, options?: PairOptions): Promise<Uint8Array>;
  fitMotions(measurements: PointMeasurements, options?: FitOptions): Promise<MotionFit>;
  /** As {@link openClip}, in the worker. If the worker is lost, the clip goes on in another one. */
  openClip(frames: ClipFrames, options?: OpenOptions): Promise<Clip>;
  /** As {@link segmentStream}, in the worker. */
  segmentStream(frames: StreamSource, options?: StreamOptions): ClipStream;
  /**
   * Starts the worker and segments small built-in pairs in it for half a second, so that the engine fully compiles the hot code. Without
   * it, a first call takes several times as long as later ones. One worker warms up for all instances of the module on the page. Another
   * call to the same worker ends it (the promise resolves then), and so does `close()`; a good moment is before frames are decoded.
   */
  warmUp(): Promise<void>;
  /** Ends the worker, and closes its clips; running calls reject with code `cancelled`. The next call starts a new worker. */
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
  interface SymbolConstructor {
    readonly dispose: unique symbol;
  }
  interface Response {}
  interface URL {
    href: string;
  }
  namespace WebAssembly {
    interface Module {}
  }
}
