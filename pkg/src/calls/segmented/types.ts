// Types of a call of the page's, which keeps the states of a clip itself. They are no part of the package.

import type { ClipChange, ClipClick, ClipFrame, ClipTracks, FrameInput, SegmentOptions } from '../../../types/index.js';

/**
 * The frames of a clip, all of one size, in order. An iterable or async iterable is a stream: the next frame is asked for while one is worked
 * on, and may reuse its buffer. `{ length, read(index) }` is a whole clip: each frame is read for its pairs, then for its labels, and
 * in any order for corrections, and must be the same each time; some are read once more to say why nothing was found. An array is a stream
 * unless an option needs a whole clip.
 */
export type ClipSource =
  | Iterable<FrameInput | Promise<FrameInput>>
  | AsyncIterable<FrameInput>
  | { readonly length: number; read(index: number): FrameInput | Promise<FrameInput> };

/** Progress of a clip: work on a frame begins. */
export interface ClipProgress {
  /** Index of the frame, from 0. */
  frame: number;
  /** Number of frames, if the source has a `length`. */
  of: number | undefined;
  /**
   * The work that begins. A stream has the stage `pairs` alone. A whole clip has `pairs` for all frames, `corrections` for those that
   * corrections reach, and `labels` for all frames as they are returned.
   */
  stage: 'pairs' | 'corrections' | 'labels';
}

/** Where the annotations of a frame spread: to the frames before and after it, to one side alone, or nowhere. */
export type ClipPropagation = 'both' | 'forward' | 'backward' | 'none';

/** Labels of one frame of a clip that a person is certain of. */
export interface ClipCorrection {
  /** Index of the frame, from 0. Each frame has one correction of each object at most, and one label map. */
  frame: number;
  /**
   * The object that it is about, 1 to 254, and no other. Without it the labels are a map: it is about the objects that it names,
   * and its zeros are where none of these is. A map of 0 and 255 alone is an eraser: at its zeros there is no object.
   */
  object?: number | undefined;
  /** Default: that of a label map or mask of the frame, otherwise `'both'`. */
  propagate?: ClipPropagation | undefined;
  /**
   * One label per pixel, row by row: the number of an object, a number that no object has for a new object, 0 where none of the objects is
   * that it is about, or 255 where nothing is certain. With `object` there are the labels 0, 255 and its number; without 255, as of an
   * outline, they are its mask, to the pixel. It replaces what was painted in the frame of the same object, or as a map; one that is 255
   * everywhere takes it back.
   */
  labels: Uint8Array;
}

/**
 * Points to an object in one frame of a clip: its mask there is found at once, and the object is followed through the clip. Clicks and a box
 * together describe one object; it needs a box or a click that is its own. A prompt stays one: the next of the same object and frame
 * replaces it, and one without clicks and box takes it back. It is about no other object.
 */
export type ClipPrompt = {
  /** Index of the frame, from 0. Each frame has one prompt of each object at most. */
  frame: number;
  /** Default: that of a label map or mask of the frame, otherwise `'both'`. */
  propagate?: ClipPropagation | undefined;
} & {
  /** The number of the object, 1 to 254; one that no object has makes a new object. */
  object: number;
  /**
   * Pixels that belong to the object or do not; those that do are in the box, if there is one. In this order each adds the part around
   * it to the mask, or takes it away, unless the mask is as it says already.
   */
  clicks?: readonly ClipClick[] | undefined;
  /** First column, first row, width and height of a rectangle that has all of the object, pixels. */
  box?: readonly [x: number, y: number, width: number, height: number] | undefined;
};

/** A frame that a person finds right: its index, or with all its labels as the person saw them, one per pixel, row by row. */
export type ClipAccepted = number | { frame: number; labels?: Uint8Array | undefined };

/**
 * Changes of whole objects. Numbers that no object has change nothing, and are in a note (`object-missing`); a list that begins with one merges
 * nothing.
 */
export interface ClipEdits {
  /** Lists of objects that are one; the first number is kept. */
  merge?: readonly (readonly number[])[] | undefined;
  /** Objects that are none: they become background, and take no pixel of others. */
  delete?: readonly number[] | undefined;
  /** The same as `delete`. */
  background?: readonly number[] | undefined;
  /**
   * Names by number, for {@link ClipTrack.name}. A name protects an object: annotations of others do not change its pixels. Where this is
   * given, it replaces the names of a `state`.
   */
  names?: Readonly<Record<number, string>> | undefined;
  /** As the option `locked`. */
  locked?: readonly number[] | undefined;
}

