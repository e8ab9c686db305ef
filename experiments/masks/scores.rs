//! How well labels agree with the truth: the usual figures of motion segmentation.
//!
//! Pixels whose true label is [`VOID`] are left out everywhere; a found label [`VOID`] is "no label", which matches nothing. Truth 0
//! is the background.

use serde::Serialize;
use veronese::factorisation::assignment::assign;

use crate::boundary::Grid;

/// "Not known" in the truth, "no label" in what was found.
pub const VOID: u8 = 255;
/// A found label with a smaller share of the pixels than this is not counted.
const SMALLEST_SHARE: f64 = 0.002;

/// The figures of one labelling. Those of foreground and background exist where the truth has both.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct Scores {
    /// Mean over the true labels of the intersection over union with the found label that is assigned to each, one to one, so
    /// that the sum is largest; 0 where there is none.
    pub miou: f64,
    /// Intersection over union of the foreground, where each found label is foreground if most of its pixels are: what a user
    /// gets who joins labels by hand.
    pub j_oracle: Option<f64>,
    /// The same where everything is foreground but the label with most background pixels.
    pub j_background: Option<f64>,
    /// F measure of the border of the foreground of `j_background`, within 0.8 % of the diagonal.
    pub boundary: Option<f64>,
    /// Adjusted Rand index.
    pub rand: f64,
    /// Number of true labels.
    pub truth_count: usize,
    /// Number of found labels.
    pub found_count: usize,
}

/// How many pixels of each true label have each found label.
struct Contingency {
    truth: Vec<u8>,
    found: Vec<u8>,
    /// `counts[t][f]`, indices into the lists above.
    counts: Vec<Vec<usize>>,
}

impl Contingency {
    fn new(truth: &[u8], found: &[u8]) -> Contingency {
        let mut table = vec![[0usize; 256]; 256];
        for (&t, &f) in truth.iter().zip(found).filter(|&(&t, _)| t != VOID) {
            table[usize::from(t)][usize::from(f)] += 1;
        }
        let present = |seen: &dyn Fn(usize) -> bool| (0..=255u8).filter(|&l| seen(usize::from(l))).collect::<Vec<u8>>();
        let true_labels = present(&|l| table[l].iter().any(|&c| c > 0));
        let found_labels = present(&|l| table.iter().any(|row| row[l] > 0));
        let row = |t: &u8| found_labels.iter().map(|&f| table[usize::from(*t)][usize::from(f)]).collect();
        Contingency { counts: true_labels.iter().map(row).collect(), truth: true_labels, found: found_labels }
    }

    fn total(&self) -> usize {
        self.counts.iter().flatten().sum()
    }

    fn of_truth(&self, t: usize) -> usize {
        self.counts[t].iter().sum()
    }

    fn of_found(&self, f: usize) -> usize {
        self.counts.iter().map(|row| row[f]).sum()
    }

    /// Indices of the found labels that are labels.
    fn labels(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.found.len()).filter(|&f| self.found[f] != VOID)
    }

    /// The largest sum of overlaps over one-to-one assignments of true to found labels.
    fn best_sum(&self) -> f64 {
        let labels: Vec<usize> = self.labels().collect();
        let size = self.truth.len().max(labels.len());
        let overlap = |t: usize, k: usize| match labels.get(k) {
            Some(&f) if t < self.truth.len() => self.overlap(t, f),
            _ => 0.0,
        };
        let costs: Vec<Vec<f64>> = (0..size).map(|t| (0..size).map(|k| -overlap(t, k)).collect()).collect();
        assign(&costs).into_iter().enumerate().map(|(t, k)| overlap(t, k)).sum()
    }

    fn overlap(&self, t: usize, f: usize) -> f64 {
        let both = self.counts[t][f];
        both as f64 / (self.of_truth(t) + self.of_found(f) - both).max(1) as f64
    }

    fn rand(&self) -> f64 {
        let pairs = |count: usize| count as f64 * (count as f64 - 1.0) / 2.0;
        let together: f64 = self.counts.iter().flatten().map(|&c| pairs(c)).sum();
        let in_truth: f64 = (0..self.truth.len()).map(|t| pairs(self.of_truth(t))).sum();
        let in_found: f64 = (0..self.found.len()).map(|f| pairs(self.of_found(f))).sum();
        let by_chance = in_truth * in_found / pairs(self.total());
        let most = 0.5 * (in_truth + in_found);
        if most == by_chance { 1.0 } else { (together - by_chance) / (most - by_chance) }
    }
}

/// All figures.
pub fn scores(truth: &[u8], found: &[u8], width: usize) -> Scores {
    let table = Contingency::new(truth, found);
    let total = table.total();
    let least = SMALLEST_SHARE * total as f64;
    let known: Vec<bool> = truth.iter().map(|&t| t != VOID).collect();
    let grid = Grid { width, known: &known };
    let mut result = Scores {
        miou: table.best_sum() / table.truth.len() as f64,
        j_oracle: None,
        j_background: None,
        boundary: None,
        rand: table.rand(),
        truth_count: table.truth.len(),
        found_count: table.labels().filter(|&f| table.of_found(f) as f64 >= least).count(),
    };
    if table.truth.first() == Some(&0) && table.truth.len() > 1 {
        let of_background = |f: usize| table.counts[0][f];
        let mut foreground = [false; 256];
        for f in 0..table.found.len() {
            foreground[usize::from(table.found[f])] = 2 * of_background(f) < table.of_found(f);
        }
        let moving: Vec<bool> = truth.iter().map(|&t| t != 0 && t != VOID).collect();
        let select = |counts: &dyn Fn(u8) -> bool| -> Vec<bool> {
            found.iter().zip(&known).map(|(&f, &k)| k && counts(f)).collect()
        };
        let background = first_largest(table.labels().map(|f| (table.found[f], of_background(f)))).unwrap_or(VOID);
        let chosen = select(&|f| f != background);
        result.j_oracle = Some(intersection_over_union(&select(&|f| foreground[usize::from(f)]), &moving));
        result.j_background = Some(intersection_over_union(&chosen, &moving));
        let levels = |mask: &[bool]| mask.iter().map(|&m| i16::from(m)).collect::<Vec<i16>>();
        result.boundary = grid.boundary(&levels(&moving), &levels(&chosen));
    }
    result
}

fn first_largest(counts: impl Iterator<Item = (u8, usize)>) -> Option<u8> {
    let mut best: Option<(u8, usize)> = None;
    for (label, count) in counts {
        if best.is_none_or(|(_, most)| count > most) {
            best = Some((label, count));
        }
    }
    best.map(|(label, _)| label)
}

fn intersection_over_union(a: &[bool], b: &[bool]) -> f64 {
    let both = a.iter().zip(b).filter(|&(&a, &b)| a && b).count();
    let either = a.iter().zip(b).filter(|&(&a, &b)| a || b).count();
    if either == 0 { 1.0 } else { both as f64 / either as f64 }
}
