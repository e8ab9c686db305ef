// Attributes, properties and listeners of <veronese-segmenter> where frameworks write it as markup.

import type { ClipFrames, VeroneseSegmenterEvents, VeroneseSegmenterMessages } from './element-class.js';

/** The element's own attributes. */
export interface VeroneseSegmenterAttributes {
  /** URL of the first frame. */
  first?: string | undefined;
  /** URL of the second frame. */
  second?: string | undefined;
  /** URL of a video, which takes precedence. */
  src?: string | undefined;
  /** Number of motions, 1 to 10, or `auto`, which is usual. */
  motions?: 'auto' | number | `${number}` | undefined;
  /** `best` for accuracy, which is usual, or `fast` for live use. */
  quality?: 'fast' | 'best' | undefined;
  /** Whether only the main subject is an object, as for a cut-out. */
  subject?: boolean | undefined;
  /** Whether masks of two frames are groups of motions. */
  grouped?: boolean | undefined;
  /** What else a person may do, any of `play`, `legend` and `zoom`, with spaces between. */
  controls?: string | undefined;
  /** The name under which a form gets the masks. */
  name?: string | undefined;
  /** Whether it takes no input and submits nothing; it still segments. */
  disabled?: boolean | undefined;
  /** Whether it is invalid without masks. */
  required?: boolean | undefined;
}

/** The properties that are no attributes. */
export interface VeroneseSegmenterProperties {
  messages?: Partial<VeroneseSegmenterMessages> | null | undefined;
  frames?: ClipFrames | null | undefined;
  currentFrame?: number | undefined;
  selected?: number | null | undefined;
}

/** Listeners to the element's own events, under the name that a framework gives them. */
export type VeroneseSegmenterListeners<Prefix extends string> = {
  [Type in keyof VeroneseSegmenterEvents as `${Prefix}${Type}`]?: ((event: CustomEvent<VeroneseSegmenterEvents[Type]>) => void) | undefined;
};
