//! The labelling that agrees best with the others.
//!
//! The search is greedy: where the evidence is weak, what it finds depends on the order in which the pixels are visited. Mirror images of the
//! frames are as good as the frames themselves, so that their labellings are samples of what the search may find. What most of them
//! call moving is more reliable than any of them alone, and than the one with the shortest description.

use crate::labelling::BACKGROUND;
use crate::workspace::Buffer;

/// A pixel is foreground if at least one of this many labellings says so. Chosen on real pairs, whose objects are missed more often than
/// invented.
const ONE_OF: usize = 2;

/// The foreground of a labelling: all pixels whose motions do not share the group of the background.
pub(super) fn foreground(labels: &[u8], groups: &[usize]) -> Buffer<bool> {
    labels.iter().map(|&label| groups[usize::from(label)] != groups[BACKGROUND]).collect()
}

/// Index of the foreground that has the largest intersection over union with the pixels that are foreground in at least half of them; the
/// first of equals.
pub(super) fn nearest_to_majority(foregrounds: &[Buffer<bool>]) -> usize {
    let pixels = foregrounds[0].len();
    let (mut common, mut either) = (vec![0usize; foregrounds.len()], vec![0usize; foregrounds.len()]);
    for p in 0..pixels {
        let votes = foregrounds.iter().filter(|foreground| foreground[p]).count();
        let majority = votes * ONE_OF >= foregrounds.len();
        for (k, foreground) in foregrounds.iter().enumerate() {
            common[k] += usize::from(foreground[p] && majority);
            either[k] += usize::from(foreground[p] || majority);
        }
    }
    let overlap = |k: usize| if either[k] == 0 { 1.0 } else { common[k] as f64 / either[k] as f64 };
    (1..foregrounds.len()).fold(0, |best, k| if overlap(k) > overlap(best) { k } else { best })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn foregrounds(rows: &[&str]) -> Vec<Buffer<bool>> {
        rows.iter().map(|row| row.bytes().map(|b| b == b'x').collect()).collect()
    }

    #[test]
    fn an_object_that_half_of_them_see_is_kept() {
        assert_eq!(nearest_to_majority(&foregrounds(&["....", "xx..", ".xx.", "...."])), 1);
        assert_eq!(nearest_to_majority(&foregrounds(&["....", "xx..", "xxx.", ".xx."])), 2);
    }

    #[test]
    fn what_only_one_of_them_sees_is_not() {
        assert_eq!(nearest_to_majority(&foregrounds(&["xx.x", "xx..", "xx..", "xx.."])), 1);
        assert_eq!(nearest_to_majority(&foregrounds(&["..xx", "....", "....", "...."])), 1);
    }

    #[test]
    fn one_labelling_is_its_own_majority() {
        assert_eq!(nearest_to_majority(&foregrounds(&["x.."])), 0);
        assert_eq!(nearest_to_majority(&foregrounds(&["..."])), 0);
    }
}
