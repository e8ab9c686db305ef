// Registers <veronese-segmenter>, where elements can be registered and the name is free.

import { VeroneseSegmenterElement } from './element-class.js';

export { VeroneseSegmenterElement } from './element-class.js';

const NAME = 'veronese-segmenter';

if (typeof customElements !== 'undefined' && customElements.get(NAME) === undefined) {
  customElements.define(NAME, VeroneseSegmenterElement);
}
