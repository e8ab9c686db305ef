//! The actions of the page, in parts: views call them, and read the state. Here they are put together.

import { Projects } from '../projects/projects.js';
import type { Store } from '../state/state.js';
import { Camera } from './camera/camera.js';
import { Objects } from './clip/objects.js';
import { ClipSegmenting } from './clip/segmenting.js';
import { Frames } from './frames.js';
import { Open } from './open.js';
import { Opening } from './opening.js';
import { PairSegmenting } from './pair/segmenting.js';
import { PairWorker } from './pair/worker.js';
import { Playing } from './playing.js';
import { Shown } from './shown.js';

export interface Session {
  readonly open: Open;
  readonly frames: Frames;
  readonly play: Playing;
  readonly camera: Camera;
  readonly shown: Shown;
  /** The view of the pair. */
  readonly pair: PairSegmenting;
  /** Segmenting the clip, and the objects of the clip. */
  readonly clip: ClipSegmenting;
  readonly objects: Objects;
  readonly projects: Projects;
  /** Takes back the last edit of the objects, which are shown; or brings it back. */
  undo(): void;
  redo(): void;
  /** Stops what is being opened, else the run on the pair, else that on the clip. What is on screen stays. */
  cancel(): void;
  /** Shows a notice; with a code it is an error. */
  say(sentence: string, code?: string | null): void;
}

export function sessionOf(store: Store): Session {
  const worker = new PairWorker();
  const pair = new PairSegmenting(store, worker);
  const shown = new Shown(store, pair);
  const projects = new Projects(store);
  const clip = new ClipSegmenting(store, shown, projects);
  projects.living = () => clip.living;
  const objects = new Objects(store, clip);
  const opening = new Opening(store);
  const camera = new Camera(store, { opening, pair, clip, objects, openLast: () => open.pair() });
  const frames = new Frames(store, { opening, worker, camera, clip, pair, objects, shown, projects });
  const open = new Open(store, { opening, frames, projects, clip, objects, shown });
  return {
    open,
    frames,
    play: new Playing(store, frames, pair),
    camera,
    shown,
    pair,
    clip,
    objects,
    projects,
    undo: () => {
      shown.choose('objects');
      void clip.living?.undo();
    },
    redo: () => {
      shown.choose('objects');
      void clip.living?.redo();
    },
    cancel: () => {
      const { run } = store.get();
      if (opening.isUnderWay) opening.stop();
      else if (run.phase === 'working') pair.cancel();
      else clip.cancel();
    },
    say: (sentence, code) => store.say(sentence, code),
  };
}
