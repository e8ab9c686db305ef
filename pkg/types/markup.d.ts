// What <veronese-segmenter> takes where frameworks write it as markup.

import type { ClipFrames, VeroneseSegmenterEvents } from './element-class.js';

/** The element's own attributes. */
export interface VeroneseSegmenterAttributes {
  /** URL of the first frame. */
  first?: string | undefined;
  /** URL of the second frame. */
  second?: string | undefined;
  /** URL of a video, which takes precedence. */
  src?: string | undefined;
  motions?: 'auto' | number | `${number}` | undefined;
  quality?: 'fast' | 'best' | undefined;
  /** Whether masks of two frames are groups of motions. */
  grouped?: boolean | undefined;
  name?: string | undefined;
  disabled?: boolean | undefined;
  required?: boolean | undefined;
}

/** The properties that are no attributes. */
export interface VeroneseSegmenterProperties {
  frames?: ClipFrames | null | undefined;
  currentFrame?: number | undefined;
  selected?: number | null | undefined;
}

/** Listeners to the element's own events, under the name that a framework gives them. */
export type VeroneseSegmenterListeners<Prefix extends string> = {
  [Type in keyof VeroneseSegmenterEvents as `${Prefix}${Type}`]?: ((event: CustomEvent<VeroneseSegmenterEvents[Type]>) => void) | undefined;
};
