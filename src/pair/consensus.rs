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
/// Descriptions up to this many times as long as the shortest are about as good. On real pairs the length does not tell which of those has
/// the better masks; failed searches, such as those that took an object for the background, are 20 % longer.
const LONGEST: f64 = 1.05;
/// Foregrounds whose overlap with the majority is at most this much smaller than the largest are as near. Not varied.
const AS_NEAR: f64 = 0.01;
/// Share of the majority's pixels on which the others must divide it into motions in the same way. Not varied.
const SAME_DIVISION: f64 = 0.9;

/// The foreground of a labelling: all pixels whose motions do not share the group of the background.
pub(super) fn foreground(labels: &[u8], groups: &[usize]) -> Buffer<bool> {
    labels.iter().map(|&label| groups[usize::from(label)] != groups[BACKGROUND]).collect()
}

/// What one search has found.
pub(super) struct Finding {
    /// The pixels of the frame that move in another way than the background.
    pub(super) foreground: Buffer<bool>,
    /// The label of every pixel.
    pub(super) labels: Buffer<u8>,
    /// Description length of both frames, nats.
    pub(super) length: f64,
}

/// What all searches have found together.
pub(super) struct Consensus {
    /// Index of the finding that is taken.
    pub(super) chosen: usize,
    /// How likely another search is to call a pixel foreground too, by the rule of succession: (s + 1) / (n + 2) if s of n have.
    pub(super) agreement: Buffer<f32>,
}

/// The nearest finding is that whose foreground has the largest intersection over union with the majority: the pixels that are foreground in at
/// least half of the findings; the first of equals. It is chosen unless the others divide the majority into motions in another way. Then the
/// choice among those about as near is the one with whose division they agree most; of equals that with the shortest description. A
/// finding with a much longer description than the shortest neither votes nor wins.
pub(super) fn consensus(findings: &[Finding]) -> Consensus {
    let shortest = findings.iter().map(|finding| finding.length).fold(f64::INFINITY, f64::min);
    let eligible: Vec<usize> = (0..findings.len()).filter(|&k| findings[k].length <= LONGEST * shortest).collect();
    let (mut common, mut either) = (vec![0usize; findings.len()], vec![0usize; findings.len()]);
    let mut agreement = Buffer::filled(findings[0].foreground.len(), 0.0);
    let mut majority = Buffer::with_capacity(agreement.len());
    for (p, agreement) in agreement.iter_mut().enumerate() {
        let votes = eligible.iter().filter(|&&k| findings[k].foreground[p]).count();
        *agreement = (votes as f32 + 1.0) / (eligible.len() as f32 + 2.0);
        let wins = votes * ONE_OF >= eligible.len();
        for &k in &eligible {
            let foreground = findings[k].foreground[p];
            common[k] += usize::from(foreground && wins);
            either[k] += usize::from(foreground || wins);
        }
        if wins {
            majority.push(p);
        }
    }
    let overlap = |k: usize| if either[k] == 0 { 1.0 } else { common[k] as f64 / either[k] as f64 };
    let overlaps: Vec<f64> = (0..findings.len()).map(overlap).collect();
    let largest = eligible.iter().fold(0.0, |most, &k| f64::max(most, overlaps[k]));
    // A finding agrees with itself.
    let agreeing = |k: usize| -> f64 {
        eligible.iter().map(|&other| same_division(&findings[k].labels, &findings[other].labels, &majority)).sum()
    };
    let agreed: Vec<f64> = (0..findings.len()).map(agreeing).collect();
    let mut chosen = eligible.iter().copied().find(|&k| overlaps[k] == largest).unwrap_or(0);
    if agreed[chosen] - 1.0 < SAME_DIVISION * (eligible.len() - 1) as f64 {
        for &k in eligible.iter().filter(|&&k| overlaps[k] >= largest - AS_NEAR) {
            let shorter = agreed[k] == agreed[chosen] && findings[k].length < findings[chosen].length;
            if agreed[k] > agreed[chosen] || shorter {
                chosen = k;
            }
        }
    }
    Consensus { chosen, agreement }
}

