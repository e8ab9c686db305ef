// Code of a user; compiled under strict settings, never run.

import {
  type ClipAccepted,
  type ClipChange,
  type ClipCorrection,
  type ClipPrompt,
  type ClipEdits,
  type ClipFrame,
  type ClipMask,
  type ClipOptions,
  type ClipTracks,
  davisPalette,
  type ErrorCode,
  fitMotions,
  initPoints,
  groupLabels,
  init,
  type MotionFit,
  type Pixels,
  type Segmentation,
  Segmenter,
  SegmenterPool,
  segmentClip,
  segmentPair,
  segmentPairs,
  VeroneseError,
  version,
} from 'veronese';
import { decodeImage } from 'veronese/codecs';
import { type CocoVideoDocument, encodeCocoRle, encodeCocoVideo, encodeCvatVideo, type LabelFrame } from 'veronese/formats';
import { Segmenter as SlimSegmenter } from 'veronese/slim';

export async function pictures(bitmap: ImageBitmap, frame: VideoFrame, file: File, image: HTMLImageElement, canvas: HTMLCanvasElement | OffscreenCanvas): Promise<void> {
  await segmentPair(bitmap, frame);
  await new Segmenter().segmentPair(file, canvas);
  for await (const { labels } of segmentClip([image, file, canvas, bitmap, frame])) console.log(labels);
  for await (const { error } of segmentPairs([{ first: bitmap, second: file }])) console.log(error);
  // @ts-expect-error no picture
  await segmentPair(5, document);
}

export async function browser(first: ImageData, second: ImageData): Promise<string> {
  await init(new URL('/veronese_bg.wasm', location.href));
  await initPoints(new URL('/veronese_points_bg.wasm', location.href));
  const controller = new AbortController();
  const segmentation: Segmentation = await segmentPair(first, second, {
    motions: 3,
    quality: 'fast',
    signal: controller.signal,
    transfer: true,
    onProgress: ({ stage, index, of }) => console.log(stage, index / of),
  });
  const colours: [number, number, number][] = davisPalette();
  const [dominant] = segmentation.motions;
  const groups: Uint8Array = groupLabels(segmentation);
  return `${version} ${dominant?.matrix[2]} ${groups.length} ${colours[1]?.[2]}`;
}

export async function node(first: Uint8Array, second: Uint8Array): Promise<MotionFit | ErrorCode> {
  const segmenter = new Segmenter(WebAssembly.compile(new Uint8Array(8)));
  const warm: Promise<void> = segmenter.warmUp();
  await warm;
  try {
    const frames: Pixels[] = [await decodeImage(first), await decodeImage(second)];
    await segmenter.segmentPair(frames[0] as Pixels, frames[1] as Pixels);
    return await fitMotions({ positions: new Float64Array(2), derivatives: new Float64Array(3) }, { method: 'paper' });
  } catch (error) {
    if (error instanceof VeroneseError) return error.code;
    throw error;
  } finally {
    segmenter.close();
  }
}

export async function clip(frames: LabelFrame[], later: AsyncIterable<LabelFrame>): Promise<string> {
  const document: CocoVideoDocument = encodeCocoVideo(frames, { tracked: true, frameRate: 25 });
  const promise: Promise<string> = encodeCvatVideo(later, { clip: 'a.mp4' }, { shape: 'box' });
  // @ts-expect-error frames that come later give a promise
  const text: string = encodeCvatVideo(later);
  return `${document.videos.length} ${await promise} ${text}`;
}

