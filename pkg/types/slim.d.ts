// veronese/slim and veronese/inline: all of veronese, without loading files next to the code.
//
// With `veronese/slim` the caller provides the module through `init(source)`, `new Segmenter(source, …)` or `source` of a pool, and the
// module of `fitMotions` through `initPoints(source)` or the option `points`. `veronese/inline` embeds both.
// With either, the caller creates the workers.

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

/** {@link SegmenterOptions} with a worker that the caller must create. */
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
