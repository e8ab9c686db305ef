//! Projects as files: one line of JSON, the header, and the journal of the clip, compressed. docs/formats.md describes the format.

import { PageError } from '../common/errors.js';
import { strings } from '../common/strings.js';
import type { Settings } from '../state/settings.js';
import type { Range } from '../state/tracked.js';
import * as check from './schema.js';

const FORMAT = 'veronese-project';
const VERSION = 5;
const MEDIA_TYPE = 'application/gzip';

/** What is known of a project beside its journal. */
export interface Header {
  readonly format: typeof FORMAT;
  readonly version: typeof VERSION;
  /** The clip: its fingerprint, its name, the number of its frames, and the sample that it is, if it is one. */
  readonly of: string;
  readonly name: string;
  readonly frames: number;
  readonly sample?: string | undefined;
  /** When it was last changed, as an ISO 8601 date. */
  readonly saved: string;
  /** A small picture of the frame on screen and its masks, as a `data:` address. */
  readonly thumbnail?: string | undefined;
  readonly settings: Settings;
  readonly classList: readonly string[];
  readonly range: Range;
  /** The frame on screen and the objects that are not ticked. */
  readonly at: number;
  readonly hidden: readonly number[];
  /** Number of steps up to the first masks, which undo does not take back. */
  readonly found: number;
  /** Whether a person has done anything with the clip. */
  readonly annotated: boolean;
  /** Of the journal. */
  readonly bytes: number;
}

/** A project of a file. */
export interface Project {
  readonly header: Header;
  readonly journal: Uint8Array;
}

export function headerFrom(values: Omit<Header, 'format' | 'version'>): Header {
  return { format: FORMAT, version: VERSION, ...values };
}

export async function fileOf({ header, journal }: Project): Promise<Blob> {
  const content = new Blob([`${JSON.stringify(header)}\n`, journal as BlobPart]).stream().pipeThrough(new CompressionStream('gzip'));
  return new Blob([await new Response(content).blob()], { type: MEDIA_TYPE });
}

/** Throws a {@link PageError}: `damaged-project`, or `newer-project` for a version that is not known yet. The clip checks its journal itself. */
export async function projectFromFile(file: Blob, name: string): Promise<Project> {
  try {
    // The end of the stream has a checksum, so a file that can be unpacked is whole.
    const bytes = new Uint8Array(await new Response(file.stream().pipeThrough(new DecompressionStream('gzip'))).arrayBuffer());
    const end = bytes.indexOf(10);
    const header: unknown = JSON.parse(new TextDecoder('utf-8', { fatal: true }).decode(bytes.subarray(0, Math.max(0, end))));
    if (check.objectOf({ format: check.isOne(FORMAT), version: check.isFrom(VERSION + 1) })(header)) throw new PageError('newer-project', strings.projects.newer(name));
    if (!isHeader(header) || header.range.last >= header.frames || header.range.first > header.range.last) throw new Error('not as the format says');
    return { header, journal: bytes.slice(end + 1) };
  } catch (error) {
    throw error instanceof PageError ? error : new PageError('damaged-project', strings.projects.damaged(name));
  }
}

const isPicture: check.Check<string> = (value): value is string => check.isText(value) && /^data:image\/jpeg;base64,[\w+/=]*$/.test(value);
const isMotions = check.either(check.isOne('auto'), check.isFrom(1, 10));
const isSettings: check.Check<Settings> = check.objectOf<Settings>({ motions: isMotions, quality: check.isOne('fast', 'best'), subject: check.isFlag, markUnknown: check.isFlag, longestSide: check.isFrom(1) });
const isHeader = check.objectOf<Header>({
  format: check.isOne(FORMAT),
  version: check.isOne(VERSION),
  of: check.isText,
  name: check.isText,
  frames: check.isFrom(1),
  saved: check.isText,
  sample: check.optional(check.isText),
  thumbnail: check.optional(isPicture),
  settings: isSettings,
  classList: check.listOf(check.isText),
  range: check.objectOf<Range>({ first: check.isFrom(0), last: check.isFrom(0) }),
  at: check.isFrom(0),
  hidden: check.listOf(check.isFrom(1, 254)),
  found: check.isFrom(0),
  annotated: check.isFlag,
  bytes: check.isFrom(0),
});
