// Types of `veronese/preact`: `veronese/element`, and the element in Preact's JSX. `onresult` listens to the event `result`.

import type { ClassAttributes, JSX } from 'preact';
import type { VeroneseSegmenterElement } from './element-class.js';
import type { VeroneseSegmenterAttributes, VeroneseSegmenterListeners, VeroneseSegmenterProperties } from './markup.js';

export * from './element.js';

/** Preact's own attributes of an element: versions differ in where they have them by name. */
type Ordinary = Omit<JSX.IntrinsicElements['div'], 'ref'> & ClassAttributes<VeroneseSegmenterElement>;

declare module 'preact' {
  namespace JSX {
    interface IntrinsicElements {
      'veronese-segmenter': Ordinary & VeroneseSegmenterAttributes & VeroneseSegmenterProperties & VeroneseSegmenterListeners<'on'>;
    }
  }
}
