//! Strokes change their frame where they are: one that adds to an object takes nothing away, one that takes away adds nothing, and what
//! nothing connects with a stroke stays.

use crate::clip::annotation::{Said, Seed};
use crate::clip::model;
use crate::components::{Connectivity, components};

/// Takes back what changes of an object's mask without a new stroke. `now` are the labels before, and what was `said` before and is said
/// now.
pub(super) fn keep(mask: &mut [u8], number: u8, now: &[u8], [before, said]: [&Said; 2], width: usize) {
    let Some((old, new)) = strokes(number, before, said) else { return };
    let is_new = |p: usize, seed: Seed| new[p] == seed && old.as_ref().is_none_or(|old| old[p] != seed);
    let changes: Vec<u8> = (0..mask.len()).map(|p| mask[p] + 2 * u8::from(now[p] == number)).collect();
    // 1 is added, 2 is taken away.
    let parts = components(&changes, width, Connectivity::Eight);
    let mut is_meant = vec![false; parts.list.len()];
    for p in 0..mask.len() {
        is_meant[parts.of[p] as usize] |= match changes[p] {
            1 => is_new(p, Seed::Object),
            2 => is_new(p, Seed::Other),
            _ => false,
        };
    }
    for (p, inside) in mask.iter_mut().enumerate() {
        if matches!(changes[p], 1 | 2) && !is_meant[parts.of[p] as usize] && new[p] == Seed::Nothing {
            *inside = u8::from(changes[p] == 2);
        }
    }
    let was: Vec<u8> = now.iter().map(|&label| u8::from(label == number)).collect();
    smooth(mask, &was, &new, width);
}

/// What was said of an object before and what is said now, if strokes were added and nothing was taken back.
fn strokes(number: u8, before: &Said, said: &Said) -> Option<(Option<Vec<Seed>>, Vec<Seed>)> {
    if said.prompt(number) != before.prompt(number) {
        return None;
    }
    let (old, new) = (before.seeds(number), said.seeds(number)?);
    let goes_on = old
        .as_ref()
        .is_none_or(|old| old.iter().zip(&new).all(|(old, new)| *old == Seed::Nothing || *new != Seed::Nothing));
    goes_on.then_some((old, new))
}

/// Removes specks and pinholes that the change has left behind.
fn smooth(mask: &mut [u8], was: &[u8], seeds: &[Seed], width: usize) {
    let parts = components(mask, width, Connectivity::Four);
    let mut is_new = vec![false; parts.list.len()];
    let mut is_said = vec![false; parts.list.len()];
    for p in 0..mask.len() {
        let part = parts.of[p] as usize;
        is_new[part] |= [p.wrapping_sub(1), p + 1, p.wrapping_sub(width), p + width, p]
            .into_iter()
            .any(|q| q < mask.len() && mask[q] != was[q]);
        is_said[part] |= seeds[p] != Seed::Nothing && (seeds[p] == Seed::Object) == (mask[p] > 0);
    }
    for (p, inside) in mask.iter_mut().enumerate() {
        let part = parts.of[p] as usize;
        if parts.list[part].size < model().pixels && is_new[part] && !is_said[part] {
            *inside = 1 - *inside;
        }
    }
}
