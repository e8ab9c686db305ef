// Types of `veronese/element`: importing it registers `<veronese-segmenter>` where elements can be registered.

import type { VeroneseSegmenterElement } from './element-class.js';

export { VeroneseSegmenterElement } from './element-class.js';

declare global {
  interface HTMLElementTagNameMap {
    'veronese-segmenter': VeroneseSegmenterElement;
  }
}
