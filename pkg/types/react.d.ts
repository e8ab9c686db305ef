// Types of `veronese/react`: `veronese/element` as a component, and the element in React's JSX. The component works in pages that a server has
// rendered, where React gives the element itself neither properties nor listeners.

import type { DetailedHTMLProps, ForwardRefExoticComponent, HTMLAttributes, RefAttributes } from 'react';
import type { FrameSource, VeroneseSegmenterElement, VeroneseSegmenterEvents } from './element-class.js';
import type { VeroneseSegmenterAttributes, VeroneseSegmenterListeners, VeroneseSegmenterProperties } from './markup.js';

export * from './element.js';

interface Frames {
  /** The first frame: its URL, a file, a bitmap, or pixels. */
  first?: FrameSource | undefined;
  /** The second frame. */
  second?: FrameSource | undefined;
}

/** `onResult` hears the event `result`, and so on. */
type Listeners = {
  [Type in keyof VeroneseSegmenterEvents as `on${Capitalize<Type>}`]?: ((event: CustomEvent<VeroneseSegmenterEvents[Type]>) => void) | undefined;
};

type Own = Frames & Omit<VeroneseSegmenterAttributes, keyof Frames> & VeroneseSegmenterProperties & Listeners;

export type VeroneseSegmenterProps = Own & Omit<HTMLAttributes<VeroneseSegmenterElement>, keyof Own | 'children' | 'dangerouslySetInnerHTML'>;

/**
 * `<veronese-segmenter>`. Its `ref` is the element. Attributes, properties and listeners are given to it when the page runs in a browser; a
 * property that is `undefined` is left as it is.
 */
export const VeroneseSegmenter: ForwardRefExoticComponent<VeroneseSegmenterProps & RefAttributes<VeroneseSegmenterElement>>;

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
