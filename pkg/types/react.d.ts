// Types of `veronese/react`: `veronese/element`, and the element in React's JSX. From React 19 on, lists of frames arrive as a property and
// `onresult` listens to the event `result`; before, both need a `ref`.

import type { DetailedHTMLProps, HTMLAttributes } from 'react';
import type { VeroneseSegmenterElement } from './element-class.js';
import type { VeroneseSegmenterAttributes, VeroneseSegmenterListeners, VeroneseSegmenterProperties } from './markup.js';

export * from './element.js';

declare module 'react' {
  namespace JSX {
    interface IntrinsicElements {
      'veronese-segmenter': DetailedHTMLProps<HTMLAttributes<VeroneseSegmenterElement>, VeroneseSegmenterElement> &
        VeroneseSegmenterAttributes &
        VeroneseSegmenterProperties &
        VeroneseSegmenterListeners<'on'>;
    }
  }
}
