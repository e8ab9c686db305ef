//! What the page does: views call the parts, and read the state. The session makes the parts, and sends what concerns the masks on screen to
//! those of the pair or of the clip.

import type { Path, Stroke } from '../correction/strokes.js';
import { Projects } from '../projects/projects.js';
import type { Kind } from '../result/masks.js';
import type { Store } from '../state/state.js';
import { Camera } from './camera/camera.js';
import { Carrying } from './clip/carrying.js';
import { Objects } from './clip/objects.js';
import { ClipRuns } from './clip/runs.js';
import { ClipSegmenting } from './clip/segmenting.js';
import { KnownPairs } from './clip/known-pairs.js';
import { Spans } from './clip/spans.js';
import { Frames } from './frames.js';
import { Open } from './open.js';
import { Opening } from './opening.js';
import { Masks } from './pair/masks.js';
import { PairSegmenting } from './pair/segmenting.js';
import { Solving } from './pair/solving.js';
import { PairWorker } from './pair/worker.js';
import { Playing } from './playing.js';
import { Shown } from './shown.js';

export class Session {
  readonly open: Open;
  readonly frames: Frames;
  readonly play: Playing;
  readonly camera: Camera;
  /** Segmenting the pair, and the masks of the pair. */
  readonly pair: PairSegmenting;
  readonly masks: Masks;
  /** Segmenting the clip, and the objects of the clip. */
  readonly clip: ClipSegmenting;
  readonly objects: Objects;
  readonly projects: Projects;
  readonly #store: Store;
  readonly #opening: Opening;
  readonly #carrying: Carrying;
  readonly #shown: Shown;

  constructor(store: Store) {
    this.#store = store;
    const worker = new PairWorker();
    const solving = new Solving(store, worker);
    this.pair = new PairSegmenting(store, worker, solving);
    this.masks = new Masks(store, solving);
    this.#shown = new Shown(store, this.pair, solving, this.masks);
    const runs = new ClipRuns(store);
    const spans = new Spans(store, runs.segmenter);
    const known = new KnownPairs();
    this.clip = new ClipSegmenting(store, runs, spans, known, this.#shown);
    this.#carrying = new Carrying(store, runs, spans, this.#shown);
    this.objects = new Objects(store, this.#carrying);
    this.projects = new Projects(store, known);
    this.#opening = new Opening(store);
    this.camera = new Camera(store, this.#opening, this.pair, this.masks, this.clip);
    const { clip, masks, objects, projects, camera } = this;
    const common = { clip, projects, opening: this.#opening, shown: this.#shown };
    this.frames = new Frames(store, { ...common, masks, camera, worker });
    this.play = new Playing(store, this.frames, this.pair);
    this.open = new Open(store, { ...common, objects, frames: this.frames });
  }

  /** Shows masks of this kind. */
  show(kind: Kind): void {
    this.#shown.kind(kind);
  }

  /** Selects a mask. */
  select(mask: number | null): void {
    this.#shown.select(mask);
  }

  /** Begins a stroke with the selected mask. Returns what takes its path, or `null`, and tells why, if it would have no effect. */
  beginStroke(tool: Stroke['tool']): ((path: Path) => void) | null {
    return this.#ofClip ? this.objects.beginStroke(tool) : this.masks.beginStroke(tool);
  }

  undo(): void {
    if (this.#ofClip) this.#carrying.undo();
    else this.masks.undo();
  }

  redo(): void {
    if (this.#ofClip) this.#carrying.redo();
    else this.masks.redo();
  }

  /** Stops what is being opened, else the run on the pair, else that on the clip. What is on screen stays. */
  cancel(): void {
    const { run, opening } = this.#store.get();
    if (opening) this.#opening.stop();
    else if (run.phase === 'working') this.pair.cancel();
    else this.clip.cancel();
  }

  /** Shows a notice; with a code it is an error. */
  say(sentence: string, code: string | null = null): void {
    this.#store.say(sentence, code);
  }

  /** Whether the masks on screen are those of the clip. */
  get #ofClip(): boolean {
    return this.#store.get().look.kind === 'objects';
  }
}
