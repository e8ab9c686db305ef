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

/// The foreground of a labelling: all pixels whose motions do not share the group of the background.
pub(super) fn foreground(labels: &[u8], groups: &[usize]) -> Buffer<bool> {
    labels.iter().map(|&label| groups[usize::from(label)] != groups[BACKGROUND]).collect()
}

/// What one search has found.
pub(super) struct Finding {
    /// The pixels of the frame that move in another way than the background.
    pub(super) foreground: Buffer<bool>,
    /// Description length of both frames, nats.
    pub(super) length: f64,
}

/// What all searches have found together.
pub(super) struct Consensus {
    /// Index of the finding that is nearest to the majority.
    pub(super) nearest: usize,
    /// How likely another search is to call a pixel foreground too, by the rule of succession: (s + 1) / (n + 2) if s of n have.
    pub(super) agreement: Buffer<f32>,
}

/// The nearest finding is that whose foreground has the largest intersection over union with the pixels that are foreground in at least half
/// of the findings; the first of equals. A finding with a much longer description than the shortest neither votes nor wins.
pub(super) fn consensus(findings: &[Finding]) -> Consensus {
    let shortest = findings.iter().map(|finding| finding.length).fold(f64::INFINITY, f64::min);
    let eligible: Vec<usize> = (0..findings.len()).filter(|&k| findings[k].length <= LONGEST * shortest).collect();
    let (mut common, mut either) = (vec![0usize; findings.len()], vec![0usize; findings.len()]);
    let mut agreement = Buffer::filled(findings[0].foreground.len(), 0.0);
    for (p, agreement) in agreement.iter_mut().enumerate() {
        let votes = eligible.iter().filter(|&&k| findings[k].foreground[p]).count();
        *agreement = (votes as f32 + 1.0) / (eligible.len() as f32 + 2.0);
        let majority = votes * ONE_OF >= eligible.len();
        for &k in &eligible {
            let foreground = findings[k].foreground[p];
            common[k] += usize::from(foreground && majority);
            either[k] += usize::from(foreground || majority);
        }
    }
    let overlap = |k: usize| if either[k] == 0 { 1.0 } else { common[k] as f64 / either[k] as f64 };
    let nearest = eligible.iter().copied().reduce(|best, k| if overlap(k) > overlap(best) { k } else { best });
    Consensus { nearest: nearest.unwrap_or(0), agreement }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn nearest(findings: &[Finding]) -> usize {
        consensus(findings).nearest
    }

    fn findings(rows: &[&str]) -> Vec<Finding> {
        let foreground = |row: &str| row.bytes().map(|b| b == b'x').collect();
        rows.iter().map(|row| Finding { foreground: foreground(row), length: 1000.0 }).collect()
    }

    #[test]
    fn a_failed_search_does_not_vote() {
        let mut findings = findings(&["xx..", "..xx", "..xx", "xx.."]);
        findings[0].length = 1200.0;
        findings[3].length = 1200.0;
        assert_eq!(nearest(&findings), 1);
    }

    #[test]
    fn an_object_that_half_of_them_see_is_kept() {
        assert_eq!(nearest(&findings(&["....", "xx..", ".xx.", "...."])), 1);
        assert_eq!(nearest(&findings(&["....", "xx..", "xxx.", ".xx."])), 2);
    }

    #[test]
    fn what_only_one_of_them_sees_is_not() {
        assert_eq!(nearest(&findings(&["xx.x", "xx..", "xx..", "xx.."])), 1);
        assert_eq!(nearest(&findings(&["..xx", "....", "....", "...."])), 1);
    }

    #[test]
    fn agreement_counts_the_searches_that_may_vote() {
        let mut findings = findings(&["xx..", "x...", "x.x.", "...x"]);
        assert_eq!(consensus(&findings[..1]).agreement[..], [2.0 / 3.0, 2.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0]);
        findings[3].length = 1200.0;
        assert_eq!(consensus(&findings).agreement[..], [0.8, 0.4, 0.4, 0.2]);
    }

    #[test]
    fn one_labelling_is_its_own_majority() {
        assert_eq!(nearest(&findings(&["x.."])), 0);
        assert_eq!(nearest(&findings(&["..."])), 0);
    }
}
