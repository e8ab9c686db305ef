// Types of `veronese/element-class`: the element's class, to register under a name of your own.

import type { Clip, ClipFrame, ClipTracks, FramePicture, Pixels, Progress, Segmentation, VeroneseError, WasmSource, WorkerLike } from './index.js';

/** A frame: a URL, a picture such as a file or a bitmap, or pixels. */
export type FrameSource = string | URL | FramePicture | Pixels;

/**
 * The frames of a clip, all of one size, in order. Frames of an array and of `{ length, read(index) }` are read again when they are
 * shown, so they must stay the same. An iterable or async iterable is a stream, such as a camera: each frame is taken once, and a
 * compressed copy of its picture is kept.
 */
export type ClipFrames =
  | readonly FrameSource[]
  | { readonly length: number; read(index: number): FrameSource | Promise<FrameSource> }
  | Iterable<FrameSource | Promise<FrameSource>>
  | AsyncIterable<FrameSource>;

/** The events of the element's own, each with what its `detail` holds. */
export interface VeroneseSegmenterEvents {
  /** Work goes on: on two frames, or on a frame of a clip, whose progress has a `frame`. */
  progress: Progress | ElementClipProgress;
  /** Two frames are segmented. */
  result: Segmentation;
  /** A frame of a clip has new labels: it is segmented, or a step of the element's `clip` has changed it. */
  frame: ClipFrame;
  /** All frames of a clip are done, or another step of it has taken effect. */
  tracks: ClipTracks;
  /** A frame of a clip is shown, or shown again with other labels. */
  show: { index: number; width: number; height: number; labels: Uint8Array };
  /** A person has chosen an object, or none. */
  select: number | null;
  /** Frames could not be read, segmented or shown. */
  error: VeroneseError;
}

/** The progress of a clip. `of` is the number of frames to segment; an annotation that spreads has none. Of a stream there is only `frame`. */
export interface ElementClipProgress {
  frame: number;
  stage?: 'pairs' | 'annotations';
  done?: number;
  of?: number | undefined;
}

export type VeroneseSegmenterEventMap = Omit<HTMLElementEventMap, keyof VeroneseSegmenterEvents> & {
  [Type in keyof VeroneseSegmenterEvents]: CustomEvent<VeroneseSegmenterEvents[Type]>;
};

/** The texts of the element. Numbers of frames begin with 1. */
export interface VeroneseSegmenterMessages {
  /** What the picture is, for those who do not see it. */
  noFrame: string;
  pair: (motions: number) => string;
  frame: (number: number, of: number, objects: number) => string;
  /** The list of objects, and each of them. */
  objects: string;
  object: (number: number) => string;
  /** The slider for the frames of a clip, and where it is. */
  timeline: string;
  time: (number: number, of: number) => string;
  /** The progress of a clip. */
  progress: string;
  /** The button that plays a clip, and stops it. */
  play: string;
  pause: string;
  /** Why a form cannot be submitted. */
  busy: string;
  missing: string;
  /** What went wrong, in the line of status and for forms. */
  error: (error: VeroneseError) => string;
}

/**
 * Segments two frames or a clip, and shows the masks over the frames.
 *
 * Attributes: `first` and `second` (image URLs), or `src` (URL of a video, which takes precedence); `motions` (`auto` or 1 to 10),
 * `quality` (`fast` or `best`), `subject` (only the main subject is an object), `grouped` (masks of two frames are groups of motions);
 * `controls` (any of `play`, `legend` and `zoom`); `name`, `disabled` and `required`. The element segments when it is connected and
 * whenever an attribute changes, and stops when it is disconnected.
 *
 * Frames that can be read again are a {@link clip}, which takes annotations. The frame that is shown is drawn again as soon as its labels
 * change. When a step has taken effect, or was undone, `frame` comes for each frame that it has changed, then `tracks`. A step that fails
 * rejects, and is no `error` of the element.
 *
 * Events: `progress`, `result`, `frame`, `tracks`, `show`, `select` and `error`, each with a `detail`. They do not bubble. Where
 * nothing is found, the picture's `status` says why, and so do the `notes` of `result` and `tracks`.
 *
 * Keyboard: in the picture, Up and Down choose an object, Home and End the first and the last, Escape none; Left and Right step through
 * the frames of a clip. Below it a clip has a slider for its frames. A click chooses the object under the pointer. With `zoom`, the wheel and the keys
 * + and - magnify the picture; 0 and a double click show all of it.
 *
 * Forms: under its `name`, the element submits indexed PNG files with the DAVIS palette, whose indices are {@link labels}: `labels.png`
 * of two frames, or one file for each frame of a clip that is done, `00000.png` and on, once the clip has ended or was aborted. It is
 * invalid while it works, an annotation that spreads included, after an error, and without masks if it is `required`. A reset shows the first frame and chooses no object.
 * A disabled element still segments, but takes no input and submits nothing.
 *
 * CSS: `--veronese-opacity`, `--veronese-background`, `--veronese-font`, `--veronese-status-colour`, `--veronese-status-background`,
 * `--veronese-focus-colour`, and `--veronese-colour-K` for mask K. Parts: `stage`, `view`, `picture`, `frame`, `masks`, `objects`, `object`,
 * `status`, `legend`, `entry`, `swatch`, and of a clip `timeline`, `progress`, `controls`, `play` and `number`.
 */
