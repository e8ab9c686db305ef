//! The settings: their values, and those that they begin with.

import type { SegmentOptions } from 'veronese';

/** The options of the package that the page offers, and the working size. */
export type Settings = Readonly<Required<Pick<SegmentOptions, 'motions' | 'quality' | 'subject' | 'markUnknown'>>> & {
  /** Frames with a longer side are scaled down to it when they are opened, pixels. Masks are exported at the size of the file. */
  readonly longestSide: number;
};

/** In the order of a link. */
export const DEFAULT_SETTINGS: Settings = { motions: 'auto', quality: 'best', subject: false, markUnknown: false, longestSide: 2048 };

/** The paper's limit on the number of motions. */
const MOST_MOTIONS = 10;

/** Pixels. */
export const LONGEST_SIDES = [640, 1024, 2048, 4096] as const;

const CHOICES: { readonly [K in keyof Settings]: readonly Settings[K][] } = {
  motions: ['auto', ...Array.from({ length: MOST_MOTIONS }, (_, k) => k + 1)],
  quality: ['fast', 'best'],
  subject: [false, true],
  markUnknown: [false, true],
  longestSide: LONGEST_SIDES,
};

/** The setting of this name that is written so; `undefined` if there is none. */
export function settingFrom(name: string, text: string | null): Partial<Settings> | undefined {
  const value = CHOICES[name as keyof Settings].find((choice) => String(choice) === text);
  return value === undefined ? undefined : { [name]: value };
}
