// Labelled frames in a folder of `batch` or `clip`: what the two have in common.

import { basename, resolve } from 'node:path';
import type { LabelFrame, Metadata } from '../../types/formats.js';
import { VeroneseError } from '../common/errors.js';

export interface SequenceFrame extends LabelFrame {
  /** Its file's name. */
  image: string;
}

/** Frames in their order. They are read one by one, as often as somebody asks for them. */
export interface Sequence extends AsyncIterable<SequenceFrame> {
  meta: Metadata & Required<Pick<Metadata, 'clip' | 'names' | 'labels' | 'tracked'>>;
  /** How many frames there are. */
  count: number;
}

/** The frames to convert, both inclusive. */
export interface Range {
  from: number;
  until?: number;
}

/** Classes of labels that nobody has named. */
export const CLASS = { background: 'background', object: 'object' } as const;

/** The last frame of the range. Throws `invalid-option` unless all of it is there. */
export function lastOf({ from, until }: Range, last: number): number {
  const wanted = until ?? Math.max(from, last);
  if (wanted > last) throw new VeroneseError('invalid-option', `there is no frame ${wanted}: the frames are 0 to ${last}`);
  return wanted;
}

/** The name of a folder's sequence. */
export function sequenceName(folder: string): string {
  return basename(resolve(folder)) || 'clip';
}

/** Whether it may become a part of a path. */
export function isFileName(name: unknown): name is string {
  return typeof name === 'string' && !/^\.{0,2}$|[/\\\p{Cc}]/u.test(name);
}