export async function follow(frames: AsyncIterable<ImageData>, read: (index: number) => Promise<Pixels>): Promise<ClipTracks> {
  const stream = segmentClip(frames, { lookAhead: 2, quality: 'fast', motions: 'auto', onProgress: ({ frame, of }) => console.log(frame, of) });
  for await (const { index, labels, objects, background } of stream) console.log(index, labels.length, objects[0]?.matrix?.[2], background);
  const segmenter = new Segmenter();
  const whole = segmenter.segmentClip({ length: 32, read }, { lookAhead: 'all', markUnknown: true, signal: AbortSignal.timeout(1000) });
  const first: IteratorResult<ClipFrame, void> = await whole.next();
  if (!first.done) console.log(first.value.index);
  const state: Uint8Array | undefined = await whole.state();
  const corrections: ClipCorrection[] = [{ frame: 3, labels: new Uint8Array(64 * 48), propagate: 'forward' }];
  const prompts: ClipPrompt[] = [{ frame: 1, label: 7, box: [2, 3, 20, 10] }, { frame: 2, label: 8, click: [5, 5], propagate: 'none' }];
  prompts.push({ frame: 2, object: 9, clicks: [[5, 5, 1], [9, 5, -1]], box: [2, 3, 20, 10] }, { frame: 3, object: 9 });
  // @ts-expect-error a click is the object's or is not
  prompts.push({ frame: 2, object: 9, clicks: [[5, 5, 0]] });
  corrections.push({ frame: 3, object: 2, labels: new Uint8Array(64 * 48) });
  const accepted: ClipAccepted[] = [4, { frame: 5, labels: new Uint8Array(64 * 48) }];
  // @ts-expect-error a box has four numbers
  prompts.push({ frame: 1, label: 7, box: [2, 3] });
  const masks: ClipMask[] = [
    { frame: 0, labels: new Uint8Array(64 * 48) },
    { frame: 1, labels: new ImageData(64, 48), propagate: 'none' },
    { frame: 1, png: new Uint8Array(99) },
    { frame: 2, id: 7, rle: encodeCocoRle(new Uint8Array(64 * 48), 64, 48) },
  ];
  const onChange = async (index: number, segmented: () => Promise<ClipFrame>) => console.log(index, (await segmented()).labels.length);
  void segmentClip({ length: 32, read }, { masks, locked: [2], onChange });
  // @ts-expect-error run lengths are of an object with a number
  void segmentClip({ length: 32, read }, { masks: [{ frame: 2, rle: { size: [48, 64], counts: '' } }] });
  const edits: ClipEdits = { merge: [[2, 5]], delete: [3], background: [4], names: { 1: 'car' } };
  const pairs = new Map<number, Uint8Array>();
  const kept: ClipOptions = { onPairs: (index, bytes) => void pairs.set(index, bytes), knownPairs: async (index) => pairs.get(index) };
  const again = segmentClip({ length: 32, read }, { state, corrections: [...corrections, ...prompts], prompts, accepted, edits, changesOnly: true, onProgress: ({ stage }) => console.log(stage), onPreview: ({ objects }) => console.log(objects.length), ...kept });
  const changes: ClipChange[] = await again.changes();
  console.log(again.tracks().objects[0]?.name, changes[0]?.gained);
  // @ts-expect-error a clip tells the confidence of objects alone
  segmentClip([], { confidence: true });
  return whole.tracks();
}

export function mistakes(frame: ImageData): void {
  // @ts-expect-error a misspelt option
  void segmentPair(frame, frame, { motion: 2 });
  // @ts-expect-error an unknown quality
  void segmentPair(frame, frame, { quality: 'good' });
  // @ts-expect-error no frame
  void segmentPair(frame);
  // @ts-expect-error lists instead of arrays of doubles
  void fitMotions({ positions: [1, 2], derivatives: [1, 2, 3] });
  // @ts-expect-error a code that does not exist
  void new VeroneseError('broken', 'a sentence');
}

export async function many(clip: AsyncIterable<Pixels & { time: number }>): Promise<number[]> {
  async function* pairs() {
    let first: (Pixels & { time: number }) | undefined;
    for await (const second of clip) {
      if (first) yield { first, second, time: first.time };
      first = second;
    }
  }
  const times: number[] = [];
  for await (const { index, input, segmentation, error } of segmentPairs(pairs(), { jobs: 2, quality: 'fast' })) {
    if (error) console.log(index, error.code);
    else times.push(input.time * segmentation.count);
  }
  const pool = new SegmenterPool({ jobs: 3, worker: () => new Worker('worker.js', { type: 'module' }) });
  pool.close();
  return times;
}

export function slim(): void {
  new SlimSegmenter(undefined, { worker: () => new Worker('worker.js', { type: 'module' }) }).close();
  // @ts-expect-error no worker
  new SlimSegmenter();
  // @ts-expect-error a misspelt option
  new SegmenterPool({ job: 3 });
  // @ts-expect-error a pair without its second frame
  void segmentPairs([{ first: new ImageData(16, 16) }]);
}