/** Options of {@link segmentClip}; `motions` is the number of motions in each pair of consecutive frames. */
export interface ClipOptions extends Omit<SegmentOptions, 'confidence' | 'onProgress'> {
  /** Gives the label 255 to pixels whose evidence does not tell an object from the background. Default: false. */
  markUnknown?: boolean | undefined;
  /**
   * Number of frames that each frame waits for, 0 to 8, or `'all'`: as many as matter, of a whole clip. More frames give better masks.
   * Default: 8 for a stream, `'all'` for a whole clip. A number makes a stream of `{ length, read(index) }`, unless one of the options
   * below is given: they need a whole clip.
   */
  lookAhead?: number | 'all' | undefined;
  /**
   * Labels painted in some frames, with the numbers of an earlier run. It holds there to the pixel, and the objects that it is about are
   * followed from there through the clip. All count together, in any order. A correction of a frame that has a mask goes before it where it
   * says anything.
   *
   * Nothing that a person painted, gave, prompted, named, accepted or locked changes when something else is said; an object that was found
   * automatically changes by the pixels that another one takes from it or gives back.
   */
  corrections?: readonly (ClipCorrection | ClipPrompt)[] | undefined;
  /** Clicks and boxes that point to objects in some frames, after what is painted. They may be among the corrections as well. */
  prompts?: readonly ClipPrompt[] | undefined;
  /**
   * Frames that are right. From then on only what is painted or pointed to in such a frame changes labels there, and the objects in it are
   * followed from it as from a correction. Without `labels` a frame has those of now: as masks and a `state` have it, before corrections. Where
   * this is given, it replaces what a `state` has accepted; frames that stay accepted stay as they are.
   */
  accepted?: readonly ClipAccepted[] | undefined;
  /** Changes of whole objects, after the corrections. */
  edits?: ClipEdits | undefined;
  /**
   * Numbers of objects of which nothing changes a pixel, but annotations of themselves in the same call. New annotations of an object that the
   * `state` has locked are the error `object-locked`, and so it is to delete it or to merge it. Where this or that of the edits is
   * given, it replaces what a `state` has locked.
   */
  locked?: readonly number[] | undefined;
  /**
   * The bytes that {@link SegmentedClip.state} gave for the same frames. No pair is solved: frames are read for their labels and for corrections alone, and
   * `motions`, `quality`, `subject` and `lookAhead` are those of the state. Annotations stay until they are replaced or taken back;
   * corrections refer to the numbers before any edit, and edits stay. Bytes that are damaged or of another version
   * of this package are an `invalid-option`, as is a frame that has other pixels than the one that was segmented, when it is read.
   */
  state?: Uint8Array | undefined;
  /** Returns only the frames that `masks`, `corrections`, `prompts`, `accepted` and `edits` change. Default: false. */
  changesOnly?: boolean | undefined;
  /**
   * Called with the index of each frame that masks, corrections, prompts and edits change, as soon as they do: the annotated frame first, then
   * those to which it spreads. A frame may change again before it is returned; the clip returns frames in order, afterwards. `segmented`
   * gives the frame as it is now, until what the call returns is settled, and the clip waits for that. If it throws, the clip ends with that
   * exception.
   */
  onChange?: ((frame: number, segmented: () => Promise<ClipFrame>) => void | Promise<void>) | undefined;
  /**
   * Called with the results of the pairs of each frame, nearly all the work, as bytes. Kept and handed back by `knownPairs` they let a run
   * that was interrupted continue with the same results. Several workers solve frames in any order; calls may then overlap.
   */
  onPairs?: ((index: number, pairs: Uint8Array) => void | Promise<void>) | undefined;
  /**
   * Gives what `onPairs` was called with, if it is known. Bytes that are damaged, of another version of this package, or of other options,
   * another frame or other frames before it count as unknown. Asked when a frame is read, which may be some frames ahead.
   */
  knownPairs?: ((index: number) => Uint8Array | undefined | Promise<Uint8Array | undefined>) | undefined;
  /**
   * Called with each frame but the last as soon as its pairs are solved: the masks that they tell alone, to show while the clip is
   * segmented. They lack the evidence of other frames, and their objects may get other numbers. Each takes the time of its labels.
   */
  onPreview?: ((frame: ClipFrame) => void | Promise<void>) | undefined;
  /** `true`: frames are transferred; those of a whole clip only when they are read for their labels. See {@link CallOptions}. */
  transfer?: boolean | undefined;
  /** Called for each frame before work on it begins. If it throws, the clip ends with that exception. */
  onProgress?: ((progress: ClipProgress) => void) | undefined;
}

/**
 * The frames of a clip, in order, as they are finished. Leaving the loop or calling `return()` frees what the clip holds, some megabytes
 * and its worker. An iterator that is dropped before its end does so when it is collected as garbage; its source is not closed then.
 */
export interface SegmentedClip extends AsyncGenerator<ClipFrame, void, undefined> {
  /** The objects of the frames returned so far: complete after the last frame, whose objects have no matrix. */
  tracks(): ClipTracks;
  /**
   * A whole clip as bytes, corrections and edits included, for the option `state`: some kilobytes per frame, for the same version of this
   * package. Undefined before the first frame has been returned, and for a stream.
   */
  state(): Promise<Uint8Array | undefined>;
  /**
   * The changes by masks, corrections, prompts and accepted labels, by frame, then by object, with the numbers before any edit; edits are not
   * counted. Empty before the first frame has been returned, and for a stream.
   */
  changes(): Promise<ClipChange[]>;
}
