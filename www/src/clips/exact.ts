//! Exact frames of a video. The packets of the file give the presentation time of each frame, and a decoder returns the frame for a
//! time. Its timestamp is compared with the requested one: a wrong frame is an error and is never shown.

import { BlobSource, EncodedPacketSink, Input, type InputVideoTrack, MATROSKA, MP4, QTFF, type VideoSample, VideoSampleSink, WEBM } from 'mediabunny';
import { PageError } from '../common/errors.js';
import { strings } from '../common/strings.js';
import { type DecodedFrame, frameFromBitmap } from '../frames/frame.js';
import { type Clip, type Picture, fileNameOf, identityOf } from './clip.js';
import { codecName } from './codecs.js';

/** Times that differ by less are equal, seconds: containers round them to their own time base. */
const SAME_TIME = 1e-4;

/** `null` if this browser cannot read or decode the file. */
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
    // An unknown or damaged container.
  }
  input.dispose();
  return null;
}

function inputOf(file: File): Input {
  return new Input({ source: new BlobSource(file), formats: [MP4, QTFF, WEBM, MATROSKA] });
}

/** The name of a video's codec if this browser has no decoder for it; `null` if it has one or the file cannot be read. */
export async function undecodable(file: File): Promise<string | null> {
  const input = inputOf(file);
  try {
    const track = await input.getPrimaryVideoTrack();
    if (track === null || (await track.canDecode())) return null;
    const { internalCodecId } = track;
    return codecName(await track.getCodec(), typeof internalCodecId === 'string' ? internalCodecId : null);
  } catch {
    return null;
  } finally {
    input.dispose();
  }
}

/** The presentation times of all frames, ascending, seconds. */
async function timesOf(track: InputVideoTrack): Promise<Float64Array> {
  const times: number[] = [];
  for await (const packet of new EncodedPacketSink(track).packets(undefined, undefined, { metadataOnly: true })) {
    times.push(packet.timestamp);
  }
  return Float64Array.from(times).sort();
}

class ExactClip implements Clip {
  readonly count: number;
  readonly width: number;
  readonly height: number;
  readonly #sink: VideoSampleSink;
  /** Frames that are decoded one after another, from the index on, while they are requested so. */
  #sequence: Sequence | null = null;
  #last = -1;

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
    const sample = await this.#sample(index);
    try {
      if (sample === null || Math.abs(sample.timestamp - this.times[index]!) > SAME_TIME) {
        throw new PageError('inexact-frame', strings.errors.inexactFrame(this.name, index));
      }
      const canvas = new OffscreenCanvas(sample.displayWidth, sample.displayHeight);
      const context = canvas.getContext('2d', { alpha: false });
      if (context === null) throw new PageError('unsupported-browser', strings.errors.noCanvas);
      sample.draw(context, 0, 0);
      return await frameFromBitmap(canvas.transferToImageBitmap(), identityOf(this.name, this.fingerprint, index), longestSide, began);
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

  nameOf(index: number): string {
    return fileNameOf(index);
  }

  close(): void {
    this.#sequence?.end();
    this.input.dispose();
  }

  /** Finding a single frame means decoding from a key frame on. In sequence each frame is decoded once. */
  async #sample(index: number): Promise<VideoSample | null> {
    const following = index === this.#last + 1;
    this.#last = index;
    if (this.#sequence?.next !== index) {
      if (!following) return this.#sink.getSample(this.#asked(index));
      this.#sequence?.end();
      this.#sequence = new Sequence(this.#sink.samples(this.#asked(index)), index);
    }
    return this.#sequence.take();
  }

  /** A time inside the frame: its start may have been rounded down into the frame before. */
  #asked(index: number): number {
    const [now, next] = [this.times[index]!, this.times[index + 1]];
    return now + Math.min(SAME_TIME, next === undefined ? SAME_TIME : (next - now) / 2);
  }
}

/** Samples that are taken one after another. */
class Sequence {
  /** The sample that is taken last, which the end waits for. */
  #taking: Promise<unknown> = Promise.resolve();

  /** `next`: the index of the next frame. */
  constructor(
    readonly samples: AsyncGenerator<VideoSample, void, unknown>,
    public next: number,
  ) {}

  take(): Promise<VideoSample | null> {
    this.next += 1;
    const taking = this.samples.next().then(({ value }) => value ?? null);
    this.#taking = taking.catch(() => null);
    return taking;
  }

  end(): void {
    void this.#taking.then(() => this.samples.return());
  }
}