export class VeroneseSegmenterElement extends HTMLElement {
  /**
   * Where the workers of all elements and the module come from, where that is not beside the package: set it before an element is in a page.
   * As in `SegmenterPool`; `veronese/element/inline` needs neither.
   */
  static worker: (() => WorkerLike) | undefined;
  static source: WasmSource | Promise<WasmSource> | undefined;
  static readonly formAssociated: true;
  static readonly observedAttributes: string[];
  /** The last result of two frames; undefined for a clip. */
  readonly result: Segmentation | undefined;
  /** Sets both frames and segments them. Pixels and pictures are copied before the call returns. */
  setFrames(first: FrameSource, second: FrameSource): Promise<Segmentation>;
  /**
   * The frames of a clip, in place of what the attributes name. Setting them cancels what is running, closes the clip before, and segments
   * them, if the element is connected. `undefined` or `null` goes back to the attributes.
   */
  get frames(): ClipFrames | undefined;
  set frames(frames: ClipFrames | undefined | null);
  /** Texts in place of the English ones, such as those of another language. */
  get messages(): Partial<VeroneseSegmenterMessages>;
  set messages(messages: Partial<VeroneseSegmenterMessages> | undefined | null);
  /** The attribute `src`. Setting it takes the place of frames that were set by a script. */
  src: string;
  /** Number of frames of a clip that are done. */
  readonly frameCount: number;
  /** Index of the frame of a clip that is shown, or will be once it is read, which the event `show` reports. Kept within the frames that are done. */
  currentFrame: number;
  /** The chosen object (or mask of two frames), null for none. Set by a script, it raises no event. */
  selected: number | null;
  /**
   * The clip, to annotate, to lock, to undo and to read; undefined for two frames, for a stream, and until it is open. It stays the same while
   * the frames do, also if an attribute changes, and is closed when the element gets other frames or is disconnected.
   */
  readonly clip: Clip | undefined;
  /** The objects of the frames of a clip that are done, as in the last event `tracks`; undefined for two frames. */
  tracks(): ClipTracks | undefined;
  /**
   * Segments the frames with the current attributes: two frames to a `Segmentation`, a clip to its tracks. A new call cancels the
   * previous one, which rejects with code `cancelled`. The same frames are segmented again in the same clip, which keeps its annotations. A stream that has ended cannot be segmented again.
   */
  segment(): Promise<Segmentation | ClipTracks>;
  /** Cancels all that has not taken effect; the last result is kept, and so are the frames of a clip that are done. */
  abort(): void;
  /** One number per pixel of what is shown: labels, or groups if the element is `grouped` or shows the `subject`; of a clip, objects. 255 is unlabelled. */
  labels(): Uint8Array | undefined;
  /** 255 where the label (group, object) is, 0 elsewhere. */
  mask(wanted: number): Uint8Array | undefined;
  /** The attribute of that name, as in other controls of forms. */
  name: string;
  disabled: boolean;
  required: boolean;
  /** The form that the element belongs to. */
  readonly form: HTMLFormElement | null;
  readonly validity: ValidityState;
  readonly validationMessage: string;
  readonly willValidate: boolean;
  checkValidity(): boolean;
  reportValidity(): boolean;
  addEventListener<K extends keyof VeroneseSegmenterEventMap>(
    type: K,
    listener: (this: VeroneseSegmenterElement, event: VeroneseSegmenterEventMap[K]) => unknown,
    options?: boolean | AddEventListenerOptions,
  ): void;
  addEventListener(type: string, listener: EventListenerOrEventListenerObject, options?: boolean | AddEventListenerOptions): void;
}
