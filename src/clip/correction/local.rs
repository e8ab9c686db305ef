//! Strokes change their frame where they are: one that adds to an object takes nothing away, one that takes away adds nothing, and what
//! nothing connects with a stroke stays.

use crate::clip::annotation::Seed;
use crate::clip::model;
use crate::components::{Connectivity, components};

/// Takes back what no stroke has changed of an object's mask since it was `before`.
pub(super) fn keep(mask: &mut [u8], before: &[u8], seeds: &[Seed], width: usize) {
    // 1 is added, 2 is taken away.
    let changes: Vec<u8> = mask.iter().zip(before).map(|(now, before)| now + 2 * before).collect();
    let parts = components(&changes, width, Connectivity::Eight);
    let mut is_meant = vec![false; parts.list.len()];
    for (p, change) in changes.iter().enumerate() {
        is_meant[parts.of[p] as usize] |= match change {
            1 => seeds[p] == Seed::Object,
            2 => seeds[p] == Seed::Other,
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

/// Removes specks and pinholes that the change has left behind.
fn smooth(mask: &mut [u8], before: &[u8], seeds: &[Seed], width: usize) {
    let parts = components(mask, width, Connectivity::Four);
    let mut is_new = vec![false; parts.list.len()];
    let mut is_said = vec![false; parts.list.len()];
    for p in 0..mask.len() {
        let part = parts.of[p] as usize;
        let around = [p, p.wrapping_sub(1), p + 1, p.wrapping_sub(width), p + width];
        is_new[part] |= around.into_iter().any(|q| q < mask.len() && mask[q] != before[q]);
        is_said[part] |= seeds[p] != Seed::Nothing && (seeds[p] == Seed::Object) == (mask[p] > 0);
    }
    for (p, inside) in mask.iter_mut().enumerate() {
        let part = parts.of[p] as usize;
        if parts.list[part].size < model().pixels && is_new[part] && !is_said[part] {
            *inside = 1 - *inside;
        }
    }
}
