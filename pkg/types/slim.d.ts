// veronese/slim and veronese/inline: everything of veronese, but nothing is looked for beside the code.
//
// In `veronese/slim` the module comes from `init(source)`, `new Segmenter(source, …)` or `source` of a pool, that of `fitMotions` from
// `initPoints(source)` or the option `points`; `veronese/inline` holds both.
// Workers are the caller's to make in both.

import {
  type PairInput,
  type PairOutcome,
  type PairsOptions,
  type PoolOptions,
  Segmenter as WholeSegmenter,
  type SegmenterOptions,
  SegmenterPool as WholePool,
  type WasmSource,
} from './index.js';

export * from './index.js';

/** {@link SegmenterOptions} with a worker that must be made by hand. */
export type WithWorker<Options extends SegmenterOptions> = Options & { worker: NonNullable<SegmenterOptions['worker']> };

/** As in `veronese`. */
export class Segmenter extends WholeSegmenter {
  constructor(source: WasmSource | Promise<WasmSource> | undefined, options: WithWorker<SegmenterOptions>);
}

/** As in `veronese`. */
export class SegmenterPool extends WholePool {
  constructor(options: WithWorker<PoolOptions>);
}

/** As in `veronese`. */
export function segmentPairs<Input extends PairInput>(
  pairs: Iterable<Input | Promise<Input>> | AsyncIterable<Input>,
  options: PairsOptions & WithWorker<PoolOptions>,
): AsyncGenerator<PairOutcome<Input>, void, undefined>;
