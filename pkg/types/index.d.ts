// The public types, written by hand: what stands here is what a caller may rely on.

/**
 * RGBA bytes, row by row. An `ImageData` fits. Sides from 16 to 4096 pixels.
 *
 * The bytes stay the caller's: a call copies them before it returns, so that they may be written to as soon as it has. They may be a
 * view of a larger buffer, of which nothing else is copied, and shared or resizable memory, as it is at that moment.
 */
export interface Pixels {
  data: Uint8ClampedArray | Uint8Array;
  width: number;
  height: number;
}

/** Where the work is: a stage has just begun. */
export interface Progress {
  /** A stable camelCase name, the key of the stage in `milliseconds`. */
  stage: string;
  /** Position of the stage among all of this call, from 0. */
  index: number;
  /** Number of stages of this call. */
  of: number;
}

/** What every call takes. */
export interface CallOptions {
  /**
   * Cancels the call, which then rejects with code `cancelled`. A {@link Segmenter} stops at once; a direct call, which
   * occupies its thread, looks at the signal between stages.
   */
  signal?: AbortSignal | undefined;
  /** Called when a stage begins. What it throws ends the call and is thrown on. */
  onProgress?: ((progress: Progress) => void) | undefined;
  /**
   * Gives the arrays away instead of having them copied; default `false`. When the call returns, the whole `ArrayBuffer`s of its
   * frames, of the measurements and of the evidence are detached, their arrays empty, whatever becomes of the call; only one that is
   * refused for its arguments or cancelled by then leaves them alone. A segmentation is never given away. What cannot be given away is
   * copied: shared memory, that of a WebAssembly module, the pools of Node's `Buffer`.
   */
  transfer?: boolean | undefined;
}

export interface SegmentOptions extends CallOptions {
  /** Number of motions, 1 to 10; default `'auto'`: find it. */
  motions?: 'auto' | number | undefined;
  /** Work to spend: `'fast'` for live use, `'best'` (the default) for keeping. */
  quality?: 'fast' | 'best' | undefined;
  /**
   * Label 255 where a pixel is hidden or outside in the second frame, where there is no texture around it, and where its label
   * would more likely be wrong than right; default `false`.
   */
  markUnknown?: boolean | undefined;
  /** Say for every pixel how sure its label is, in `confidence` of the result; default `false`. */
  confidence?: boolean | undefined;
  /** Seed of every random choice, a whole number from 0; default 1. */
  seed?: number | undefined;
  /** The frame before the first: a third view that helps where something is hidden in the second. */
  before?: Pixels | undefined;
}

export interface RelabelOptions extends CallOptions {
  /** The frame before the first, if the segmentation was made with one. */
  before?: Pixels | undefined;
}

