// The tracks of a clip's objects, collected frame by frame.

import type { ClipFrame, ClipTrack, ClipTracks } from '../../types/index.js';

export class Tracks {
  readonly #objects = new Map<number, ClipTrack>();
  readonly #background: ClipTracks['background'] = [];
  dropped = 0;

  /** Adds the next frame and returns it. */
  add(frame: ClipFrame): ClipFrame {
    const { index, objects, background } = frame;
    for (const { id, ...seen } of objects) {
      const track = this.#objects.get(id) ?? { id, first: index, last: index, frames: [] };
      track.last = index;
      track.frames.push({ frame: index, ...seen });
      this.#objects.set(id, track);
    }
    if (background) this.#background.push({ frame: index, matrix: background });
    return frame;
  }

  /** A copy, which the caller may change. */
  value(): ClipTracks {
    const objects = [...this.#objects.values()].sort((one, other) => one.id - other.id);
    return structuredClone({ objects, background: this.#background, dropped: this.dropped });
  }
}
