//! How strokes change masks.
//!
//! In its own frame, a stroke that adds to an object removes nothing, one that removes adds nothing, and changes that are not connected
//! with a stroke are undone. In other frames, the mask that was found stays unless the pixels support the change. Where an object takes the
//! place of another, no rim of the other is left.

use crate::answer::UNLABELLED;
use crate::clip::annotation::Seed;
use crate::clip::options::model;
use crate::components::{Connectivity, components};

/// Undoes the changes of an object's mask since `before` that are not connected with a stroke.
#[inline(never)]
pub(super) fn keep(mask: &mut [u8], before: &[u8], seeds: &[Seed], width: usize) {
    // 1 is added, 2 is taken away.
    let changes: Vec<u8> = mask.iter().zip(before).map(|(now, before)| now + 2 * before).collect();
    let parts = components(&changes, width, Connectivity::Eight);
    let mut is_meant = vec![false; parts.list.len()];
    for (p, change) in changes.iter().enumerate() {
        is_meant[parts.of[p] as usize] |= match change {
            1 => seeds[p] == Seed::Object,
            2 => matches!(seeds[p], Seed::Other | Seed::Dropped),
            _ => true,
        };
    }
    for (p, inside) in mask.iter_mut().enumerate() {
        if !is_meant[parts.of[p] as usize] && seeds[p] == Seed::Nothing {
            *inside = before[p];
        }
    }
    smooth(mask, before, seeds, width);
}

/// Whether annotations paint over a whole object: they leave less than a fifth of it, as it was `found`, open, and at least a fifth of what
/// they paint lies on it. The painted pixels are then its mask.
pub(super) fn paints_over(found: &[u8], object: u8, seeds: &[Seed]) -> bool {
    let (mut painted, mut erased, mut open, mut beside) = (0usize, 0usize, 0usize, 0usize);
    for (found, seed) in found.iter().zip(seeds) {
        match seed {
            Seed::Object if *found == object => painted += 1,
            Seed::Object => beside += 1,
            Seed::Nothing if *found == object => open += 1,
            _ if *found == object => erased += 1,
            _ => {}
        }
    }
    painted > 4 * open && 4 * (painted + erased) > beside
}

/// Gives pixels without annotation a seed by what was found there.
pub(super) fn fill(seeds: &mut [Seed], found: &[u8], object: u8) {
    for (seed, found) in seeds.iter_mut().zip(found).filter(|(seed, _)| **seed == Seed::Nothing) {
        *seed = if *found == object { Seed::Object } else { Seed::Other };
    }
}

/// In a frame without annotations, undoes connected changes of the `known` mask that its pixels do not support: the sum of their `looks`,
/// log-odds of the object, must favour the change. Where annotations have changed only part of the object, a change must also contain
/// pixels that they have changed: `change` is the changed share of a pixel.
#[inline(never)]
pub(super) fn settle(
    mask: &mut [u8],
    known: &[u8],
    looks: &dyn Fn(usize) -> f32,
    change: Option<&dyn Fn(usize) -> f32>,
    width: usize,
) {
    // 1 is added, 2 is taken away.
    let changes: Vec<u8> = mask.iter().zip(known).map(|(now, known)| now + 2 * known).collect();
    let parts = components(&changes, width, Connectivity::Eight);
    let mut sums = vec![0.0f32; parts.list.len()];
    let mut is_meant = vec![change.is_none(); parts.list.len()];
    for (p, kind) in changes.iter().enumerate().filter(|(_, kind)| matches!(kind, 1 | 2)) {
        let part = parts.of[p] as usize;
        sums[part] += if *kind == 1 { looks(p) } else { -looks(p) };
        is_meant[part] |= change.is_some_and(|share| share(p) > model().expected);
    }
    for (p, inside) in mask.iter_mut().enumerate() {
        let part = parts.of[p] as usize;
        if matches!(changes[p], 1 | 2) && !(is_meant[part] && sums[part] > 0.0) {
            *inside = known[p];
        }
    }
}

/// Whether the second object may take pixels from the first.
type Takes<'a> = &'a dyn Fn(u8, u8) -> bool;

/// Gives the rim that is left of a found object to the object that has most of it. `layer` are the labels over those found; only `open`
/// pixels change; `takes` decides which object takes from which.
#[inline(never)]
pub(super) fn absorb_rims(
    layer: &mut [u8],
    found: &[u8],
    (open, takes): (&dyn Fn(usize) -> bool, Takes<'_>),
    width: usize,
    reach: usize,
) {
    let mut sizes = [[0usize; 2]; 256];
    for (&found, &label) in found.iter().zip(&*layer) {
        sizes[usize::from(found)][0] += 1;
        sizes[usize::from(found)][1] += usize::from(label != UNLABELLED && takes(found, label));
    }
    let is_taken = |label: u8| 2 * sizes[usize::from(label)][1] > sizes[usize::from(label)][0];
    let is_left = |p: usize, layer: &[u8]| layer[p] == UNLABELLED && open(p) && is_taken(found[p]);
    let left: Vec<u8> = (0..layer.len()).map(|p| if is_left(p, layer) { found[p] } else { 0 }).collect();
    if left.iter().all(|label| *label == 0) {
        return;
    }
    // The nearest object within reach that takes from it.
    let mut nearest = layer.to_vec();
    let mut rest: Vec<usize> = (0..layer.len()).filter(|&p| left[p] > 0).collect();
    for _ in 0..reach {
        let before = nearest.clone();
        rest.retain(|&p| {
            let x = p % width;
            let around = [
                (x > 0, p.wrapping_sub(1)),
                (x + 1 < width, p + 1),
                (p >= width, p.wrapping_sub(width)),
                (true, p + width),
            ];
            let beside =
                around.into_iter().filter(|&(is_inside, q)| is_inside && q < before.len()).map(|(_, q)| before[q]);
            let other = beside.into_iter().find(|&label| label != UNLABELLED && takes(found[p], label));
            other.inspect(|other| nearest[p] = *other).is_none()
        });
    }
    let parts = components(&left, width, Connectivity::Four);
    let mut is_wide = vec![false; parts.list.len()];
    rest.iter().for_each(|&p| is_wide[parts.of[p] as usize] = true);
    for p in (0..layer.len()).filter(|&p| left[p] > 0 && !is_wide[parts.of[p] as usize]) {
        layer[p] = nearest[p];
    }
}

/// Removes specks and pinholes that a change has left.
fn smooth(mask: &mut [u8], before: &[u8], seeds: &[Seed], width: usize) {
    let parts = components(mask, width, Connectivity::Four);
    let mut is_new = vec![false; parts.list.len()];
    let mut is_annotated = vec![false; parts.list.len()];
    for p in 0..mask.len() {
        let part = parts.of[p] as usize;
        let around = [p, p.wrapping_sub(1), p + 1, p.wrapping_sub(width), p + width];
        is_new[part] |= around.into_iter().any(|q| q < mask.len() && mask[q] != before[q]);
        is_annotated[part] |= seeds[p] != Seed::Nothing && (seeds[p] == Seed::Object) == (mask[p] > 0);
    }
    for (p, inside) in mask.iter_mut().enumerate() {
        let part = parts.of[p] as usize;
        if parts.list[part].size < model().speck && is_new[part] && !is_annotated[part] {
            *inside = 1 - *inside;
        }
    }
}