export interface FitOptions extends CallOptions {
  /** Number of motions, 1 to 10; default `'auto'`: find it. */
  motions?: 'auto' | number | undefined;
  /** `'paper'`: the algorithm of the paper; `'best'` (the default): ours. */
  method?: 'paper' | 'best' | undefined;
  /** Seed of every random choice, a whole number from 0; default 1. */
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

/** One number of motions that was tried; a smaller score is better. */
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

/** What {@link segmentPair} found: plain data, nothing to free. */
export interface Segmentation {
  version: 1;
  width: number;
  height: number;
  /** Number of motions. */
  count: number;
  /** By decreasing number of pixels: `motions[i].label === i`. */
  motions: SegmentedMotion[];
  /**
   * Description lengths of both frames in nats, of one motion up to one more than were found, each with labels of its own. The
   * number found need not have the smallest: the stages decide one after another, not by this list alone.
   */
  evidence: { candidates: Candidate[] };
  /** Number of pixels with label 255. */
  unlabelled: number;
  milliseconds: Milliseconds;
  settings: {
    motions: 'auto' | number;
    quality: 'fast' | 'best';
    markUnknown: boolean;
    /** Whether there was a frame before the first. */
    before: boolean;
    seed: number;
    software: string;
  };
  /** One label per pixel, row by row; 255 is unlabelled. */
  labels: Uint8Array;
  /**
   * Only with `confidence: true`: how sure the label of every pixel is, row by row. 255 times the probability that its motion
   * is the right one, given how well all motions explain the pixel and its surroundings: of the pixels with probability P about
   * the share P is right. 0 where the pixel is unlabelled.
   */
  confidence?: Uint8Array;
}

/** One motion of a {@link MotionFit}. */
export interface FittedMotion {
  label: number;
  matrix: Matrix;
  /** Number of measurements that belong to it. */
  measurements: number;
  /** How many of the six entries its measurements determine: below 6 the rest is a choice. */
  determined: number;
}

/** What {@link fitMotions} found. */
export interface MotionFit {
  version: 1;
  /** Number of motions. */
  count: number;
  /** By decreasing number of measurements: `motions[i].label === i`. */
  motions: FittedMotion[];
  evidence: { singularValues: number[]; candidates: Candidate[] };
  /** What the paper's steps gave; only with `method: 'paper'`. */
  stages?: { factorisation: Matrix[]; refined: Matrix[] };
  milliseconds: Milliseconds;
  settings: { motions: 'auto' | number; method: 'paper' | 'best'; seed: number; software: string };
  /** One label per measurement, in input order; 255 is an outlier. */
  labels: Uint8Array;
}

/** Image measurements: x, y of each in `positions`, I_x, I_y, I_t of each in `derivatives`. Copied when the call is made, as {@link Pixels}. */
export interface PointMeasurements {
  positions: Float64Array;
  derivatives: Float64Array;
}

/** Where the WebAssembly module comes from. */
export type WasmSource = URL | string | Response | BufferSource | WebAssembly.Module;

/** Red, green, blue and, where given, alpha: 0 to 255. */
export type Colour = readonly [number, number, number] | readonly [number, number, number, number];

export interface PaintOptions {
  /**
   * One colour per label; labels beyond are transparent, and alpha 0 hides one. Default: the DAVIS palette with label 0 and
   * 255 transparent.
   */
  palette?: readonly Colour[] | undefined;
  /** 0 to 1, scales every alpha; default 0.5. */
  opacity?: number | undefined;
}

/** Stable codes of every error, the same on the command line. */
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
  | 'unreadable-image'
  // the surroundings
  | 'wasm-load-failed'
  | 'worker-failed'
  | 'cancelled'
  | 'internal'
  // the command line alone
  | 'usage'
  | 'file-not-found'
  | 'unreadable-file'
  | 'invalid-json'
  | 'write-failed'
  | 'too-few-frames'
  | 'pairs-failed'
  | 'ffmpeg-missing'
  | 'unreadable-video';

/**
 * Every error that this package throws or rejects with. What the caller's own listeners and sources of pairs throw is passed on as it
 * is.
 */
export class VeroneseError extends Error {
  constructor(code: ErrorCode, message: string, options?: ErrorOptions);
  readonly code: ErrorCode;
}

/** Version of the package. */
export const version: string;

/**
 * Loads the WebAssembly module of all calls but {@link fitMotions}. Optional, since every call does so by itself: call it to load
 * early or from a place of your own. May be called again: the first source that loaded stays.
 *
 * Rejects with code `wasm-load-failed`; a later call tries again.
 */
export function init(source?: WasmSource | Promise<WasmSource>): Promise<void>;

/** {@link init} for the module of {@link fitMotions}, `veronese/veronese_points_bg.wasm`, which nobody else needs. */
export function initPoints(source?: WasmSource | Promise<WasmSource>): Promise<void>;

/** Finds how many things move between two frames, how each moves, and which pixels belong to it. */
export function segmentPair(first: Pixels, second: Pixels, options?: SegmentOptions): Promise<Segmentation>;

/**
 * Solves the labels of a segmentation again under what a person says about single pixels, with its motions as they are.
 *
 * `evidence` holds a set of labels for each pixel, row by row: bit k is set where label k is possible, 0 says nothing. "This is
 * label 2" is `0b100`; "this is not label 0" of four is `0b1110`; "one of the merged labels 1 and 3" is `0b1010`. What is said
 * holds on its pixels and spreads from there as far as the picture looks alike; far from it every label stays. Numbering and groups
 * stay too, so a label may be left without pixels; `confidence` is left out. The same arguments give the same answer: to undo, ask without.
 *
 * Everything is copied when the call is made, and the result shares nothing with the segmentation given.
 */
export function relabel(
  first: Pixels,
  second: Pixels,
  segmentation: Segmentation,
  evidence: Uint16Array,
  options?: RelabelOptions,
): Promise<Segmentation>;

/** Solves the paper's Problem 1 on measurements of your own. */
export function fitMotions(measurements: PointMeasurements, options?: FitOptions): Promise<MotionFit>;

/**
 * Replaces the top-left width × height pixels of a canvas by the colours of the labels, with transparency: lay the canvas
 * over the frame.
 */
export function paintLabels(
  context: CanvasRenderingContext2D | OffscreenCanvasRenderingContext2D,
  segmentation: Pick<Segmentation, 'labels' | 'width' | 'height'>,
  options?: PaintOptions,
): Promise<void>;

/** One group number per pixel instead of its motion; 255 stays. Throws code `invalid-input`. */
export function groupLabels(segmentation: Pick<Segmentation, 'labels' | 'motions'>): Uint8Array;

/** The 256 colours of the DAVIS benchmark's masks; label 0 is black. */
export function davisPalette(): [number, number, number][];

/**
 * Two frames and, if there is one, the frame before the first; whatever else the object has comes back with its outcome. The frames are
 * copied (or taken, with `transfer`) before the next input is asked for: a source may use one set of buffers for all of its pairs.
 */
export interface PairInput {
  first: Pixels;
  second: Pixels;
  before?: Pixels | undefined;
}

/** Options for all pairs of a {@link segmentPairs}. */
export interface PairsOptions extends Omit<SegmentOptions, 'before' | 'onProgress'> {
  /** Called when a stage of a pair begins; `pair` counts from 0. What it throws ends that pair and is the `cause` of its error. */
  onProgress?: ((progress: Progress & { pair: number }) => void) | undefined;
}

/** What became of one pair: a segmentation, or the error that prevented it. The other pairs go on. */
export type PairOutcome<Input extends PairInput = PairInput> =
  | { index: number; input: Input; segmentation: Segmentation; error?: undefined }
  | { index: number; input: Input; error: VeroneseError; segmentation?: undefined };

/** As much of a `Worker`, of the browser or of Node, as types that know neither can say. */
export interface WorkerLike {
  postMessage(message: unknown): void;
  terminate(): unknown;
}

export interface SegmenterOptions {
  /**
   * Makes the worker, where the bundler or the page needs that done by hand: a module worker (in Node a worker thread) whose file is
   * `veronese/worker`. By default the file beside the package's code.
   */
  worker?: (() => WorkerLike) | undefined;
  /** As in {@link initPoints}: asked for when there are measurements. */
  points?: WasmSource | Promise<WasmSource> | undefined;
}

export interface PoolOptions extends SegmenterOptions {
  /** Number of workers, 1 to 256; by default as many as the machine runs at a time. */
  jobs?: number | undefined;
  /** As in {@link init}: compiled once for all workers. */
  source?: WasmSource | Promise<WasmSource> | undefined;
}

/**
 * The same calls in a Web Worker, or in a worker thread under Node: the page stays responsive, and a cancelled call stops at
 * once. Calls are done one after another.
 */
export class Segmenter {
  /** `source` as in {@link init}; by default the file beside the package's code. Throws code `invalid-option`. */
  constructor(source?: WasmSource | Promise<WasmSource>, options?: SegmenterOptions);
  segmentPair(first: Pixels, second: Pixels, options?: SegmentOptions): Promise<Segmentation>;
  relabel(
    first: Pixels,
    second: Pixels,
    segmentation: Segmentation,
    evidence: Uint16Array,
    options?: RelabelOptions,
  ): Promise<Segmentation>;
  fitMotions(measurements: PointMeasurements, options?: FitOptions): Promise<MotionFit>;
  /**
   * Starts the worker and has it segment a small pair of its own for half a second or more, beside the page, so that the engine has compiled to
   * the end what calls spend their time in: a first call otherwise takes two to three times as long as later ones. One worker warms
   * up for all instances of the module on the page. Other calls to the same worker wait meanwhile; `close()` ends it.
   */
  warmUp(): Promise<void>;
  /** Ends the worker; calls under way reject with code `cancelled`. The next call starts a fresh one. */
  close(): void;
}

/**
 * Several workers, each with instances of its own of modules that are compiled once. Calls begin in their order and are
 * cancelled one by one; workers are started when there is work for them.
 */
export class SegmenterPool extends Segmenter {
  /** Throws code `invalid-option`. */
  constructor(options?: PoolOptions);
  readonly jobs: number;
  /**
   * Segments many pairs, as an async iterator in the order of the pairs. A pair is taken from `pairs` only when there is room for it:
   * at most 2·`jobs` are under way or wait to be fetched, so an async generator that reads frames reads no faster than the workers
   * work. A pair that fails is an outcome with `error`, not the end; `signal` ends everything with code `cancelled`, and
   * so does leaving the loop. What `pairs` throws is thrown after the outcomes of the pairs that it gave.
   */
  segmentPairs<Input extends PairInput>(
    pairs: Iterable<Input | Promise<Input>> | AsyncIterable<Input>,
    options?: PairsOptions,
  ): AsyncGenerator<PairOutcome<Input>, void, undefined>;
}

/** {@link SegmenterPool.segmentPairs} on a pool of its own, which ends with the iterator. */
export function segmentPairs<Input extends PairInput>(
  pairs: Iterable<Input | Promise<Input>> | AsyncIterable<Input>,
  options?: PairsOptions & PoolOptions,
): AsyncGenerator<PairOutcome<Input>, void, undefined>;
