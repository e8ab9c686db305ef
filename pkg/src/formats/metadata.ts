// What is known beside the labels, and how they are to be written: checked once, here.

import type { Metadata } from '../../types/formats.js';
import { entriesOf, invalidOption, isFrameRate, isListOf, isRising, isWhole, reading, UNLABELLED } from '../common/checks.js';

/** Frames per second where none are given and a format has to have them. */
export const USUAL_RATE = 25;

/** {@link Metadata}, checked and copied. */
export interface Settings extends Omit<Metadata, 'timestamps' | 'frameRate'> {
  /** Whether there is a single frame, and no clip. */
  one: boolean;
  clip: string;
  classes: readonly string[];
  tracked: boolean;
  tolerance: number;
  shape: 'polygon' | 'box';
  modelVersion: string;
  /** Frames per second. */
  rate: number;
  /** How many frames have a time, if any. */
  times: number | undefined;
}

const KNOWN = [
  'clip',
  'names',
  'classes',
  'labels',
  'tracked',
  'frameRate',
  'timestamps',
  'tolerance',
  'shape',
  'fromName',
  'toName',
  'modelVersion',
];

/** Throws `invalid-option`. */
export function settingsOf(metadata: unknown, one: boolean): Settings {
  return reading(() => {
    const given = entriesOf(metadata, KNOWN);
    const taken = <T>(name: string, wanted: string, fits: (value: unknown) => value is T): T | undefined => {
      const value = given[name];
      if (value === undefined || fits(value)) return value;
      throw invalidOption(name, wanted, value);
    };
    const text = (name: string) => taken(name, 'text', isText);
    const classes = taken('classes', 'a list of names, each once', isListOfNames) ?? [];
    const names = taken('names', 'an object with a text for each label', areNames);
    const labels = taken('labels', 'a list of labels from 0 to 255', (value) => isListOf(value, isLabel));
    const timestamps = taken('timestamps', 'a list of numbers, none below the one before it', isRising);
    const frameRate = taken('frameRate', 'a number above 0', (value): value is number => Number.isFinite(value) && (value as number) > 0);
    const [fromName, toName] = [text('fromName'), text('toName')];
    return {
      one,
      clip: text('clip') ?? 'clip',
      classes: [...classes],
      ...(names && { names: { ...names } }),
      ...(labels && { labels: [...labels] }),
      tracked: taken('tracked', 'true or false', (value) => typeof value === 'boolean') ?? !one,
      tolerance:
        taken('tolerance', 'a number of pixels from 0', (value): value is number => Number.isFinite(value) && (value as number) >= 0) ?? 0,
      shape: taken('shape', "'polygon' or 'box'", (value) => value === 'polygon' || value === 'box') ?? 'polygon',
      ...(fromName !== undefined && { fromName }),
      ...(toName !== undefined && { toName }),
      modelVersion: text('modelVersion') ?? 'veronese',
      rate: rateOf({ frameRate, timestamps }) ?? USUAL_RATE,
      times: timestamps?.length || undefined,
    };
  });
}

/** The number of frames per second, the mean where only times are given. */
export function rateOf({
  frameRate,
  timestamps = [],
}: {
  frameRate?: number | undefined;
  timestamps?: readonly number[] | undefined;
}): number | undefined {
  if (frameRate !== undefined) return frameRate;
  const [first, last] = [timestamps[0], timestamps.at(-1)];
  const rate = (timestamps.length - 1) / ((last ?? 0) - (first ?? 0));
  return isFrameRate(rate) ? rate : undefined;
}

export function nameOf(label: number, { names }: Pick<Metadata, 'names'>): string {
  return names?.[label] ?? `motion-${label}`;
}

export function isText(value: unknown): value is string {
  return typeof value === 'string';
}

export function isLabel(value: unknown): value is number {
  return isWhole(value, 0, UNLABELLED);
}

function isListOfNames(value: unknown): value is string[] {
  return isListOf(value, isText) && new Set(value).size === value.length;
}

function areNames(value: unknown): value is Record<number, string> {
  return typeof value === 'object' && value !== null && Object.values(value).every((name) => name === undefined || isText(name));
}
