//! Encodes a video of a clip's objects. Of a transparent video the colours and the alpha are two streams, encoded with the same codec and
//! stored together (WebM's BlockAdditions). Loaded, with mediabunny, when a video is saved.

import { BufferTarget, EncodedPacket, EncodedVideoPacketSource, Mp4OutputFormat, Output, WebMOutputFormat } from 'mediabunny';
import { FRAMES_PER_SECOND } from '../clips/clip.js';
import type { ClipExport } from './clip-export.js';
import { type Ground, colours, drawn, matteOf } from './cut-out.js';
import { H264 } from './video-codecs.js';

/** Seconds between frames from which a player can start. */
const KEY_FRAMES = 2;
/** Bits for each pixel of a frame, and the least a second. */
const BITS_PER_PIXEL = 0.15;
const LEAST_BITRATE = 2e6;
/** Frames that wait for an encoder, and how long until it is asked again, milliseconds. */
const QUEUE = 4;
const PATIENCE = 4;

interface Encoded {
  readonly chunk: EncodedVideoChunk;
  readonly meta: EncodedVideoChunkMetadata | undefined;
}

export async function videoOf(exported: ClipExport, ground: Ground, codec: string): Promise<Blob> {
  const { count } = exported;
  const times = exported.meta.timestamps;
  const startOf = (k: number): number => times?.[k] ?? k / FRAMES_PER_SECOND;
  // The last frame is shown as long as the one before.
  const endOf = (k: number): number => (k + 1 < count ? startOf(k + 1) : startOf(k) + (k > 0 ? startOf(k) - startOf(k - 1) : 1 / FRAMES_PER_SECOND));
  const rate = count / endOf(count - 1);
  // H.264 has only even sizes.
  const even = (side: number): number => (codec === H264 ? side - (side % 2) : side);
  let streams: Stream[] = [];
  let lastKey = -Infinity;
  let k = 0;
  try {
    for await (const frame of exported.frames()) {
      const [width, height] = [even(frame.width), even(frame.height)];
      if (k === 0) streams = Array.from({ length: ground === 'transparent' ? 2 : 1 }, () => new Stream({ codec, width, height, framerate: rate, bitrate: Math.max(LEAST_BITRATE, BITS_PER_PIXEL * rate * width * height) }));
      const [start, end] = [startOf(k), endOf(k)];
      const timing = { timestamp: Math.round(1e6 * start), duration: Math.round(1e6 * (end - start)) };
      const keyFrame = start - lastKey >= KEY_FRAMES;
      if (keyFrame) lastKey = start;
      const canvas = ground === 'transparent' ? await colours(exported, frame) : await drawn(exported, frame, ground);
      await streams[0]!.add(new VideoFrame(cropped(canvas, width, height), timing), keyFrame);
      if (ground === 'transparent') await streams[1]!.add(alphaFrame(matteOf(frame), width, height, timing), keyFrame);
      k += 1;
    }
    const [video = [], alpha] = await Promise.all(streams.map((stream) => stream.end()));
    return await stored(video, alpha ?? null, codec);
  } finally {
    for (const stream of streams) stream.close();
  }
}

function cropped(canvas: OffscreenCanvas, width: number, height: number): OffscreenCanvas {
  if (canvas.width === width && canvas.height === height) return canvas;
  const smaller = new OffscreenCanvas(width, height);
  smaller.getContext('2d')!.drawImage(canvas, 0, 0);
  return smaller;
}

/** Alpha as the luma of a grey frame. */
function alphaFrame(alpha: Uint8Array<ArrayBuffer>, width: number, height: number, timing: Pick<VideoFrameInit, 'duration'> & { timestamp: number }): VideoFrame {
  const chroma = 2 * Math.ceil(width / 2) * Math.ceil(height / 2);
  const planes = new Uint8Array(width * height + chroma).fill(128);
  planes.set(alpha);
  return new VideoFrame(planes, { ...timing, format: 'I420', codedWidth: width, codedHeight: height });
}

/** The frames of one encoder. */
class Stream {
  readonly #chunks: Encoded[] = [];
  readonly #encoder: VideoEncoder;
  #failure: Error | null = null;

  constructor(config: VideoEncoderConfig) {
    this.#encoder = new VideoEncoder({
      output: (chunk, meta) => void this.#chunks.push({ chunk, meta }),
      error: (error) => void (this.#failure = error),
    });
    this.#encoder.configure(config);
  }

  /** Takes ownership of the frame, and waits while there are too many. */
  async add(frame: VideoFrame, keyFrame: boolean): Promise<void> {
    try {
      if (this.#failure !== null) throw this.#failure;
      this.#encoder.encode(frame, { keyFrame });
    } finally {
      frame.close();
    }
    while (this.#encoder.encodeQueueSize > QUEUE) await new Promise((resolve) => setTimeout(resolve, PATIENCE));
  }

  async end(): Promise<readonly Encoded[]> {
    await this.#encoder.flush();
    if (this.#failure !== null) throw this.#failure;
    return this.#chunks;
  }

  close(): void {
    if (this.#encoder.state !== 'closed') this.#encoder.close();
  }
}

async function stored(video: readonly Encoded[], alpha: readonly Encoded[] | null, codec: string): Promise<Blob> {
  const target = new BufferTarget();
  const format = codec === H264 ? new Mp4OutputFormat() : new WebMOutputFormat();
  const output = new Output({ format, target });
  const source = new EncodedVideoPacketSource(codec === H264 ? 'avc' : 'vp9');
  output.addVideoTrack(source, { canBeTransparent: alpha !== null });
  await output.start();
  const alphaAt = new Map((alpha ?? []).map(({ chunk }) => [chunk.timestamp, chunk]));
  for (const { chunk, meta } of video) {
    const own = alphaAt.get(chunk.timestamp);
    await source.add(EncodedPacket.fromEncodedChunk(chunk, own === undefined ? {} : { alpha: bytesOf(own) }), meta);
  }
  await output.finalize();
  return new Blob([target.buffer!], { type: format.mimeType });
}

function bytesOf(chunk: EncodedVideoChunk): Uint8Array {
  const bytes = new Uint8Array(chunk.byteLength);
  chunk.copyTo(bytes);
  return bytes;
}
