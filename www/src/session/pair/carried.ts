//! How the pair's masks look in another result, which numbers them anew: the mask that is selected, hidden or alone, and the names and
//! colours that a person gave, go on with the pixels.

import type { Segmentation } from 'veronese';
import { type Appearance, maskIdOf, maskWith } from '../../correction/edits.js';
import { labellingOf, labelsIn } from '../../correction/parts.js';
import type { Colour } from '../../drawing/palette.js';
import { UNLABELLED, keyOf, labelSet } from '../../result/masks.js';
import { FRESH, type Look, type State } from '../../state/state.js';

/** Names and colours by the current numbers of their masks. */
export function namesAndColours(appearances: readonly Appearance[], segmentation: Segmentation, found: Segmentation): Pick<Look, 'names' | 'colours'> {
  const [names, colours]: [Record<string, string>, Record<string, Colour>] = [{}, {}];
  for (const one of appearances) {
    const id = maskIdOf(one, segmentation, found);
    if (id === null) continue;
    if (one.name !== undefined) names[keyOf(one.kind, id)] = one.name;
    if (one.colour !== undefined) colours[keyOf(one.kind, id)] = one.colour;
  }
  return { names, colours };
}

/** Choices that refer to masks by number, with the numbers of these masks in the new result. */
export function carried({ look, result, found }: State, now: Segmentation, foundNow: Segmentation): Pick<Look, 'hidden' | 'solo' | 'stabilised' | 'selected' | 'dismissed'> {
  const { hidden: none, dismissed: asked } = FRESH;
  if (result === null || found === null) return { hidden: none, solo: null, stabilised: null, selected: null, dismissed: asked };
  const { kind, hidden, solo, stabilised, selected } = look;
  const place = (id: number | null): number | null => {
    if (id === null) return null;
    const labels = labelSet(result.segmentation, kind, id);
    if (id === UNLABELLED) return now.unlabelled > 0 ? id : null;
    return maskWith(found === foundNow ? labels : labelsIn({ of: labellingOf(found), labels }, labellingOf(foundNow)), now, kind);
  };
  const dismissed = found === foundNow ? look.dismissed : asked;
  return { dismissed, hidden: new Set([...hidden].map(place).filter((id) => id !== null)), solo: place(solo), stabilised: place(stabilised), selected: place(selected) };
}
