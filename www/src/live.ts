//! The camera: one frame after another segmented against the one before, fast, with the rate shown.

import { UNTOUCHED } from './edits.js';
import { PageError } from './errors.js';
import { type LoadedFrame, frameFromBitmap } from './frames.js';
import { Segmenting } from './segmenting.js';
import { FRESH, type Store } from './state.js';
import { strings } from './strings.js';

/** Longer side of what is worked on: more is not seen at this speed. */
const LONGEST_SIDE = 480;
/** Weight of the newest time in the rate. */
const NEWEST = 0.15;

export class LiveView {
  readonly #store: Store;
  /** The pair that was open gives way to the camera. */
  readonly #leave: () => void;
  readonly #fail: (error: unknown) => void;
  readonly #segmenting = new Segmenting();
  /** Changes with every start and stop: a loop goes on as long as it is its own. */
  #turn = 0;
  #stream: MediaStream | null = null;

  constructor(store: Store, leave: () => void, fail: (error: unknown) => void) {
    this.#store = store;
    this.#leave = leave;
    this.#fail = fail;
  }

  async start(): Promise<void> {
    const turn = ++this.#turn;
    const current = (): boolean => turn === this.#turn;
    try {
      const stream = await openCamera();
      if (!current()) return end(stream);
      this.#stream = stream;
      const video = document.createElement('video');
      video.muted = true;
      video.playsInline = true;
      video.srcObject = stream;
      await video.play();
      this.#leave();
      const { look } = this.#store.get();
      this.#store.set({
        live: { rate: 0 },
        run: { phase: 'live' },
        result: null,
        found: null,
        edits: UNTOUCHED,
        look: { ...look, ...FRESH, view: 'second' },
      });
      await this.#loop(video, current);
    } catch (error) {
      if (!current()) return;
      this.stop();
      this.#fail(error);
    }
  }

  /** Switches the camera off; what was seen last stays. */
  stop(): void {
    this.#turn += 1;
    this.#segmenting.close();
    if (this.#stream !== null) end(this.#stream);
    this.#stream = null;
    const { live, result } = this.#store.get();
    if (live === null) return;
    const run = result === null ? ({ phase: 'idle' } as const) : ({ phase: 'done', after: 'found' } as const);
    this.#store.set({ live: null, run, found: result?.segmentation ?? null });
  }

  async #loop(video: HTMLVideoElement, current: () => boolean): Promise<void> {
    let before: LoadedFrame | null = null;
    let milliseconds = 0;
    while (current()) {
      const began = performance.now();
      const frame: LoadedFrame = await frameFromBitmap(await createImageBitmap(video), strings.cameraFrame, LONGEST_SIDE, began);
      if (!current()) return;
      if (before !== null && before.width === frame.width && before.height === frame.height) {
        const { settings } = this.#store.get();
        const segmentation = await this.#segmenting.run({ first: before, second: frame }, { ...settings, quality: 'fast' });
        if (!current()) return;
        if (segmentation !== null) {
          const took = performance.now() - began;
          milliseconds = milliseconds === 0 ? took : (1 - NEWEST) * milliseconds + NEWEST * took;
          this.#show(before, frame, segmentation, took, 1000 / milliseconds);
        }
      }
      before = frame;
      await new Promise(requestAnimationFrame);
    }
  }

  #show(first: LoadedFrame, second: LoadedFrame, segmentation: NonNullable<Awaited<ReturnType<Segmenting['run']>>>, waited: number, rate: number): void {
    const before = this.#store.get().pair;
    this.#store.set({
      pair: { first, second },
      result: { segmentation, pair: { first, second }, waited, under: null },
      live: { rate },
      run: { phase: 'live' },
    });
    for (const frame of [before.first, before.second]) if (frame !== first && frame !== second) frame?.bitmap.close();
  }
}

async function openCamera(): Promise<MediaStream> {
  try {
    return await navigator.mediaDevices.getUserMedia({ video: { width: { ideal: 640 }, height: { ideal: 480 }, facingMode: 'environment' }, audio: false });
  } catch {
    throw new PageError('no-camera', strings.errors.noCamera);
  }
}

function end(stream: MediaStream): void {
  for (const track of stream.getTracks()) track.stop();
}
