//! Projects as files: written, and read with every value checked. docs/formats.md describes the format.

import { PageError } from '../common/errors.js';
import { strings } from '../common/strings.js';
import type { Runs } from '../correction/runs.js';
import type { TrackedFrame } from '../state/tracked.js';
import { isContent, isRuns } from './content.js';
import type { Project } from './project.js';
import * as check from './schema.js';

const FORMAT = 'veronese-project';
const VERSION = 4;
const MEDIA_TYPE = 'application/gzip';

/** What the content refers to, by its place in the lists: the masks of a frame, which steps share, label images, and other bytes. */
const PLACES = ['masks', 'image', 'bytes'] as const;

/** The first line: what a list of projects shows. */
export interface Header extends Pick<Project, 'of' | 'name' | 'frames' | 'sample' | 'thumbnail'> {
  readonly format: typeof FORMAT;
  readonly version: typeof VERSION;
  /** When it was written, as an ISO 8601 date. */
  readonly saved: string;
}

/** The bytes of the project's file. */
export function streamOf({ of, name, frames, sample, thumbnail, settings, classList, clip }: Project, now: Date): ReadableStream<Uint8Array<ArrayBuffer>> {
  const [masks, images, blobs] = [new Map<TrackedFrame, number>(), new Map<Runs, number>(), new Map<Blob, number>()];
  const place = <T>(map: Map<T, number>, value: T): number => {
    const at = map.get(value) ?? map.size;
    map.set(value, at);
    return at;
  };
  // The same is written once, however many refer to it.
  const referring = (_key: string, value: unknown): unknown => {
    if (value instanceof Map) return { map: [...value] };
    if (value instanceof Set) return { set: [...value] };
    if (value instanceof Blob) return { bytes: place(blobs, value) };
    if (isRuns(value)) return { image: place(images, value) };
    return isMasks(value) ? { masks: place(masks, value) } : value;
  };
  const content = JSON.stringify({ settings, classList, clip }, referring);
  const frameList = [...masks.keys()].map(({ runs, ...others }) => ({ ...others, image: place(images, runs) }));
  const lists = JSON.stringify({ masks: frameList, images: [...images.keys()].map(({ width, height, ends }) => [width, height, ends.length]), bytes: [...blobs.keys()].map(({ size }) => size) });
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
    const parts = { masks: lists.masks.map(({ image, ...others }) => ({ ...others, runs: images[image] })), image: images, bytes: blobs };
    const value: unknown = JSON.parse(content, (_key, value: unknown) => {
      const [[key, one] = ['', null], ...more] = value instanceof Object && !Array.isArray(value) ? Object.entries(value) : [];
      if (more.length > 0) return value;
      if (key === 'map') return new Map(one as [unknown, unknown][]);
      if (key === 'set') return new Set(one as unknown[]);
      const kind = PLACES.find((name) => name === key);
      return kind === undefined ? value : parts[kind][one as number];
    });
    const { of, name: called, frames, sample, thumbnail } = header;
    assert(isContent(value, frames));
    return { of, name: called, frames, ...(sample !== undefined && { sample }), thumbnail, ...value };
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
  sample: check.optional(check.isText),
  thumbnail: check.optional(isPicture),
});
const isMasks = (value: unknown): value is TrackedFrame => value instanceof Object && 'runs' in value && 'background' in value;
const isLists = check.objectOf({ masks: check.listOf(check.objectOf({ image: check.isFrom(0) })), images: check.listOf(check.listOf(check.isFrom(0, 2 ** 32), 3)), bytes: check.listOf(check.isFrom(0)) });

function headerIn(line: string, name: string): Header {
  const header: unknown = JSON.parse(line);
  if (check.objectOf({ format: check.isOne(FORMAT), version: check.isFrom(VERSION + 1) })(header)) {
    throw new PageError('newer-project', strings.projects.newer(name));
  }
  assert(isHeader(header));
  return header;
}

function runsFrom(width: number, height: number, ends: Uint32Array, labels: Uint8Array): Runs {
  const ascend = ends.every((end, k) => end > (ends[k - 1] ?? 0));
  assert(ascend && (ends.at(-1) ?? 0) === width * height);
  return { width, height, ends, labels };
}
