//! The camera: its frames are a clip that never ends, segmented at quality `fast` as they come. Objects keep their numbers and colours.

import { type Pixels, Segmenter } from 'veronese';
import { PageError } from '../../common/errors.js';
import { strings } from '../../common/strings.js';
import { packed } from '../../result/runs.js';
import { frameFromBitmap } from '../../frames/frame.js';
import type { FrameMasks } from '../../result/masks.js';
import { masksFrom } from '../../state/objects.js';
import type { FramePair, LoadedFrame } from '../../state/pair.js';
import { FRESH, type Result, type State, type Store } from '../../state/state.js';
import { report } from '../failures.js';
import { Numbering } from './numbering.js';

/** Longer side of the frames, pixels: small enough for a high rate. */
const LONGEST_SIDE = 480;
/** Weight of the newest time in the moving average. */
const NEWEST = 0.15;
/** Milliseconds after which a picture is taken again though the camera has given no other, or the browser does not say so. */
const LONGEST_WAIT = 250;
/** After this number another stream takes over: there are 254. */
const LAST_NUMBER = 200;

/** Camera frames are fingerprinted by a counter, because none recurs. */
let seen = 0;

/** One frame of the camera with its masks, and the one before. */
interface View {
  readonly pair: FramePair;
  readonly result: Result;
  /** Frames per second, a moving average. */
  readonly rate: number;
}

export class LiveView {
  readonly #store: Store;
  readonly #segmenter = new Segmenter();
  /** Incremented by each start and stop, which ends earlier loops. */
  #turn = 0;
  #stream: MediaStream | null = null;

  constructor(store: Store) {
    this.#store = store;
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
    // Until the camera gives its first picture.
    this.#segmenter.warmUp().catch(() => undefined);
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

  /** Switches the camera off; the last two frames stay, without masks. */
  stop(): void {
    this.#turn += 1;
    this.#segmenter.close();
    if (this.#stream !== null) end(this.#stream);
    this.#stream = null;
    if (this.#store.get().live !== null) this.#store.set({ live: null, result: null });
  }

  async #run(first: IteratorResult<View, void>, views: AsyncIterable<View>, current: () => boolean): Promise<void> {
    if (!current() || first.done) return;
    const { look } = this.#store.get();
    this.#show(first.value, { timeline: null, tracked: null, look: { ...look, ...FRESH, motions: false, view: 'second' } });
    try {
      for await (const view of views) this.#show(view);
    } catch (error) {
      if (!current()) return;
      this.stop();
      report(this.#store, error);
    }
  }

  /** Segments the frames of the camera as a clip; other settings and another size of the frames begin another one. */
  async *#views(video: HTMLVideoElement, current: () => boolean): AsyncGenerator<View, void> {
    let milliseconds = 0;
    let last = performance.now();
    const numbering = new Numbering();
    while (current()) {
      numbering.renew();
      const { settings } = this.#store.get();
      const taken: LoadedFrame[] = [];
      let most = 0;
      let size = '';
      let answered = (): void => undefined;
      const frames = async function* (wanted: () => boolean): AsyncGenerator<Pixels, void> {
        while (wanted()) {
          const frame: LoadedFrame = await frameFromBitmap(await createImageBitmap(video), { name: strings.cameraFrame, fingerprint: `camera ${++seen}` }, LONGEST_SIDE, performance.now());
          const own = strings.size(frame.width, frame.height);
          if (!wanted() || (size !== '' && own !== size)) return frame.bitmap.close();
          size = own;
          taken.push(frame);
          const another = whenAnother(video);
          const { data, width, height } = frame;
          yield { data, width, height };
          // The package asks for a frame ahead, but one from before the last masks would be shown late.
          await new Promise<void>((resolve) => (answered = resolve));
          do await new Promise(requestAnimationFrame);
          while (wanted() && !another());
        }
      };
      const wanted = (): boolean => current() && most <= LAST_NUMBER && this.#store.get().settings === settings;
      const { motions, subject, markUnknown } = settings;
      let before: { readonly frame: LoadedFrame; readonly masks: FrameMasks } | null = null;
      try {
        for await (const found of this.#segmenter.segmentStream(frames(wanted), { motions, subject, markUnknown, quality: 'fast', lookAhead: 0 })) {
          answered();
          if (!current()) return;
          const frame = taken.shift()!;
          const { labels, objects } = numbering.numbered(found);
          const masks = masksFrom({ runs: packed(labels, frame.width, frame.height), objects });
          most = found.objects.reduce((larger, { id }) => Math.max(larger, id), most);
          const waited = performance.now() - last;
          last += waited;
          milliseconds = milliseconds === 0 ? waited : (1 - NEWEST) * milliseconds + NEWEST * waited;
          if (before !== null) {
            const result = { masks: before.masks, frame: before.frame, second: masks };
            yield { pair: { first: before.frame, second: frame }, result, rate: 1000 / milliseconds };
          }
          before = { frame, masks };
        }
      } finally {
        for (const { bitmap } of taken) bitmap.close();
      }
    }
  }

  #show({ pair, result, rate }: View, others: Partial<State> = {}): void {
    const { pair: before } = this.#store.get();
    this.#store.set({ ...others, pair, result, live: { rate } });
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

/** Whether the camera has given another picture since: the same one twice would say that nothing moves. */
function whenAnother(video: HTMLVideoElement): () => boolean {
  const since = performance.now();
  let given = false;
  if ('requestVideoFrameCallback' in video) video.requestVideoFrameCallback(() => (given = true));
  return () => given || performance.now() > since + LONGEST_WAIT;
}
