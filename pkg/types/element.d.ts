// Types of `veronese/element`: importing it registers `<veronese-segmenter>` if the environment has custom elements.

import type { VeroneseSegmenterElement } from './element-class.js';

export { VeroneseSegmenterElement } from './element-class.js';

declare global {
  interface HTMLElementTagNameMap {
    'veronese-segmenter': VeroneseSegmenterElement;
  }
}
