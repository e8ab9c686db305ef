//! Projects as files: written, and read with every value checked. docs/formats.md describes the format.

import { PageError } from '../common/errors.js';
import { strings } from '../common/strings.js';
import { NO_EDITS } from '../correction/edits.js';
import type { Runs } from '../correction/runs.js';
import type { Kept } from '../state/kept.js';
import type { Subject } from '../state/pair.js';
import { acceptedIn } from '../state/tracked.js';
import { isContent, isRuns } from './content.js';
import type { Project } from './project.js';
import * as check from './schema.js';

const FORMAT = 'veronese-project';
const VERSION = 3;
const MEDIA_TYPE = 'application/gzip';

/** Where a document refers to a label image, and where to other bytes: their place in its lists. */
interface ImagePlace {
  readonly image: number;
}
interface BytesPlace {
  readonly bytes: number;
}

/** The first line: what a list of projects shows. */
export interface Header extends Subject, Pick<Project, 'thumbnail'> {
  readonly format: typeof FORMAT;
  readonly version: typeof VERSION;
  /** When it was written, as an ISO 8601 date. */
  readonly saved: string;
}

/** The bytes of the project's file. */
export function streamOf({ of, name, frames, sample, thumbnail, settings, classList, clip, pairs }: Project, now: Date): ReadableStream<Uint8Array<ArrayBuffer>> {
  const [images, blobs] = [new Map<Runs, number>(), new Map<Blob, number>()];
  const place = <T>(map: Map<T, number>, value: T): number => {
    const at = map.get(value) ?? map.size;
    map.set(value, at);
    return at;
  };
  // The same image or blob is written once, however many refer to it.
  const referring = (_key: string, value: unknown): unknown => {
    if (value instanceof Map || value instanceof Set) return [...value];
    if (value instanceof Blob) return { bytes: place(blobs, value) } satisfies BytesPlace;
    return isRuns(value) ? ({ image: place(images, value) } satisfies ImagePlace) : value;
  };
  const part = clip && { ...clip, accepted: acceptedIn(clip) };
  const content = JSON.stringify({ settings, classList, clip: part, pairs: [...pairs].map(([key, kept]) => [key, withoutSaved(kept)]) }, referring);
  const lists = JSON.stringify({ images: [...images.keys()].map(({ width, height, ends }) => [width, height, ends.length]), bytes: [...blobs.keys()].map(({ size }) => size) });
  const header: Header = { format: FORMAT, version: VERSION, of, name, frames, ...(sample && { sample }), saved: now.toISOString(), thumbnail };
  const lines = [header, content, lists].map((line) => `${typeof line === 'string' ? line : JSON.stringify(line)}\n`);
  const runs = [...images.keys()].flatMap(({ ends, labels }) => [ends, labels] as BlobPart[]);
  return new Blob([...lines, ...runs, ...blobs.keys()]).stream().pipeThrough(new CompressionStream('gzip'));
}

export async function fileOf(project: Project, now: Date): Promise<Blob> {
  return new Blob([await new Response(streamOf(project, now)).blob()], { type: MEDIA_TYPE });
}

/** The header alone. */
export async function headerOf(file: Blob, name: string): Promise<Header> {
  return guarded(name, async () => {
    const reader = file.stream().pipeThrough(new DecompressionStream('gzip')).pipeThrough(new TextDecoderStream()).getReader();
    let text = '';
    while (!text.includes('\n')) {
      const { value, done } = await reader.read();
      if (done) break;
      text += value;
    }
    await reader.cancel();
    return headerIn(text.split('\n', 1)[0]!, name);
  });
}

