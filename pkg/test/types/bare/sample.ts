// Code of a program that knows neither the DOM nor Node: a server at the edge, a plug-in of an editor. Compiled, never run.

import { type Pixels, segmentClip, Segmenter, segmentPair, segmentPairs, VeroneseError } from 'veronese';
import { decodeImage } from 'veronese/codecs';
import { encodeCoco, encodeCocoVideo, type LabelFrame } from 'veronese/formats';
import { init, SegmenterPool } from 'veronese/slim';

export type Others = [typeof import('veronese/inline'), typeof import('veronese/worker')];

export async function pair(file: Uint8Array, module: ArrayBuffer): Promise<string> {
  await init(module);
  const first: Pixels = await decodeImage(file);
  const { labels, width, height, motions } = await segmentPair(first, first, { quality: 'fast', motions: 'auto' });
  const document = encodeCoco(labels, width, height, { motions });
  // @ts-expect-error no picture
  await segmentPair(first, {});
  return `${document.annotations.length} ${new VeroneseError('cancelled', 'a sentence').code}`;
}

export async function clip(frames: Pixels[]): Promise<number> {
  const found: LabelFrame[] = [];
  for await (const { labels } of segmentClip(frames, { lookAhead: 2 })) found.push({ labels, width: 64, height: 48 });
  const segmenter = new Segmenter('veronese_bg.wasm');
  segmenter.close();
  const pool = new SegmenterPool({ worker: () => ({ postMessage: () => undefined, terminate: () => undefined }) });
  pool.close();
  for await (const { segmentation } of segmentPairs([], { jobs: 2 })) print(segmentation?.count);
  return encodeCocoVideo(found).videos.length;
}

declare function print(value: unknown): void;
