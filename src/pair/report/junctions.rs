//! Junctions: how likely it is that two neighbouring regions belong to one thing.
//!
//! People and animals that are partly at rest move in parts that affine motions cannot join. Where two frames do not decide it, a person
//! can, so the report offers the borders worth asking about.

use serde::Serialize;

use crate::pair::groups::Regions;

/// The common border of two motions of a [`Segmentation`](super::Segmentation), and how likely both belong to one thing.
#[non_exhaustive]
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Junction {
    /// The labels of the two motions, the smaller first.
    pub labels: [u8; 2],
    /// Probability, 0…1, that the two motions belong to one thing: one object, or one background. For the groups, the likeliest regions are
    /// joined first and measured again together, which may change the probabilities of others.
    pub likelihood: f64,
    /// Length of the border, pixels of the full-size frame. It is measured at the working size.
    pub border: usize,
}

/// The junctions of the motions in `order`, by labels; the position of a motion in `order` is its label in the report. Borders that are too
/// short to decide on are left out. Each pixel of the labels is `step` pixels of the frame wide.
pub(super) fn junctions(mut regions: Regions<'_>, step: usize, order: &[usize]) -> Vec<Junction> {
    let mut found = Vec::new();
    for (a, &i) in order.iter().enumerate() {
        for (b, &j) in order.iter().enumerate().skip(a + 1) {
            let border = regions.border([i, j]) * step;
            let known = regions.likelihood([i, j]);
            found.extend(known.map(|likelihood| Junction { labels: [a as u8, b as u8], likelihood, border }));
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::Model;
    use crate::motion::AffineMotion;

    const WIDTH: usize = 60;

    /// Ground (0), an object with a part on its right that moves a little less (1, 2), and an object apart (3).
    fn found(order: &[usize]) -> Vec<Junction> {
        let labels: Vec<u8> = (0..WIDTH * 40)
            .map(|p| match (p % WIDTH, p / WIDTH) {
                (10..25, 10..30) => 1,
                (25..35, 10..30) => 2,
                (45..55, 10..20) => 3,
                _ => 0,
            })
            .collect();
        let motions = [0.0, 6.0, 5.0, -4.0].map(|u| AffineMotion::translation(u, 0.0));
        junctions(Regions::new(&motions, &labels, WIDTH, &Model::DEFAULT), 2, order)
    }

    #[test]
    fn neighbours_have_a_junction_and_others_have_none() {
        let found = found(&[0, 1, 2, 3]);
        assert_eq!(found.iter().map(|junction| junction.labels).collect::<Vec<_>>(), [[0, 1], [0, 2], [0, 3], [1, 2]]);
        assert_eq!(found.iter().map(|junction| junction.border).collect::<Vec<_>>(), [100, 80, 80, 40]);
        assert!(found.iter().all(|junction| (0.0..=1.0).contains(&junction.likelihood)));
    }

    #[test]
    fn parts_of_one_thing_are_likelier_to_belong_together_than_thing_and_ground() {
        let found = found(&[0, 1, 2, 3]);
        let [ground, part, apart, parts] = [0, 1, 2, 3].map(|k| found[k].likelihood);
        assert!(parts > 0.7 && ground < 0.2 && part < 0.2 && apart < 0.2, "{found:?}");
    }

    #[test]
    fn labels_are_those_of_the_report() {
        // The part (2) is numbered before the thing (1), and the thing apart has no pixels in the report.
        let (before, after) = (found(&[0, 1, 2, 3]), found(&[0, 2, 1]));
        assert_eq!(after.iter().map(|junction| junction.labels).collect::<Vec<_>>(), [[0, 1], [0, 2], [1, 2]]);
        let likelihoods = [&after[1], &after[0], &after[2]].map(|junction| junction.likelihood);
        assert_eq!(likelihoods, [&before[0], &before[1], &before[3]].map(|junction| junction.likelihood));
    }
}