/// Share of some pixels that two labellings divide in the same way, the mean of both ways; not a number if there are no pixels.
fn same_division(one: &[u8], other: &[u8], pixels: &[usize]) -> f64 {
    (matched(one, other, pixels) + matched(other, one, pixels)) as f64 / (2 * pixels.len()) as f64
}

/// The number of pixels that match where each label is matched with that of the other labelling with which it has most of them in common.
#[inline(never)]
fn matched(labels: &[u8], other: &[u8], pixels: &[usize]) -> usize {
    let of = 1 + other.iter().copied().fold(0, u8::max) as usize;
    let mut common = vec![0usize; 256 * of];
    pixels.iter().for_each(|&p| common[usize::from(labels[p]) * of + usize::from(other[p])] += 1);
    common.chunks_exact(of).map(|row| row.iter().copied().fold(0, usize::max)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn chosen(findings: &[Finding]) -> usize {
        consensus(findings).chosen
    }

    /// Every digit is a motion, a dot the background.
    fn findings(rows: &[&str]) -> Vec<Finding> {
        let finding = |row: &&str| Finding {
            foreground: row.bytes().map(|b| b != b'.').collect(),
            labels: row.bytes().map(|b| if b == b'.' { 0 } else { b - b'0' }).collect(),
            length: 1000.0,
        };
        rows.iter().map(finding).collect()
    }

    #[test]
    fn a_failed_search_does_not_vote() {
        let mut findings = findings(&["11..", "..11", "..11", "11.."]);
        findings[0].length = 1200.0;
        findings[3].length = 1200.0;
        assert_eq!(chosen(&findings), 1);
    }

    #[test]
    fn an_object_that_half_of_them_see_is_kept() {
        assert_eq!(chosen(&findings(&["....", "11..", ".11.", "...."])), 1);
        assert_eq!(chosen(&findings(&["....", "11..", "111.", ".11."])), 2);
    }

    #[test]
    fn what_only_one_of_them_sees_is_not() {
        assert_eq!(chosen(&findings(&["11.1", "11..", "11..", "11.."])), 1);
        assert_eq!(chosen(&findings(&["..11", "....", "....", "...."])), 1);
    }

    #[test]
    fn agreement_counts_the_searches_that_may_vote() {
        let mut findings = findings(&["11..", "1...", "1.1.", "...1"]);
        assert_eq!(consensus(&findings[..1]).agreement[..], [2.0 / 3.0, 2.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0]);
        findings[3].length = 1200.0;
        assert_eq!(consensus(&findings).agreement[..], [0.8, 0.4, 0.4, 0.2]);
    }

    #[test]
    fn one_labelling_is_its_own_majority() {
        assert_eq!(chosen(&findings(&["1.."])), 0);
        assert_eq!(chosen(&findings(&["..."])), 0);
    }

    #[test]
    fn where_foregrounds_are_as_near_the_common_division_is_taken() {
        // Two things that move in different ways, which the first finding takes for one.
        assert_eq!(chosen(&findings(&["1111..", "1122..", "2211..", "1122.."])), 1);
        // The foreground weighs more: the others are not as near.
        assert_eq!(chosen(&findings(&["11111.", "1122..", "112222", "......"])), 0);
    }

    #[test]
    fn of_two_divisions_that_differ_the_one_with_the_shorter_description_is_taken() {
        let mut found = findings(&["1111..", "1122.."]);
        assert_eq!(chosen(&found), 0);
        found[1].length = 990.0;
        assert_eq!(chosen(&found), 1);
        // Where they differ little, the nearest is as good.
        let mut found = findings(&["11111111111111111111..", "11111111111111111112.."]);
        found[1].length = 990.0;
        assert_eq!(chosen(&found), 0);
    }
}
