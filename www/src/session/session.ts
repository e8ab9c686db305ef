//! The actions of the page, in parts: views call them, and read the state. Here they are put together.

import { Projects } from '../projects/projects.js';
import type { Store } from '../state/state.js';
import { Camera } from './camera/camera.js';
import { Objects } from './clip/objects.js';
import { ClipSegmenting } from './clip/segmenting.js';
import { Frames } from './frames.js';
import { Inspecting } from './inspecting.js';
import { Open } from './open.js';
import { Opening } from './opening.js';
import { Playing } from './playing.js';
import { Shown } from './shown.js';

export interface Session {
  readonly open: Open;
  readonly frames: Frames;
  readonly play: Playing;
  readonly camera: Camera;
  readonly shown: Shown;
  /** Segmenting the clip, and the objects of the clip. */
  readonly clip: ClipSegmenting;
  readonly objects: Objects;
  readonly projects: Projects;
  /** Takes back the last edit of the objects, which are shown; or brings it back. */
  undo(): void;
  redo(): void;
  /** Stops what is being opened, else the run on the clip. What is on screen stays. */
  cancel(): void;
  /** Shows a notice; with a code it is an error. */
  say(sentence: string, code?: string | null): void;
}

export function sessionOf(store: Store): Session {
  const shown = new Shown(store);
  const projects = new Projects(store);
  const clip = new ClipSegmenting(store, shown, projects);
  projects.living = () => clip.living;
  const objects = new Objects(store, clip);
  const opening = new Opening(store);
  const camera = new Camera(store, { opening, clip, objects, openLast: () => open.pair() });
  const frames = new Frames(store, { opening, camera, clip, objects, shown, projects });
  const open = new Open(store, { opening, frames, projects, clip, objects, shown });
  const inspecting = new Inspecting(store);
  store.subscribe(() => inspecting.follow());
  return {
    open,
    frames,
    play: new Playing(store, frames),
    camera,
    shown,
    clip,
    objects,
    projects,
    undo: () => {
      shown.objects();
      void clip.living?.undo();
    },
    redo: () => {
      shown.objects();
      void clip.living?.redo();
    },
    cancel: () => {
      if (opening.isUnderWay) opening.stop();
      else clip.cancel();
    },
    say: (sentence, code) => store.say(sentence, code),
  };
}
