//! The edits of a pair of frames: strokes, merged and ungrouped masks, names and colours. Labels and groups on screen are derived from
//! the edits and from the segmentation found.

import type { Segmentation } from 'veronese';
import type { Colour } from '../drawing/palette.js';
import { UNLABELLED, type Kind, maskOf, masksOf, regrouped } from '../result/masks.js';
import { type Part, continuation, labellingOf, labelsIn } from './parts.js';
import type { Runs } from './runs.js';
import type { Stroke } from './strokes.js';

/** The group of each motion, by label. */
export interface Grouping {
  readonly of: Runs;
  readonly groups: readonly number[];
}

/** Pixels drawn exactly: their labels, 255 for all others, and the labelling whose numbers they are. */
export interface Exact {
  readonly of: Runs;
  readonly labels: Runs;
}

/** One step of undo and redo. */
export type Action = { readonly stroke: Stroke } | { readonly exact: Exact } | { readonly grouping: Grouping };

/** A name or colour that the user gave to a mask. */
export interface Appearance {
  readonly kind: Kind;
  /** The number of the mask in the result on screen at the time … */
  readonly id: number;
  /** … and its labels there, to find it in another result. */
  readonly mask: Part;
  readonly name?: string;
  readonly colour?: Colour;
}

export interface Edits {
  /** All actions in order; those that were undone and can be redone are at the end. */
  readonly actions: readonly Action[];
  /** The number of actions in effect. */
  readonly done: number;
  readonly appearances: readonly Appearance[];
  /** The last action in effect, and the appearances, when the masks were last exported. */
  readonly saved: { readonly action: Action | null; readonly appearances: readonly Appearance[] };
}

const NO_APPEARANCES: readonly Appearance[] = [];

export const NO_EDITS: Edits = { actions: [], done: 0, appearances: NO_APPEARANCES, saved: { action: null, appearances: NO_APPEARANCES } };

export function hasEdits({ actions, appearances }: Edits): boolean {
  return actions.length > 0 || appearances.length > 0;
}

/** Adds an action; what was undone can no longer be redone. */
export function withAction(edits: Edits, action: Action): Edits {
  const actions = [...edits.actions.slice(0, edits.done), action];
  return { ...edits, actions, done: actions.length };
}

/** The last action in effect. It identifies all before it, because actions are compared by identity. */
function lastAction({ actions, done }: Edits): Action | null {
  return actions[done - 1] ?? null;
}

export function asSaved(edits: Edits): Edits {
  return { ...edits, saved: { action: lastAction(edits), appearances: edits.appearances } };
}

export function isUnsaved(edits: Edits): boolean {
  return lastAction(edits) !== edits.saved.action || edits.appearances !== edits.saved.appearances;
}

/** The strokes in effect. */
export function strokesOf({ actions, done }: Edits): Stroke[] {
  return actions.slice(0, done).flatMap((action) => ('stroke' in action ? [action.stroke] : []));
}

/** The last stroke in effect. It identifies all before it, as with {@link lastAction}. */
export function lastStroke(edits: Edits): Stroke | null {
  return strokesOf(edits).at(-1) ?? null;
}

/** The segmentation with the user's groups. Motions that the grouping does not know get a group of their own. */
export function grouped(segmentation: Segmentation, { actions, done }: Edits, found: Segmentation): Segmentation {
  const last = actions.slice(0, done).findLast((action) => 'grouping' in action);
  const groups = last === undefined ? found.motions.map(({ group }) => group) : groupsIn(last.grouping, found);
  return regrouped(segmentation, ({ label, group }) => groups[label] ?? group);
}

function groupsIn({ of, groups }: Grouping, found: Segmentation): readonly number[] {
  const now = labellingOf(found);
  if (of === now) return groups;
  const labels = continuation(of, now);
  let free = Math.max(...groups) + 1;
  return found.motions.map(({ label }) => groups[labels.get(label) ?? -1] ?? free++);
}

/** The mask of the largest of these labels; `null` if there are none. */
export function maskWith(labels: number, segmentation: Segmentation, kind: Kind): number | null {
  const motions = segmentation.motions.filter(({ label }) => (labels >> label) & 1);
  const largest = motions.reduce<(typeof motions)[number] | null>((most, motion) => (motion.pixels > (most?.pixels ?? -1) ? motion : most), null);
  return largest === null ? null : maskOf(largest.label, segmentation, kind);
}

/** The current number of the mask; `null` if it no longer exists. */
export function maskIdOf({ id, mask, kind }: Pick<Appearance, 'id' | 'mask' | 'kind'>, segmentation: Segmentation, found: Segmentation): number | null {
  const now = labellingOf(found);
  if (id === UNLABELLED || mask.of === now) return masksOf(segmentation, kind).some((other) => other.id === id) ? id : null;
  return maskWith(labelsIn(mask, now), segmentation, kind);
}

/** The edits scaled to frames of another size. */
export function scaled(edits: Edits, sx: number, sy: number): Edits {
  const larger = new Map(edits.actions.map((action) => [action, 'stroke' in action ? { stroke: scaledStroke(action.stroke, sx, sy) } : action]));
  const saved = edits.saved.action === null ? null : (larger.get(edits.saved.action) ?? edits.saved.action);
  return { ...edits, actions: [...larger.values()], saved: { ...edits.saved, action: saved } };
}

/** Coordinates are those of pixel centres: 0 is half a pixel from the corner. */
function scaledStroke(stroke: Stroke, sx: number, sy: number): Stroke {
  const points = stroke.points.map((value, i) => (value + 0.5) * (i % 2 === 0 ? sx : sy) - 0.5);
  return { ...stroke, points, radius: stroke.radius * Math.sqrt(sx * sy) };
}
