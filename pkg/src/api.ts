// The calls themselves, on the module that has them: arguments checked, options handed over, time measured.

import type {
  CallOptions,
  FitOptions,
  Milliseconds,
  MotionFit,
  PaintOptions,
  Pixels,
  PointMeasurements,
  RelabelOptions,
  Segmentation,
  SegmentOptions,
  WasmSource,
} from '../types/index.js';
import type { Core, Glue } from './core.js';
import type { FramesGlue, OnStage } from './glue.js';
import type { PointsGlue } from './glue-points.js';
import { cancelled, VeroneseError } from './errors.js';
import { colourBytes, davisPalette } from './palette.js';

export class Api {
  readonly #frames: Core<FramesGlue>;
  readonly #points: Core<PointsGlue>;

  /** `points` is loaded when measurements come; it may be the same as `frames`. */
  constructor(frames: Core<FramesGlue>, points: Core<PointsGlue>) {
    this.#frames = frames;
    this.#points = points;
  }

  readonly init = (source?: WasmSource | Promise<WasmSource>): Promise<void> => this.#frames.init(source);

  readonly initPoints = (source?: WasmSource | Promise<WasmSource>): Promise<void> => this.#points.init(source);

  readonly segmentPair = async (first: Pixels, second: Pixels, options?: SegmentOptions): Promise<Segmentation> => {
    const { call, rest } = splitOptions(options);
    const { before, ...settings } = rest;
    const frames = [checkedPixels('the first frame', first), checkedPixels('the second frame', second)] as const;
    const third = before === undefined ? undefined : checkedPixels('the frame before', before);
    return run<Segmentation, FramesGlue>(this.#frames, call, (glue, onStage) => glue.segmentPair(...frames, third, settings, onStage));
  };

  readonly relabel = async (
    first: Pixels,
    second: Pixels,
    segmentation: Segmentation,
    evidence: Uint16Array,
    options?: RelabelOptions,
  ): Promise<Segmentation> => {
    const { call, rest } = splitOptions(options);
    const { before, ...unknown } = rest;
    const frames = [checkedPixels('the first frame', first), checkedPixels('the second frame', second)] as const;
    const third = before === undefined ? undefined : checkedPixels('the frame before', before);
    const { labels, matrices, groups, sets } = checkedCorrection(segmentation, evidence);
    const settings = { ...unknown, quality: segmentation.settings.quality };
    const corrected = await run<Pick<Segmentation, 'motions' | 'unlabelled' | 'labels' | 'milliseconds'>, FramesGlue>(
      this.#frames,
      call,
      (glue, onStage) => glue.relabel(...frames, third, matrices, groups, labels, sets, settings, onStage),
    );
    // How sure the labels were says nothing about those of now.
    const { confidence: _, ...kept } = segmentation;
    return { ...kept, ...corrected };
  };

  readonly fitMotions = async (measurements: PointMeasurements, options?: FitOptions): Promise<MotionFit> => {
    const { call, rest } = splitOptions(options);
    const { positions, derivatives } = checkedMeasurements(measurements);
    const fit = (glue: PointsGlue, onStage: OnStage) => glue.fitMotions(positions, derivatives, rest, onStage);
    return run<MotionFit, PointsGlue>(this.#points, call, fit);
  };

  readonly paintLabels = async (
    context: CanvasRenderingContext2D | OffscreenCanvasRenderingContext2D,
    { labels, width, height }: Pick<Segmentation, 'labels' | 'width' | 'height'>,
    { palette = overlayPalette(), opacity = 0.5 }: PaintOptions = {},
  ): Promise<void> => {
    const rest = [labels, width, height, colourBytes(palette, 4), opacity] as const;
    await this.#frames.call((glue) => {
      if (isOffscreen(context)) glue.paintLabelsOffscreen(context, ...rest);
      else glue.paintLabels(context, ...rest);
    });
  };
}

/** One call of a module. Stages are timed, and between them the signal is looked at. */
async function run<T extends { milliseconds: Milliseconds }, G extends Glue>(
  core: Core<G>,
  { signal, onProgress }: CallOptions,
  work: (glue: G, onStage: OnStage) => unknown,
): Promise<T> {
  if (signal?.aborted) throw cancelled(signal);
  await core.init();
  if (signal?.aborted) throw cancelled(signal);
  const watch = new Stopwatch();
  let thrownByListener: { thrown: unknown } | undefined;
  const onStage: OnStage = (stage, index, of) => {
    watch.begin(stage);
    try {
      onProgress?.({ stage, index, of });
      if (signal?.aborted) throw cancelled(signal);
    } catch (thrown) {
      thrownByListener = { thrown };
      throw thrown;
    }
  };
  try {
    const report = await core.call((glue) => {
      watch.start();
      return { ...(work(glue, onStage) as Omit<T, 'milliseconds'>), milliseconds: watch.end() };
    });
    return report as T;
  } catch (thrown) {
    throw thrownByListener ? thrownByListener.thrown : thrown;
  }
}

