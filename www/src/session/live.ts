//! The camera: each frame is segmented with the one before, at quality `fast`.

import { PageError } from '../common/errors.js';
import { strings } from '../common/strings.js';
import { NO_EDITS } from '../correction/edits.js';
import { frameFromBitmap } from '../frames/frame.js';
import type { LoadedFrame } from '../state/pair.js';
import { FRESH, type Result, type State, type Store } from '../state/state.js';
import { Segmenting } from './segmenting.js';

/** Longer side of the frames, pixels: small enough for a high rate. */
const LONGEST_SIDE = 480;
/** Weight of the newest time in the moving average. */
const NEWEST = 0.15;

/** Camera frames are fingerprinted by a counter, because none recurs. */
let seen = 0;

/** One segmented pair of the camera. */
interface View {
  readonly result: Result;
  /** Segmentations per second, a moving average. */
  readonly rate: number;
}

export class LiveView {
  readonly #store: Store;
  readonly #fail: (error: unknown) => void;
  readonly #segmenting = new Segmenting();
  /** Incremented by each start and stop, which ends earlier loops. */
  #turn = 0;
  #stream: MediaStream | null = null;

  constructor(store: Store, fail: (error: unknown) => void) {
    this.#store = store;
    this.#fail = fail;
  }

  /**
   * Switches the camera on and waits for its first result; the state does not change until then. Returns a function that shows this
   * result and those that follow.
   */
  async start(): Promise<() => void> {
    const turn = ++this.#turn;
    const current = (): boolean => turn === this.#turn;
    const stream = await openCamera();
    if (!current()) {
      end(stream);
      return () => undefined;
    }
    this.#stream = stream;
    try {
      const video = document.createElement('video');
      video.muted = true;
      video.playsInline = true;
      video.srcObject = stream;
      await video.play();
      const views = this.#views(video, current);
      const first = await views.next();
      return () => void this.#run(first, views, current);
    } catch (error) {
      if (current()) this.stop();
      throw error;
    }
  }

  /** Switches the camera off; the last result stays. */
  stop(): void {
    this.#turn += 1;
    this.#segmenting.close();
    if (this.#stream !== null) end(this.#stream);
    this.#stream = null;
    const { live, result } = this.#store.get();
    if (live === null) return;
    const run = result === null ? ({ phase: 'idle' } as const) : ({ phase: 'done', cause: 'found' } as const);
    this.#store.set({ live: null, run, found: result?.segmentation ?? null });
  }

  async #run(first: IteratorResult<View, void>, views: AsyncIterable<View>, current: () => boolean): Promise<void> {
    if (!current() || first.done) return;
    const { look } = this.#store.get();
    const kind = look.kind === 'objects' ? 'groups' : look.kind;
    this.#show(first.value, { timeline: null, tracked: null, found: null, edits: NO_EDITS, look: { ...look, ...FRESH, kind, view: 'second' } });
    try {
      for await (const view of views) this.#show(view);
    } catch (error) {
      if (!current()) return;
      this.stop();
      this.#fail(error);
    }
  }

  /** Segments each frame of the camera with the one before. */
  async *#views(video: HTMLVideoElement, current: () => boolean): AsyncGenerator<View, void> {
    let before: LoadedFrame | null = null;
    let milliseconds = 0;
    while (current()) {
      const began = performance.now();
      const frame: LoadedFrame = await frameFromBitmap(await createImageBitmap(video), { name: strings.cameraFrame, fingerprint: `camera ${++seen}` }, LONGEST_SIDE, began);
      if (!current()) return;
      if (before !== null && before.width === frame.width && before.height === frame.height) {
        const { settings } = this.#store.get();
        const segmentation = await this.#segmenting.run({ first: before, second: frame }, { ...settings, quality: 'fast' });
        if (!current()) return;
        if (segmentation !== null) {
          const waited = performance.now() - began;
          milliseconds = milliseconds === 0 ? waited : (1 - NEWEST) * milliseconds + NEWEST * waited;
          yield { result: { segmentation, pair: { first: before, second: frame }, waited, under: null }, rate: 1000 / milliseconds };
        }
      }
      before = frame;
      await new Promise(requestAnimationFrame);
    }
  }

  #show({ result, rate }: View, others: Partial<State> = {}): void {
    const { pair: before } = this.#store.get();
    const { pair } = result;
    this.#store.set({ ...others, pair, result, live: { rate }, run: { phase: 'live' } });
    for (const frame of [before.first, before.second]) if (frame !== pair.first && frame !== pair.second) frame?.bitmap.close();
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
