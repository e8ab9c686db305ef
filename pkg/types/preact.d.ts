// Types of `veronese/preact`: `veronese/element`, and the element in Preact's JSX. `onresult` listens to the event `result`.

import type { JSX } from 'preact';
import type { VeroneseSegmenterElement } from './element-class.js';
import type { VeroneseSegmenterAttributes, VeroneseSegmenterListeners, VeroneseSegmenterProperties } from './markup.js';

export * from './element.js';

declare module 'preact' {
  namespace JSX {
    interface IntrinsicElements {
      'veronese-segmenter': JSX.HTMLAttributes<VeroneseSegmenterElement> &
        VeroneseSegmenterAttributes &
        VeroneseSegmenterProperties &
        VeroneseSegmenterListeners<'on'>;
    }
  }
}
