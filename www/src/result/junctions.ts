//! Questions about neighbouring motions: two frames cannot always tell whether two of them are one thing, and a person can.

import type { Segmentation } from 'veronese';
import { maskOf } from './masks.js';

/** Advice about two groups, or about one that has both motions. */
export interface Suggestion {
  readonly advice: 'join' | 'separate';
  /** The two groups, the smaller number first; of one that may be two things, twice the same. */
  readonly groups: readonly [number, number];
  /** The motion that would leave its group. */
  readonly label: number;
  /** The junctions that it is about, by {@link keyOfJunction}. */
  readonly junctions: readonly string[];
}

type Junction = Segmentation['junctions'][number];
type Grouped = Pick<Segmentation, 'motions'>;
type Found = Pick<Segmentation, 'motions' | 'junctions'>;

/** Motions in different groups that are at least this likely to be one thing are asked about … */
const MAY_BE_ONE = 0.35;
/** … and those in one group that are less likely than this. */
const MAY_BE_TWO = 0.5;
/** At most this many questions at a time. */
const MOST = 2;

/** Suggestions about the groups as they are now, the one that is most likely right first. The groups that were found say what is in doubt. */
export function suggestionsOf(found: Found, now: Grouped, dismissed: ReadonlySet<string>): Suggestion[] {
  const suggestions = new Map<string, Suggestion>();
  for (const junction of found.junctions.toSorted((a, b) => certainty(found, b) - certainty(found, a))) {
    const advice = adviceOn(found, junction);
    const groups = groupsOf(now, junction);
    if (advice === null || isApart(groups) !== (advice === 'join') || dismissed.has(keyOfJunction(junction))) continue;
    const key = groups.join();
    const junctions = [...(suggestions.get(key)?.junctions ?? []), keyOfJunction(junction)];
    suggestions.set(key, { advice, groups, label: junction.labels[1], ...suggestions.get(key), junctions });
  }
  return [...suggestions.values()].slice(0, MOST);
}

function keyOfJunction({ labels }: Junction): string {
  return labels.join('-');
}

function groupsOf(segmentation: Grouped, { labels }: Junction): [number, number] {
  const [one, other] = labels.map((label) => maskOf(label, segmentation, 'groups')) as [number, number];
  return one < other ? [one, other] : [other, one];
}

function isApart([one, other]: readonly [number, number]): boolean {
  return one !== other;
}

/** The change of the groups that were found; `null` if the likelihood does not speak against them. */
function adviceOn(found: Grouped, junction: Junction): Suggestion['advice'] | null {
  if (isApart(groupsOf(found, junction))) return junction.likelihood >= MAY_BE_ONE ? 'join' : null;
  return junction.likelihood < MAY_BE_TWO ? 'separate' : null;
}

/** How likely the advice is to be right. */
function certainty(found: Grouped, junction: Junction): number {
  return adviceOn(found, junction) === 'join' ? junction.likelihood : 1 - junction.likelihood;
}
