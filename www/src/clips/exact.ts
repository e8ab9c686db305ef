//! Exact frames of a video file: the file's packets say when each frame is shown, and a decoder gives the frame of that time. What
//! comes back is checked against the time asked for: a wrong frame is an error, never shown.

import { BlobSource, EncodedPacketSink, Input, type InputVideoTrack, MATROSKA, MP4, QTFF, VideoSampleSink, WEBM } from 'mediabunny';
import { PageError } from '../common/errors.js';
import { strings } from '../common/strings.js';
import { type DecodedFrame, frameFromBitmap } from '../frames/frame.js';
import { type Clip, type Picture, knownInFilm } from './clip.js';
import { codecName } from './codecs.js';

/** Times closer than this are the same, seconds: containers round them to their own clocks. */
const SAME_TIME = 1e-4;

/** `null` where the file is none that can be read and decoded here. */
export async function openExact(file: File, fingerprint: string): Promise<Clip | null> {
  const input = inputOf(file);
  try {
    const track = await input.getPrimaryVideoTrack();
    if (track === null || !(await track.canDecode())) {
      input.dispose();
      return null;
    }
    const times = await timesOf(track);
    if (times.length > 0) return new ExactClip(file.name, fingerprint, input, track, times);
  } catch {
    // No container that is known, or a damaged one: somebody else may read it.
  }
  input.dispose();
  return null;
}

function inputOf(file: File): Input {
  return new Input({ source: new BlobSource(file), formats: [MP4, QTFF, WEBM, MATROSKA] });
}

/** What the codec of a video is called that this browser has no decoder for; `null` where it has one, or where the file is none that can be read. */
export async function undecodable(file: File): Promise<string | null> {
  const input = inputOf(file);
  try {
    const track = await input.getPrimaryVideoTrack();
    if (track === null || (await track.canDecode())) return null;
    // Without WebCodecs nothing can be decoded here, and yet be played.
    const named = (await track.getCodecParameterString()) !== null;
    if (named && document.createElement('video').canPlayType(await input.getMimeType()) !== '') return null;
    const { internalCodecId } = track;
    return codecName(await track.getCodec(), typeof internalCodecId === 'string' ? internalCodecId : null);
  } catch {
    return null;
  } finally {
    input.dispose();
  }
}

/** When each frame is shown, in that order. */
async function timesOf(track: InputVideoTrack): Promise<Float64Array> {
  const times: number[] = [];
  for await (const packet of new EncodedPacketSink(track).packets(undefined, undefined, { metadataOnly: true })) {
    times.push(packet.timestamp);
  }
  return Float64Array.from(times).sort();
}

class ExactClip implements Clip {
  readonly exact = true;
  readonly count: number;
  readonly width: number;
  readonly height: number;
  readonly #sink: VideoSampleSink;

  constructor(
    readonly name: string,
    readonly fingerprint: string,
    readonly input: Input,
    track: InputVideoTrack,
    readonly times: Float64Array,
  ) {
    this.count = times.length;
    this.width = track.displayWidth;
    this.height = track.displayHeight;
    this.#sink = new VideoSampleSink(track);
  }

  async frame(index: number, longestSide: number): Promise<DecodedFrame> {
    const began = performance.now();
    const sample = await this.#sink.getSample(this.#asked(index));
    try {
      if (sample === null || Math.abs(sample.timestamp - this.times[index]!) > SAME_TIME) {
        throw new PageError('inexact-frame', strings.errors.inexactFrame(this.name, index));
      }
      const canvas = new OffscreenCanvas(sample.displayWidth, sample.displayHeight);
      const context = canvas.getContext('2d', { alpha: false });
      if (context === null) throw new PageError('unsupported-browser', strings.errors.noCanvas);
      sample.draw(context, 0, 0);
      return await frameFromBitmap(canvas.transferToImageBitmap(), knownInFilm(this.name, this.fingerprint, index), longestSide, began);
    } finally {
      sample?.close();
    }
  }

  async thumbnails(indices: readonly number[], draw: (index: number, picture: Picture) => void): Promise<void> {
    let k = 0;
    for await (const sample of this.#sink.samplesAtTimestamps(indices.map((index) => this.#asked(index)))) {
      const index = indices[k++];
      if (sample === null) continue;
      if (index !== undefined) draw(index, (context, x, y, width, height) => sample.draw(context, x, y, width, height));
      sample.close();
    }
  }

  close(): void {
    this.input.dispose();
  }

  /** A time inside the frame: its beginning may be rounded to before itself. */
  #asked(index: number): number {
    const [now, next] = [this.times[index]!, this.times[index + 1]];
    return now + Math.min(SAME_TIME, next === undefined ? SAME_TIME : (next - now) / 2);
  }
}