/** Throws a {@link PageError}: `damaged-project`, or `newer-project` for a version that is not known yet. */
export async function projectFromFile(file: Blob, name: string): Promise<Project> {
  return guarded(name, async () => {
    // The end of the stream has a checksum, so a file that can be unpacked is whole.
    const bytes = new Uint8Array(await new Response(file.stream().pipeThrough(new DecompressionStream('gzip'))).arrayBuffer());
    let at = 0;
    const line = (): string => {
      const from = at;
      at = bytes.indexOf(10, from) + 1;
      if (at === 0) throw new Error('a line is missing');
      return new TextDecoder('utf-8', { fatal: true }).decode(bytes.subarray(from, at - 1));
    };
    const header = headerIn(line(), name);
    const content = line();
    const lists: unknown = JSON.parse(line());
    assert(isLists(lists));
    const taken = (length: number): Uint8Array<ArrayBuffer> => {
      assert(at + length <= bytes.length);
      return bytes.slice(at, (at += length));
    };
    const images = lists.images.map(([width, height, count]) => runsFrom(width!, height!, new Uint32Array(taken(4 * count!).buffer), taken(count!)));
    const blobs = lists.bytes.map((length) => new Blob([taken(length)]));
    assert(at === bytes.length);
    const value: unknown = JSON.parse(content, (_key, value: unknown) => {
      if (isImagePlace(value)) return images[value.image];
      return isBytesPlace(value) ? blobs[value.bytes] : value;
    });
    const { of, name: called, frames, sample, thumbnail } = header;
    assert(isContent(value, frames));
    const { settings, classList, clip, pairs } = value;
    const subject = { of, name: called, frames, ...(sample && { sample }) };
    return {
      ...subject,
      thumbnail,
      settings,
      classList,
      clip: clip && {
        ...clip,
        exact: new Map(clip.exact),
        became: new Map(clip.became),
        locked: new Set(clip.locked),
        accepted: new Set(clip.accepted.flatMap((index) => clip.frames[index] ?? [])),
        spans: clip.spans.map((span) => ({ ...span, numbers: new Map(span.numbers) })),
        solved: clip.solved && { ...clip.solved, pairs: new Map(clip.solved.pairs) },
      },
      pairs: new Map(pairs.map(([key, kept]) => [key, { ...kept, subject, edits: { ...NO_EDITS, ...kept.edits } }])),
    };
  });
}

async function guarded<T>(name: string, read: () => Promise<T>): Promise<T> {
  try {
    return await read();
  } catch (error) {
    if (error instanceof PageError) throw error;
    throw new PageError('damaged-project', strings.projects.damaged(name));
  }
}

function assert(condition: boolean): asserts condition {
  if (!condition) throw new Error('not as the format says');
}

const isPicture: check.Check<string> = (value): value is string => check.isText(value) && /^data:image\/jpeg;base64,[\w+/=]*$/.test(value);
const isHeader = check.objectOf<Header>({
  format: check.isOne(FORMAT),
  version: check.isOne(VERSION),
  of: check.isText,
  name: check.isText,
  frames: check.isFrom(1),
  saved: check.isText,
  sample: check.optional(check.objectOf({ id: check.isText, swapped: check.isFlag })),
  thumbnail: check.optional(isPicture),
});
const isLists = check.objectOf({ images: check.listOf(check.listOf(check.isFrom(0, 2 ** 32), 3)), bytes: check.listOf(check.isFrom(0)) });
const isImagePlace = check.objectOf<ImagePlace>({ image: check.isFrom(0) });
const isBytesPlace = check.objectOf<BytesPlace>({ bytes: check.isFrom(0) });

function headerIn(line: string, name: string): Header {
  const header: unknown = JSON.parse(line);
  if (check.objectOf({ format: check.isOne(FORMAT), version: check.isFrom(VERSION + 1) })(header)) {
    throw new PageError('newer-project', strings.projects.newer(name));
  }
  assert(isHeader(header));
  return header;
}

/** The last export belongs to the tab, and the subject stands in the header. */
function withoutSaved({ edits, subject: _subject, ...kept }: Kept): object {
  const { saved: _saved, ...rest } = edits;
  return { ...kept, edits: rest };
}

function runsFrom(width: number, height: number, ends: Uint32Array, labels: Uint8Array): Runs {
  const ascend = ends.every((end, k) => end > (ends[k - 1] ?? 0));
  assert(ascend && (ends.at(-1) ?? 0) === width * height);
  return { width, height, ends, labels };
}
