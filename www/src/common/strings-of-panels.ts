//! The words of what is loaded when it is used: exports, *Inspect*, and what the list of a clip's objects has beside its rows.

import { NBSP, frames, objects, tenths, whole } from './strings.js';

const date = new Intl.DateTimeFormat('en-GB', { dateStyle: 'medium', timeStyle: 'short' });
const day = new Intl.DateTimeFormat('en-GB', { day: 'numeric', month: 'short' });
const time = new Intl.DateTimeFormat('en-GB', { timeStyle: 'short' });

/** "10:31" of today, "26 Nov" of another day. */
function when(at: Date): string {
  return at.toDateString() === new Date().toDateString() ? time.format(at) : day.format(at).replaceAll(' ', NBSP);
}

function fileSize(bytes: number): string {
  if (bytes < 1000) return `${bytes}${NBSP}B`;
  return bytes < 1e6 ? `${tenths.format(bytes / 1e3)}${NBSP}kB` : `${tenths.format(bytes / 1e6)}${NBSP}MB`;
}

const descriptionOf = (longer: number): string => (longer === 0 ? 'shortest description' : `description ${whole.format(longer)} longer than the shortest`);

export const panels = {
  projects: {
    keeping: ({ is, without = false }: { readonly is: 'nothing' | 'kept' | 'refused'; readonly without?: boolean }): string => {
      if (is === 'nothing') return 'What you do is kept in this browser, with a copy of the frames if there is room.';
      if (is === 'refused') return 'Your work is not kept in this browser. Save the project before you leave.';
      return without ? 'Your work is kept in this browser. Open the same frames again to continue.' : 'Your work is kept in this browser, with its frames.';
    },
    nothingYet: 'There is nothing to save yet: segment the clip or correct the masks first.',
    correcting: 'Your correction is still being carried to other frames. Save the project when it is done.',
    saved: (name: string): string => `Saved as ${name}.`,
    damaged: (name: string): string => `The project “${name}” is damaged and cannot be opened.`,
    newer: (name: string): string => `The project “${name}” was made by a newer version of this page.`,
    savedHere: (at: number, without: boolean): readonly string[] => ['Saved', without ? ' without its frames' : ' in this browser', `, ${time.format(at)}`],
    notSaved: {
      'storage-full': ['Not saved', ': no room is left', ''],
      'storage-refused': ['Not saved', ': the browser refused', ''],
      'open-elsewhere': ['Not saved', ': open in another tab', ''],
    },
    firstSaved: 'Your work is saved in this browser.',
    welcome: 'Find everything that moves.',
    continue: 'Continue your work',
    left: (count: number, saved: Date, hasFrames: boolean): string => `${frames(count)}, ${when(saved)}${hasFrames ? '' : ': choose the frames'}`,
    more: (count: number): string => `${count} more`,
    summary: (count: number): string => (count === 1 ? 'One project in this browser' : `${count} projects in this browser`),
    facts: (count: number, bytes: number, saved: Date): string => `${frames(count)}, ${fileSize(bytes)}, ${date.format(saved).replaceAll(' ', NBSP)}`,
    damagedFile: 'Damaged project',
    forget: 'Forget',
    forgetOf: (name: string): string => `Forget the project of ${name}`,
    forgotten: (name: string): string => `The project of “${name}” is forgotten.`,
  },
  select: (name: string): string => `Select ${name}`,
  selected: (count: number): string => `${whole.format(count)} selected`,
  classOf: (name: string): string => `Class of ${name}`,

  exporting: (done: number, of: number): string => `${whole.format(done)} of ${frames(of)}`,
  exported: (count: number, of: number): string => `Saved: ${objects(count).toLowerCase()} in ${frames(of)}.`,
  preview: {
    files: (count: number): string => `, ${whole.format(count)}${NBSP}files`,
    noMasks: 'There are no masks of this frame.',
    ofFrame: (name: string, bytes: number): string => `${name}: ${fileSize(bytes)}`,
    ofAll: (name: string, index: number, bytes: number): string => `${name} with frame ${index} alone: ${fileSize(bytes)}`,
    picture: (index: number): string => `Masks of frame ${index} as they are saved`,
  },

  /** `longer`: the length of the description above the shortest; `null` if there is none. */
  forceNumber: (count: number, longer: number | null): string =>
    `Use ${count} ${count === 1 ? 'motion' : 'motions'} for this pair${longer === null ? '' : `: ${descriptionOf(longer)}`}`,
  descriptionOf,
  /** Why the number found has not the shortest description. */
  otherThanShortest: (found: number, shortest: number): string =>
    `Automatic took ${found}, though ${shortest} has the shortest description: these lengths are a check made afterwards, and do not decide.`,

  timings: {
    decode: (name: string): string => `Decoding ${name}`,
    total: 'All stages',
    waited: 'Including transfers',
  },
} as const;
