// The tracks of a clip's objects, collected frame by frame.

import type { ClipFrame, ClipTrack, ClipTracks, Note, Pixels } from '../../../types/index.js';
import type { LabelledFrame } from '../messages.js';

export interface SeenPair {
  /** Of its first frame. */
  index: number;
  frames: readonly [Pixels, Pixels];
}

/** An object, and in how many of its frames it is as large as the ground. */
export interface Ground {
  id: number;
  large: number;
  of: number;
}

/** What tracks need of a frame: its objects, and those that are as large as the ground. */
export interface Seen {
  frame: FoundFrame;
  large: number[];
}

/** The objects of a frame. */
type FoundFrame = Omit<LabelledFrame, 'labels'>;

interface Size {
  width: number;
  height: number;
}

/** An object that covers more of the picture, or of its border, in most of its frames is none. */
const [MOST, MOST_OF_BORDER] = [0.5, 0.9];

export class Tracks {
  readonly #objects = new Map<number, ClipTrack>();
  readonly #background: ClipTracks['background'] = [];
  /** In how many frames objects cover most of the picture, or of its border. */
  readonly #large = new Map<number, number>();
  #last = -1;
  dropped = 0;
  notes: Note[] = [];
  names: ReadonlyMap<number, string> = new Map();

  get isEmpty(): boolean {
    return this.#objects.size === 0;
  }

  /** Adds a frame with its labels and returns it with its size. */
  see(found: LabelledFrame, size: Size): ClipFrame {
    const frame = sized(found, size);
    this.addSeen(seenIn(frame));
    return frame;
  }

  addSeen({ frame, large }: Seen): void {
    for (const id of large) this.#large.set(id, (this.#large.get(id) ?? 0) + 1);
    this.add(frame);
  }

  /** The objects that are likely to be the ground. */
  grounds(): Ground[] {
    const counted = [...this.#objects.values()].map(({ id, frames }) => ({ id, large: this.#large.get(id) ?? 0, of: frames.length }));
    return counted.filter(({ large, of }) => 2 * large > of);
  }

  /** Adds the next frame and returns it. */
  add<Frame extends FoundFrame>(frame: Frame): Frame {
    const { index, objects, background } = frame;
    for (const { id, ...seen } of objects) {
      const track = this.#objects.get(id) ?? { id, first: index, last: index, frames: [] };
      track.last = index;
      track.frames.push({ frame: index, ...seen });
      this.#objects.set(id, track);
    }
    if (background) this.#background.push({ frame: index, matrix: background });
    this.#last = index;
    return frame;
  }

  /** Ends a stream: nothing moves on from its last frame. */
  end(dropped: number): void {
    this.dropped = dropped;
    for (const { last, frames } of this.#objects.values()) if (last === this.#last) (frames.at(-1) as ClipTrack['frames'][0]).matrix = null;
    if (this.#background.at(-1)?.frame === this.#last) this.#background.pop();
  }

  /** A copy, which the caller may change. */
  value(): ClipTracks {
    const objects = [...this.#objects.values()].sort((one, other) => one.id - other.id).map((track) => this.#named(track));
    const { dropped, notes } = this;
    return structuredClone({ objects, background: this.#background, dropped, ...(notes.length > 0 && { notes }) });
  }

  #named({ id, ...rest }: ClipTrack): ClipTrack {
    const name = this.names.get(id);
    return { id, ...(name !== undefined && { name }), ...rest };
  }
}

export function seenIn({ labels, ...frame }: ClipFrame): Seen {
  const { width, height, objects } = frame;
  const isLarge = (id: number, pixels: number) => pixels > MOST * width * height || shareOfBorder(labels, id, frame) > MOST_OF_BORDER;
  return { frame, large: objects.flatMap(({ id, pixels }) => (isLarge(id, pixels) ? [id] : [])) };
}

export function sized(frame: LabelledFrame, { width, height }: Size): ClipFrame {
  return Object.assign(frame, { width, height });
}

function shareOfBorder(labels: Uint8Array, id: number, { width, height }: Size): number {
  let own = 0;
  for (let x = 0; x < width; x++) own += Number(labels[x] === id) + Number(labels[labels.length - 1 - x] === id);
  for (let y = 0; y < height; y++) own += Number(labels[y * width] === id) + Number(labels[(y + 1) * width - 1] === id);
  return own / (2 * (width + height));
}
