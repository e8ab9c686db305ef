// The tracks of a clip's objects, collected frame by frame.

import type { ClipChange, ClipFrame, ClipTrack, ClipTracks } from '../../../types/index.js';
import type { PlacedClip } from './place.js';

/** The results of a clip besides its frames, and where they are kept until it ends. */
export interface ClipResults {
  tracks: Tracks;
  state?: Uint8Array;
  /** The changes by annotations. */
  changes?: ClipChange[];
  clip?: PlacedClip;
}

/** The objects of a frame. */
export type FoundFrame = Omit<ClipFrame, 'labels'>;

export class Tracks {
  readonly #objects = new Map<number, ClipTrack>();
  readonly #background: ClipTracks['background'] = [];
  #last = -1;
  dropped = 0;
  names: ReadonlyMap<number, string> = new Map();

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
    return structuredClone({ objects, background: this.#background, dropped: this.dropped });
  }

  #named({ id, ...rest }: ClipTrack): ClipTrack {
    const name = this.names.get(id);
    return { id, ...(name !== undefined && { name }), ...rest };
  }
}
