// Types of `veronese/solid`: `veronese/element`, and the element in Solid's JSX. Solid sets what is not a literal as a property of the
// element, so that attributes that may change are written `attr:motions` and `bool:grouped`; `on:result` listens to the event `result`.

import type { JSX } from 'solid-js';
import type { VeroneseSegmenterElement } from './element-class.js';
import type { VeroneseSegmenterAttributes, VeroneseSegmenterListeners, VeroneseSegmenterProperties } from './markup.js';

export * from './element.js';

type Written = {
  [Name in keyof VeroneseSegmenterAttributes as boolean extends VeroneseSegmenterAttributes[Name] ? `bool:${Name}` : `attr:${Name}`]?: VeroneseSegmenterAttributes[Name];
};

type Set = {
  [Name in keyof VeroneseSegmenterProperties as `prop:${Name}`]?: VeroneseSegmenterProperties[Name];
};

declare module 'solid-js' {
  namespace JSX {
    interface IntrinsicElements {
      'veronese-segmenter': JSX.HTMLAttributes<VeroneseSegmenterElement> &
        VeroneseSegmenterAttributes &
        VeroneseSegmenterProperties &
        VeroneseSegmenterListeners<'on:'> &
        Written &
        Set;
    }
  }
}
