// What wasm-bindgen makes of src/wasm.rs, as far as it is used here; scripts/glue.mjs puts the JavaScript beside this in dist.

/** Makes the instance, unless there is one. */
export default function instantiate(source: { module_or_path: WebAssembly.Module }): Promise<unknown>;

/** Lets go of the instance: the next initialisation makes a new one. */
export function forgetInstance(): void;

type OnStage = (stage: string, index: number, of: number) => void;

export function segmentPair(
  first: unknown,
  second: unknown,
  before: unknown,
  options: unknown,
  onStage: OnStage,
): unknown;

export function relabel(
  first: unknown,
  second: unknown,
  before: unknown,
  matrices: Float64Array,
  groups: Uint8Array,
  labels: Uint8Array,
  evidence: Uint16Array,
  options: unknown,
  onStage: OnStage,
): unknown;

export function fitMotions(
  positions: Float64Array,
  derivatives: Float64Array,
  options: unknown,
  onStage: OnStage,
): unknown;

type PaintArguments = [labels: Uint8Array, width: number, height: number, palette: Uint8Array, opacity: number];

export function paintLabels(context: CanvasRenderingContext2D, ...rest: PaintArguments): void;
export function paintLabelsOffscreen(context: OffscreenCanvasRenderingContext2D, ...rest: PaintArguments): void;
