// The calls of the module of the site, written by hand. It is built with what lies between the steps of the method, and is no part of the
// package: any of it may change in any version. All calls are synchronous, keep nothing, and return copies.
//
// Errors: every call throws an `Error` named `VeroneseError` with a stable `code`: `invalid-option` for an argument out of range,
// `invalid-input` for an array of the wrong length or a malformed frame, `not-finite` for NaN, infinity and numbers above 10¹²,
// `too-few-measurements`, `frame-size-mismatch`, `frame-size-unsupported`, `pixel-count-mismatch`; `internal` for a defect.

import type { Candidate, FitOptions, FittedMotion, Matrix, MotionFit, Pixels, Segmentation, SegmentOptions } from '../pkg/types/index.js';

export type { Candidate, FittedMotion, Matrix, Pixels };

/** A flow (u, v): pixels to the right and down. */
export type Flow = [number, number];

/** What {@link Module.veroneseMap} returns. */
export interface VeroneseMap {
  /** The powers of the variables in each monomial, in the paper's order: x², xy, y² or x², xy, xz, y², yz, z². */
  exponents: number[][];
  /** The embedded points, row by row: `matrix[row * columns + column]`. */
  matrix: Float64Array;
  /** Number of points. */
  rows: number;
  /** Number of monomials: n + 1 of two variables, (n + 1)(n + 2)/2 of three. */
  columns: number;
  /** Decreasing, as many as there are columns: with fewer rows than columns the last are 0. */
  singularValues: number[];
  /** The rank by the paper's footnote 4, κ = 0.003. Points on n lines through the origin (and on no fewer) have rank n at degree n. */
  rank: number;
  /** Coefficients of the polynomial that vanishes on the points, of unit length, up to sign: the right singular vector of the smallest singular value. */
  nullVector: number[];
  /** With two variables only: the lines through the origin on which the polynomial vanishes, as unit normals (a, b) of a·x + b·y = 0. */
  lines?: [number, number][];
  /** With two variables only: the number of factors that are no real lines, 0 or an even number. `lines.length + complex` is the degree. */
  complex?: number;
}

/** What {@link Module.multibodyFlow} returns. */
export interface MultibodyFlow {
  /**
   * Coefficients of the product of all I_x·u + I_y·v + I_t, in the paper's order of monomials of (I_x, I_y, I_t). The last one is 1; if it
   * vanishes (some flow is infinite), they have unit length. For two motions it is the conic I_x², I_x·I_y, I_x·I_t, I_y², I_y·I_t, I_t².
   */
  coefficients: number[];
  /** Of the embedded derivatives, decreasing, as many as there are coefficients. */
  singularValues: number[];
  /**
   * The flows by factoring the polynomial (eq. 13 and 14), in no particular order. Of complex roots, which occur with noise, the real parts
   * are used. Fewer than n if some are infinite. The u of flows with the same v are not determined: the route fails there.
   */
  factors: Flow[];
  /** The flows by the gradient of the polynomial where it vanishes, in no particular order; empty if the last coefficient vanishes. */
  byDifferentiation: Flow[];
}

/** What {@link Module.derivativesOf} returns. Row by row, grey levels (of 0 to 255) per pixel and per frame, half-way between the frames. */
export interface Derivatives {
  width: number;
  height: number;
  /** I_x, positive where it gets brighter to the right. */
  horizontal: Float32Array;
  /** I_y, positive where it gets brighter downwards. */
  vertical: Float32Array;
  /** I_t, second frame minus first. */
  temporal: Float32Array;
}

/** One number of motions that the rank rule (12) tried. */
export interface RankCandidate {
  motions: number;
  /** Numerical rank of the embedded data. */
  rank: number;
  /** Columns, M_i² − Z_i. */
  columns: number;
  /** The rank that fires the rule, `columns` − 1. */
  wanted: number;
  /** The last singular value over the sum of the others; below κ = 0.003 the matrix has a null vector. */
  ratio: number;
}

/** What {@link Module.paperStages} returns. Motions are in the coordinates of the input unless it says otherwise. */
export interface PaperStages {
  /** Number of motions. */
  count: number;
  /** Empty if the number was given. */
  ranks: RankCandidate[];
  /** Whether some number satisfied the rank rule (12); null if the number was given. */
  ruleFired: boolean | null;
  /** Of the embedded data, columns scaled to unit length, decreasing; empty for more than 6 motions. */
  singularValues: number[];
  /** Size of the embedded data: measurements × (M_n² − Z_n). */
  embedded: { rows: number; columns: number };
  /** Normalised positions are (x − centre) / scale, normalised derivatives y / intensity. Flows keep their unit. */
  normalisation: { centre: [number, number]; scale: number; intensity: number };
  /** The multibody motion 𝒜 in normalised coordinates, M_n × M_n, row by row (rows: monomials of y, columns: of x). Its last entry is 1. */
  multibody: { size: number; matrix: Float64Array };
  /** Step 2: the third columns (u, v) of the motions in normalised coordinates, the flows at the centre. In the order of `factorisation`. */
  thirdColumns: Flow[];
  /** The smallest difference of two third columns in u, and in v; null for one motion. */
  gaps: [number, number] | null;
  /** The largest difference, in u and in v, of a third column and the third entry of the row that step 5 gives to it. */
  mismatches: [number, number];
  /** Whether step 5 cannot tell which row belongs to which motion: a gap vanishes or is at most twice the mismatch. */
  ambiguous: boolean;
  /** After the five steps of section 3.3. */
  factorisation: Matrix[];
  /** By differentiation of the same multibody motion at measurements, in the order of `refined`. Empty if no point is usable. */
  differentiation: Matrix[];
  /** After the nonlinear refinement (19), started from `factorisation` and in its order. */
  refined: Matrix[];
  /** How that refinement ended. */
  refinement: { termination: string; iterations: number; initialCost: number; finalCost: number };
  /** For each measurement the index in `refined` of the motion with the smallest |yᵀAx|. */
  labels: Uint8Array;
}

