// For workerd, which compiles no bytes: the module is part of the program.

import module from './node_modules/veronese/wasm/veronese_bg.wasm';
import { init, segmentPair } from './node_modules/veronese/dist/slim.js';
import { first, second } from './frames.js';
import { labelHash } from './label-hash.js';

export default {
  async fetch() {
    await init(module);
    return new Response(await labelHash(await segmentPair(first, second)));
  },
};
