// Code of a user; compiled under strict settings, never run.

import {
  type Clip,
  type ClipAnnotation,
  type ClipChange,
  type ClipDeclaration,
  type ClipEntry,
  type ClipEvent,
  type ClipFrame,
  type ClipJournal,
  type ClipStep,
  type ClipTracks,
  davisPalette,
  type ErrorCode,
  fitMotions,
  groupLabels,
  init,
  initPoints,
  type MotionFit,
  openClip,
  type Pixels,
  type Segmentation,
  Segmenter,
  SegmenterPool,
  segmentPair,
  segmentPairs,
  segmentStream,
  solvePair,
  VeroneseError,
  version,
} from 'veronese';
import { decodeImage } from 'veronese/codecs';
import { type Annotations, encode, type EncodedFile, type Format, type LabelFrame, type LabelImage, readAnnotations, readMask } from 'veronese/formats';
import { Segmenter as SlimSegmenter } from 'veronese/slim';

export async function pictures(bitmap: ImageBitmap, frame: VideoFrame, file: File, image: HTMLImageElement, canvas: HTMLCanvasElement | OffscreenCanvas): Promise<void> {
  await segmentPair(bitmap, frame);
  await new Segmenter().segmentPair(file, canvas);
  for await (const { labels } of segmentStream([image, file, canvas, bitmap, frame])) console.log(labels);
  await (await openClip([image, file, canvas])).close();
  await solvePair(bitmap, file);
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

export async function formats(frames: LabelFrame[], later: AsyncIterable<LabelFrame>): Promise<string> {
  const names: Format[] = ['youtube-vis', 'davis'];
  const files: EncodedFile[] = await encode('cvat-video', frames, { clip: 'a.mp4', shape: 'box', frameRate: 25 });
  // @ts-expect-error that is no format
  await encode('labels', later);
  for (const format of names) files.push(...(await encode(format, later, { names: { 1: 'car' }, classes: ['car'] })));
  const { labels }: LabelImage = readMask(new ImageData(64, 48), { levels: 'exact' });
  const read: Annotations = readAnnotations([{ name: 'coco.json', bytes: new Uint8Array(9) }]);
  return files.map(({ name, content }) => `${name} ${content.length} ${labels.length} ${read.boxes.length}`).join();
}

export async function stream(frames: AsyncIterable<ImageData>): Promise<ClipTracks> {
  const stream = segmentStream(frames, { lookAhead: 2, quality: 'fast', motions: 'auto', onProgress: ({ frame }) => console.log(frame) });
  await encode('coco', stream);
  for await (const { index, labels, objects, background } of stream) console.log(index, labels.length, objects[0]?.matrix?.[2], background);
  // @ts-expect-error a stream does not know where it ends
  segmentStream(frames, { lookAhead: 'all' });
  // @ts-expect-error frames that are read in any order are a clip
  segmentStream({ length: 32, read: () => new ImageData(64, 48) });
  // @ts-expect-error clips have the confidence of objects alone
  segmentStream(frames, { confidence: true });
  return stream.tracks();
}

export async function clip(read: (index: number) => Promise<Pixels>, saved: Uint8Array): Promise<ClipTracks> {
  const segmenter = new Segmenter();
  const journal: ClipJournal = { read: async () => undefined, append: async () => undefined, replace: async () => undefined };
  const clip: Clip = await segmenter.openClip({ length: 32, read }, { journal, markUnknown: true, maxSize: 960 });
  await (await openClip([new ImageData(64, 48)], { saved })).close();
  await (await new SegmenterPool().openClip(['0.png', '1.png'], { journal: 'clip.journal' })).close();
  const unsubscribe: () => void = clip.subscribe((event: ClipEvent) => {
    if (event.type === 'progress') console.log(event.stage, event.done, event.of);
    else if (event.type === 'draft') console.log(event.frame.labels);
    else if (event.type === 'settled') console.log(event.step, event.error?.code);
    else if (event.type === 'kept') console.log(event.bytes);
  });
  const solved = new Map<number, Uint8Array>([[1, await segmenter.solvePair(await read(0), await read(1), { quality: 'fast' })]]);
  const range: ClipStep = clip.segment({ first: 0, last: 9, quality: 'fast', drafts: true, pairs: (frame) => solved.get(frame), signal: AbortSignal.timeout(1000) });
  for await (const { index, labels } of range) console.log(index, labels.length);
  const mask = new Uint8Array(64 * 48);
  const annotations: ClipAnnotation[] = [
    { frame: 3, object: 1, strokes: mask, propagate: 'forward' },
    { frame: 3, object: clip.nextObject, mask, propagate: 'exact' },
    { frame: 4, labels: mask, own: true },
    { frame: 5, object: 2, clicks: [[5, 5, 1], [9, 5, -1]], box: [2, 3, 20, 10] },
  ];
  const step = clip.annotate(...annotations);
  const shown: ClipFrame = await step.shown;
  const changes: readonly ClipChange[] = await step;
  await clip.describe(1, { name: 'car', class: 'vehicle', colour: [255, 0, 0] }, { coalesce: true });
  await Promise.all([clip.lock([1]), clip.accept('all'), clip.accept([3], false), clip.clear({ frame: 4 }), clip.merge(1, 2), clip.delete(3), clip.split(1, 4)]);
  const declaration: ClipDeclaration = { annotations, locked: [1], descriptions: { 1: { name: 'car' } }, merged: [[1, 2]], deleted: [3], accepted: [0] };
  await clip.replaceAnnotations(declaration);
  const isUndone: boolean = await clip.undo();
  const entry: ClipEntry | undefined = clip.objects[0];
  console.log(shown.index, changes[0]?.gained, isUndone, entry?.became, clip.frames[3]?.accepted, clip.steps.waiting, (await clip.save()).length);
  await encode('coco', [await clip.labels(3)]);
  unsubscribe();
  return clip.tracks();
}

export function mistakesOfClips(clip: Clip, frame: ImageData): void {
  const mask = new Uint8Array(4);
  // @ts-expect-error the quality is that of a range
  void openClip([frame], { quality: 'fast' });
  // @ts-expect-error a stream comes once
  void openClip((async function* () {})());
  // @ts-expect-error a clip looks at all frames
  void clip.segment({ lookAhead: 2 });
  // @ts-expect-error a mask is of an object
  void clip.annotate({ frame: 1, mask });
  // @ts-expect-error a box has four numbers
  void clip.annotate({ frame: 1, object: 7, box: [2, 3] });
  // @ts-expect-error a pixel belongs to the object or does not
  void clip.annotate({ frame: 1, object: 7, clicks: [[5, 5, 0]] });
  // @ts-expect-error that is no direction
  void clip.annotate({ frame: 1, object: 7, mask, propagate: 'all' });
  // @ts-expect-error frames by number
  void clip.accept('some');
  // @ts-expect-error the list is replaced, not changed
  clip.objects.push();
  // @ts-expect-error a pair that is solved has no confidence
  void solvePair(frame, frame, { confidence: true });
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
