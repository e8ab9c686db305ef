//! The settings as data: name, values, help. `views/options.ts` makes the form from them.

import type { SegmentOptions } from 'veronese';

/** The options of the package that the page offers, and the working size. */
export type Settings = Readonly<Required<Pick<SegmentOptions, 'motions' | 'quality' | 'markUnknown'>>> & {
  /** Frames with a longer side are scaled down to it when they are opened, pixels. Masks are exported at the size of the file. */
  readonly longestSide: number;
};

interface Common<K extends keyof Settings> {
  readonly name: K;
  /** Rarely needed: folded away. */
  readonly advanced?: boolean;
  readonly label: string;
  readonly help: string;
  readonly initial: Settings[K];
}

/** One of a few values. The evidence plot shows the scores of the numbers of motions and offers the choice. */
export interface ChoiceControl<K extends keyof Settings = keyof Settings> extends Common<K> {
  readonly kind: 'select' | 'radio' | 'scores';
  readonly choices: readonly { readonly value: Settings[K]; readonly label: string }[];
}

/** On or off. */
export interface SwitchControl extends Common<'markUnknown'> {
  readonly kind: 'switch';
}

export type Control = ChoiceControl<'motions'> | ChoiceControl<'quality'> | ChoiceControl<'longestSide'> | SwitchControl;

/** The paper's limit on the number of motions. */
const MOST_MOTIONS = 10;

const MOTIONS: ChoiceControl<'motions'> = {
  kind: 'scores',
  name: 'motions',
  label: 'Number of motions',
  help: '',
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
  advanced: true,
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
  advanced: true,
  label: 'Leave unexplained pixels unlabelled',
  help: 'For example, those that are hidden in the second frame.',
  initial: false,
};

/** In the order of the form. */
export const CONTROLS: readonly Control[] = [MOTIONS, QUALITY, LONGEST_SIDE, MARK_UNKNOWN];

export const DEFAULT_SETTINGS: Settings = {
  motions: MOTIONS.initial,
  quality: QUALITY.initial,
  markUnknown: MARK_UNKNOWN.initial,
  longestSide: LONGEST_SIDE.initial,
};