/** What {@link Module.motionsAtPixel} returns. */
export interface PixelStages {
  /** The multibody polynomial at the pixel for y = (cos θ, sin θ, t), by increasing powers of t. The last one is 1. */
  coefficients: number[];
  /** Its roots, [real, imaginary]: the temporal derivatives that the motions predict for a gradient of length 1. */
  roots: [number, number][];
  /** What the derivatives of the polynomial at the real parts of the roots give, without motions that are not finite. */
  motions: Matrix[];
}

/** One matrix of {@link Module.embeddedSpectra}. */
export interface Spectrum {
  motions: number;
  /** Of the embedded data, columns scaled to unit length, decreasing. */
  singularValues: number[];
  /** Their rank by the paper's footnote 4, κ = 0.003. */
  rank: number;
}

/** What {@link Module.figure1Trial} returns. */
export interface Figure1Trial {
  truth: Matrix[];
  /** Mean relative errors (20), per cent; Infinity if a method fails. `best` is ours, `oracle` the least squares estimate that knows the labels. */
  errors: { factorisation: number; refined: number; best: number; oracle: number };
  /** Whether the rank rule (12), and ours, find the number of motions by themselves. */
  countRight: { rule: boolean; best: boolean };
}

/** What {@link Module.motionMeasurements} returns. */
export interface MotionMeasurements {
  /** x, y of each, in [−1, 1]². */
  positions: Float64Array;
  /** I_x, I_y, I_t of each; of unit length without noise. */
  derivatives: Float64Array;
  /** The true motion of each. */
  labels: Uint8Array;
}

/** A grid of pixels over the frames: pixel (x, y) of it lies at (scale·x, scale·y) of the full frame. Planes of it are row by row. */
export interface Grid {
  width: number;
  height: number;
  scale: number;
}

/** A candidate motion of {@link Background}. */
export interface CandidateMotion {
  matrix: Matrix;
  /** Where it comes from: the multibody constraint, the local flow of a window, or the other hypothesis about the background. */
  source: 'constraint' | 'window' | 'hypothesis';
  /** Degree of the polynomial it was read off; 0 for other sources. */
  degree: number;
  /** What it would save beside the dominant motion alone before it is refined, in the unit of `price`. */
  gain: number;
  /** Share of the pixels, 0 to 1, that it explains better than the dominant motion does. */
  support: number;
}

/** A motion that was selected, with the share of the pixels, 0 to 1, that it explains best. */
export interface SelectedMotion {
  matrix: Matrix;
  support: number;
}

/** Labels with their motions. The first motion is the background's; numbers are not yet those of the report. */
export interface Labelling extends Grid {
  motions: Matrix[];
  labels: Uint8Array;
}

/** One hypothesis about the background, solved to the end. Motions and places are in pixels of the full frame. */
export interface Background {
  /** Whether the background is assumed to be at rest; otherwise it has the motion that explains most pixels. */
  atRest: boolean;
  dominant: Matrix;
  /** The level on which derivatives and measurements are taken. */
  base: Grid;
  /** Standard deviation of the intensity difference along a correct motion in flat areas, grey levels. */
  noise: number;
  /** Second frame along the dominant motion minus first frame, grey levels, on `base`. */
  residual: Float32Array;
  /**
   * Derivatives on `base`, grey levels per pixel of `base`, taken where the local flow lands: recentred, so that they are linear for motions of many pixels.
   * I_x·u + I_y·v + I_t = 0 holds for (u, v) = the flow relative to the dominant motion, divided by `base.scale`.
   */
  derivatives: { horizontal: Float32Array; vertical: Float32Array; temporal: Float32Array };
  /** Rough flow relative to the dominant motion from windows, pixels of the full frame, on `base`. */
  localFlow: { u: Float32Array; v: Float32Array };
  /**
   * What the multibody constraint is fitted to: pixels that the dominant motion does not explain; null where they are too few. `places` are
   * pixels of the full frame (x, y of each), `positions` the same normalised by the half width, `derivatives` scaled to about unit length; their flows
   * are relative to the dominant motion in units of `unit` pixels of the full frame. `weights`, 0 to 1, say how badly the dominant motion explains a pixel.
   */
  measurements: { places: Float64Array; positions: Float64Array; derivatives: Float64Array; weights: Float64Array; unit: number } | null;
  candidates: CandidateMotion[];
  /** What a motion has to gain to be selected. */
  price: number;
  /** After greedy selection; the first is the dominant motion. */
  selected: SelectedMotion[];
  /** The selected motion that explains each pixel best, before any pixel asks its neighbours. */
  selection: Labelling;
  /** After refinement on the intensities. */
  refined: SelectedMotion[];
  /** The refined motion that explains each pixel best, likewise. */
  refinement: Labelling;
  /** The labels of the draft level. */
  draft: Labelling;
  /** The labels of the working size. */
  labelling: Labelling;
}

