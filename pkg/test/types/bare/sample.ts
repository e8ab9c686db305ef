// Code of a program that knows neither the DOM nor Node: a server at the edge, a plug-in of an editor. Compiled, never run.

import { openClip, type Pixels, Segmenter, segmentPair, segmentPairs, segmentStream, solvePair, VeroneseError } from 'veronese';
import { decodeImage } from 'veronese/codecs';
import { encode, type LabelFrame } from 'veronese/formats';
import { init, SegmenterPool } from 'veronese/slim';

export type Others = [typeof import('veronese/inline'), typeof import('veronese/worker')];

export async function pair(file: Uint8Array, module: ArrayBuffer): Promise<string> {
  await init(module);
  const first: Pixels = await decodeImage(file);
  const { labels, width, height, motions } = await segmentPair(first, first, { quality: 'fast', motions: 'auto' });
  const [document] = await encode('coco', { labels, width, height, motions });
  // @ts-expect-error no picture
  await segmentPair(first, {});
  return `${document?.name} ${new VeroneseError('cancelled', 'a sentence').code}`;
}

export async function clip(frames: Pixels[]): Promise<number> {
  const found: LabelFrame[] = [];
  for await (const { labels } of segmentStream(frames, { lookAhead: 2 })) found.push({ labels, width: 64, height: 48 });
  const clip = await openClip(frames);
  await clip.segment({ pairs: (frame) => solvePair(frames[frame - 1] as Pixels, frames[frame] as Pixels) });
  for await (const frame of clip.annotate({ frame: 0, object: 1, box: [2, 3, 20, 10] })) found.push(frame);
  clip[Symbol.dispose]();
  const segmenter = new Segmenter('veronese_bg.wasm');
  segmenter.close();
  const pool = new SegmenterPool({ worker: () => ({ postMessage: () => undefined, terminate: () => undefined }) });
  pool.close();
  for await (const { segmentation } of segmentPairs([], { jobs: 2 })) print(segmentation?.count);
  return (await encode('youtube-vis', found)).length;
}

declare function print(value: unknown): void;
