//! The settings as data: name, values, help. `views/options.ts` makes the form from them.

import type { SegmentOptions } from 'veronese';

/** The options of the package that the page offers, and the working size. */
export type Settings = Readonly<Required<Pick<SegmentOptions, 'motions' | 'quality' | 'markUnknown' | 'seed'>>> & {
  /** Frames with a longer side are scaled down to it when they are opened, pixels. Masks are exported at the size of the file. */
  readonly longestSide: number;
};

interface Common<K extends keyof Settings> {
  readonly name: K;
  readonly label: string;
  readonly help: string;
  readonly initial: Settings[K];
}

/** One of a few values. */
export interface ChoiceControl<K extends keyof Settings = keyof Settings> extends Common<K> {
  readonly kind: 'select' | 'radio';
  readonly choices: readonly { readonly value: Settings[K]; readonly label: string }[];
}

/** A whole number. */
export interface NumberControl extends Common<'seed'> {
  readonly kind: 'number';
  readonly min: number;
  readonly max: number;
}

/** On or off. */
export interface SwitchControl extends Common<'markUnknown'> {
  readonly kind: 'switch';
}

export type Control = ChoiceControl<'motions'> | ChoiceControl<'quality'> | ChoiceControl<'longestSide'> | NumberControl | SwitchControl;

/** The paper's limit on the number of motions. */
const MOST_MOTIONS = 10;

const MOTIONS: ChoiceControl<'motions'> = {
  kind: 'select',
  name: 'motions',
  label: 'Number of motions',
  help: 'Estimated for each pair, or the same for all pairs.',
  initial: 'auto',
  choices: [
    { value: 'auto', label: 'Automatic' },
    ...Array.from({ length: MOST_MOTIONS }, (_, i) => ({ value: i + 1, label: String(i + 1) })),
  ],
};

const QUALITY: ChoiceControl<'quality'> = {
  kind: 'radio',
  name: 'quality',
  label: 'Quality',
  help: 'Fast for a quick look, Best for final masks.',
  initial: 'best',
  choices: [
    { value: 'fast', label: 'Fast' },
    { value: 'best', label: 'Best' },
  ],
};

const LONGEST_SIDE: ChoiceControl<'longestSide'> = {
  kind: 'select',
  name: 'longestSide',
  label: 'Working size',
  help: 'Larger frames are scaled down to this size when opened. Masks are exported at full size.',
  initial: 2048,
  choices: [
    { value: 640, label: '640 pixels' },
    { value: 1024, label: '1024 pixels' },
    { value: 2048, label: '2048 pixels' },
    { value: 4096, label: '4096 pixels' },
  ],
};

const MARK_UNKNOWN: SwitchControl = {
  kind: 'switch',
  name: 'markUnknown',
  label: 'Leave unexplained pixels unlabelled',
  help: 'Such as pixels that are hidden in the second frame.',
  initial: false,
};

const SEED: NumberControl = {
  kind: 'number',
  name: 'seed',
  label: 'Seed',
  help: 'Every seed gives the same masks. Reports repeat it.',
  initial: 1,
  min: 0,
  max: 0xffff_ffff,
};

/** In the order of the form. */
export const CONTROLS: readonly Control[] = [MOTIONS, QUALITY, MARK_UNKNOWN, LONGEST_SIDE, SEED];

export const DEFAULT_SETTINGS: Settings = {
  motions: MOTIONS.initial,
  quality: QUALITY.initial,
  markUnknown: MARK_UNKNOWN.initial,
  seed: SEED.initial,
  longestSide: LONGEST_SIDE.initial,
};