/** The default of {@link Api.paintLabels}: DAVIS, with what is dominant or unlabelled left transparent. */
function overlayPalette(): (readonly [number, number, number, number])[] {
  return davisPalette().map(([r, g, b], label) => [r, g, b, label === 0 || label === 255 ? 0 : 255] as const);
}

function isOffscreen(
  context: CanvasRenderingContext2D | OffscreenCanvasRenderingContext2D,
): context is OffscreenCanvasRenderingContext2D {
  return typeof OffscreenCanvasRenderingContext2D === 'function' && context instanceof OffscreenCanvasRenderingContext2D;
}

/** Parts what concerns the call from what goes to the core, which refuses what it does not know. */
export function splitOptions<T extends CallOptions>(options: T | undefined) {
  if (options !== undefined && (typeof options !== 'object' || options === null || Array.isArray(options))) {
    throw new VeroneseError('invalid-option', 'options must be an object');
  }
  const { signal, onProgress, ...rest } = options ?? ({} as T);
  if (signal !== undefined && typeof signal?.aborted !== 'boolean') {
    throw new VeroneseError('invalid-option', "option 'signal': must be an AbortSignal");
  }
  if (onProgress !== undefined && typeof onProgress !== 'function') {
    throw new VeroneseError('invalid-option', "option 'onProgress': must be a function");
  }
  return { call: { signal, onProgress } satisfies CallOptions, rest };
}

/**
 * A frame of the right shape, its bytes viewed as an array of this realm (one from another frame or a test environment is
 * as good). Whether they fill a frame of a supported size is the core's question.
 */
export function checkedPixels(which: string, pixels: Pixels): Pixels {
  const { data, width, height } = Object(pixels) as Partial<Pixels>;
  if (!isArray<Uint8Array | Uint8ClampedArray>(data, 'Uint8Array', 'Uint8ClampedArray')) {
    const shape = '{ data, width, height } with RGBA bytes, like ImageData';
    throw new VeroneseError('invalid-input', `${which} must be ${shape}`);
  }
  if (!Number.isInteger(width) || !Number.isInteger(height)) {
    throw new VeroneseError('invalid-input', `${which}: width and height must be whole numbers of pixels`);
  }
  return {
    data: new Uint8Array(data.buffer, data.byteOffset, data.byteLength),
    width: width as number,
    height: height as number,
  };
}

/** What the core needs of a segmentation, as flat arrays. Whether they fit each other is the core's question. */
export function checkedCorrection(segmentation: Segmentation, evidence: Uint16Array) {
  const { motions, labels, settings } = Object(segmentation) as Partial<Segmentation>;
  const shaped = Array.isArray(motions) && motions.every((motion) => Array.isArray(motion?.matrix) && motion.matrix.length === 6);
  if (!shaped || !isArray<Uint8Array>(labels, 'Uint8Array') || typeof settings !== 'object') {
    throw new VeroneseError('invalid-input', 'the segmentation must be one that segmentPair or relabel gave');
  }
  if (!isArray<Uint16Array>(evidence, 'Uint16Array')) {
    throw new VeroneseError('invalid-input', 'the evidence must be a Uint16Array of one set of labels for each pixel');
  }
  return {
    labels,
    matrices: Float64Array.from(motions.flatMap(({ matrix }) => matrix)),
    groups: Uint8Array.from(motions, ({ group }) => group),
    sets: evidence,
  };
}

export function checkedMeasurements(measurements: PointMeasurements): PointMeasurements {
  const { positions, derivatives } = Object(measurements) as Partial<PointMeasurements>;
  if (!isArray<Float64Array>(positions, 'Float64Array') || !isArray<Float64Array>(derivatives, 'Float64Array')) {
    throw new VeroneseError('invalid-input', 'measurements must be { positions, derivatives }, both a Float64Array');
  }
  return { positions, derivatives };
}

function isArray<T>(value: unknown, ...names: string[]): value is T {
  return ArrayBuffer.isView(value) && names.includes(Object.prototype.toString.call(value).slice(8, -1));
}

/** Milliseconds per stage; a stage that is entered again goes on where it stopped. */
class Stopwatch {
  readonly #laps = new Map<string, number>();
  #started = 0;
  #stage: { name: string; since: number } | undefined;

  start(): void {
    this.#started = performance.now();
  }

  begin(name: string): void {
    const now = performance.now();
    this.#close(now);
    this.#stage = { name, since: now };
  }

  end(): Milliseconds {
    const now = performance.now();
    this.#close(now);
    return { total: now - this.#started, ...Object.fromEntries(this.#laps) };
  }

  #close(now: number): void {
    if (this.#stage) this.#laps.set(this.#stage.name, (this.#laps.get(this.#stage.name) ?? 0) + now - this.#stage.since);
  }
}