/** What {@link Module.segmentPairStages} returns. */
export interface PairStages {
  /** The hypotheses about the background that were solved, one or two. */
  hypotheses: Background[];
  /** The index of the one that describes the frames in fewer nats. */
  chosen: number;
  /** Large frames with quality `best`: the labels carried on at a finer working size. Otherwise null. */
  detail: Labelling | null;
  /** The labels at the final working size, after shadows are given back to the background. */
  working: Labelling;
  /** Labels of `result` by groups: motions of one rigid background are together. */
  groups: number[][];
  /** What `segmentPair` returns with the same options, bit for bit, without times. */
  result: Omit<Segmentation, 'milliseconds'>;
}

/** The options of the calls without those of the package's own: signal, progress and transfer. */
type Plain<Options> = Omit<Options, 'signal' | 'onProgress' | 'transfer' | 'seed'>;

export interface Module {
  /**
   * The Veronese map of points (eq. 7) and the polynomial that vanishes on them.
   *
   * @param points 2 or 3 numbers for each of 1 to 100 000 points
   * @param variables 2 or 3
   * @param degree 1 to 6
   */
  veroneseMap(points: Float64Array, variables: 2 | 3, degree: number): VeroneseMap;

  /**
   * Translations from one polynomial in the derivatives, without assigning any pixel (eq. 13 and 14).
   *
   * @param derivatives I_x, I_y, I_t of each pixel: at least (n + 1)(n + 2)/2 − 1 of them
   * @param motions n, 1 to 4
   */
  multibodyFlow(derivatives: Float64Array, motions: number): MultibodyFlow;

  /** Image derivatives of two frames of one size, by the filters of `derivatives` in the crate. */
  derivativesOf(first: Pixels, second: Pixels): Derivatives;

  /**
   * The paper's algorithm step by step, and differentiation beside its factorisation.
   *
   * @param positions x, y of each measurement
   * @param derivatives I_x, I_y, I_t of each
   * @param motions 1 to 10; `'auto'`, the default, applies the rank rule. Needs 6, 24, 64, 139 … measurements for 1, 2, 3, 4 … motions.
   */
  paperStages(positions: Float64Array, derivatives: Float64Array, motions?: 'auto' | number): PaperStages;

  /**
   * The motions by differentiating the multibody polynomial at one pixel. Needs as many measurements as {@link paperStages}.
   *
   * @param motions 1 to 4
   * @param x the pixel, in the coordinates of the positions
   * @param angle θ, direction of the image gradient, radians
   */
  motionsAtPixel(positions: Float64Array, derivatives: Float64Array, motions: number, x: number, y: number, angle: number): PixelStages;

  /** The singular values behind the rank rule for 1 to `largest` (at most 6) motions, without those for which measurements are too few. */
  embeddedSpectra(positions: Float64Array, derivatives: Float64Array, largest: number): Spectrum[];

  /**
   * One trial of the paper's Figure 1: 600 measurements of random motions.
   *
   * @param motions 2 to 4
   * @param noise half width of the uniform noise on derivatives of unit length, 0 to 0.05
   * @param seed a whole number from 0
   */
  figure1Trial(motions: number, noise: number, seed: number): Figure1Trial;

  /**
   * Generated measurements of given motions, by the protocol of Figure 1. With the same seed and shares, positions and labels stay as they are when
   * motions change, and derivatives change little with them.
   *
   * @param motions six entries for each of 1 to 10 motions
   * @param shares a share for each motion, up to scale
   * @param count 1 to 100 000
   * @param noise half width of the uniform noise on derivatives of unit length, 0 to 1
   * @param seed a whole number from 0
   */
  motionMeasurements(motions: Float64Array, shares: Float64Array, count: number, noise: number, seed: number): MotionMeasurements;

  /** `segmentPair` with what its stages found. */
  segmentPairStages(first: Pixels, second: Pixels, options?: Plain<SegmentOptions>): PairStages;

  /** As in the package, without times. */
  segmentPair(first: Pixels, second: Pixels, options?: Plain<SegmentOptions>): Omit<Segmentation, 'milliseconds'>;

  /** As in the package, without times. */
  fitMotions(positions: Float64Array, derivatives: Float64Array, options?: Omit<FitOptions, 'signal' | 'onProgress' | 'transfer'>): Omit<MotionFit, 'milliseconds'>;
}
