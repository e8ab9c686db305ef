//! Masks: what is shown, listed and exported as one. A mask is one motion of a pair, a group of them (the motions of one surface), or an
//! object of a whole clip.

import type { Segmentation } from 'veronese';

export type Kind = 'groups' | 'motions' | 'objects';

type Motion = Segmentation['motions'][number];

/** The mask of pixels without a label. */
export const UNLABELLED = 255;

export interface Mask {
  /** The label of its motion or the number of its group; {@link UNLABELLED} for pixels without a label. */
  readonly id: number;
  /** Largest first. */
  readonly motions: readonly Motion[];
  readonly pixels: number;
  readonly share: number;
}

/** The key of a mask's name and colour: the kinds number their masks separately. */
export function keyOf(kind: Kind, id: number): string {
  return `${kind}-${id}`;
}

/** The number of the mask that a label belongs to. */
export function maskOf(label: number, { motions }: Pick<Segmentation, 'motions'>, kind: Kind): number {
  return kind === 'groups' ? (motions[label]?.group ?? label) : label;
}

/** `table[label]` is the number of the label's mask. */
export function maskTable(segmentation: Pick<Segmentation, 'motions'>, kind: Kind): Uint8Array {
  return Uint8Array.from({ length: 256 }, (_, label) => maskOf(label, segmentation, kind));
}

/** All masks by number; pixels without a label come last. */
export function masksOf(segmentation: Segmentation, kind: Kind): Mask[] {
  const byId = new Map<number, Motion[]>();
  for (const motion of segmentation.motions) {
    const id = maskOf(motion.label, segmentation, kind);
    byId.set(id, [...(byId.get(id) ?? []), motion]);
  }
  const total = segmentation.width * segmentation.height;
  const masks = [...byId].map(([id, motions]): Mask => {
    const pixels = motions.reduce((sum, motion) => sum + motion.pixels, 0);
    return { id, motions: motions.toSorted((a, b) => b.pixels - a.pixels), pixels, share: pixels / total };
  });
  masks.sort((a, b) => a.id - b.id);
  const { unlabelled } = segmentation;
  return unlabelled > 0 ? [...masks, { id: UNLABELLED, motions: [], pixels: unlabelled, share: unlabelled / total }] : masks;
}

/** The largest motion of a mask. */
export function mainMotion(segmentation: Segmentation, kind: Kind, id: number): Motion | null {
  return masksOf(segmentation, kind).find((mask) => mask.id === id)?.motions[0] ?? null;
}
