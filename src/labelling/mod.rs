//! From motions to masks: the terms of the labelling energy, their solver, splitting and merging of regions, and upsampling of labels to
//! the full frame.
//!
//! In every labelling the background has the label [`BACKGROUND`], however few pixels it has. Only the report of a pair numbers motions by
//! size.

pub(crate) mod confidence;
pub(crate) mod options;
pub(crate) mod regions;
pub(crate) mod shadows;
pub(crate) mod solver;
pub(crate) mod terms;
pub(crate) mod upsampling;

use crate::frame::Plane;

/// The label of the background in every labelling.
pub(crate) const BACKGROUND: usize = 0;

/// The labels of the objects among `of` labels.
pub(crate) fn objects(of: usize) -> std::ops::Range<usize> {
    BACKGROUND + 1..of
}

/// Whether a pixel's label is that of the background.
#[inline(always)]
pub(crate) fn is_background(label: u8) -> bool {
    usize::from(label) == BACKGROUND
}

/// Calls `pair` for every pair of 4-connected neighbours, in rows of `width`, that have different labels.
pub(crate) fn across_borders(labels: &[u8], width: usize, mut pair: impl FnMut(usize, usize)) {
    /// Pixels compared together; for speed.
    const PART: usize = 16;
    let rows = labels.chunks_exact(width).zip(labels[width..].chunks_exact(width).map(Some).chain([None]));
    for (y, (row, below)) in rows.enumerate() {
        for left in (0..width).step_by(PART) {
            let part = |row: &[u8], from: usize| row.get(from..).and_then(|rest| rest.first_chunk::<PART>().copied());
            // Most pixels are like their neighbours.
            let here = part(row, left);
            let alike = here.is_some() && here == part(row, left + 1) && here == part(below.unwrap_or(row), left);
            if alike {
                continue;
            }
            for x in left..(left + PART).min(width) {
                let p = y * width + x;
                if row.get(x + 1).is_some_and(|right| *right != row[x]) {
                    pair(p, p + 1);
                }
                if below.is_some_and(|below| below[x] != row[x]) {
                    pair(p, p + width);
                }
            }
        }
    }
}

/// Indices of the pixels whose label satisfies `which`, in order.
pub(crate) fn pixels(labels: &[u8], which: impl Fn(usize) -> bool) -> Vec<usize> {
    (0..labels.len()).filter(|&p| which(usize::from(labels[p]))).collect()
}

/// Indicator of a label: 1 on its pixels, 0 elsewhere.
pub(crate) fn mask_of(labels: &[u8], label: u8, width: usize, height: usize) -> Plane {
    Plane::from_vec(width, height, labels.iter().map(|&l| if l == label { 1.0 } else { 0.0 }).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_border_is_crossed_once_and_in_order() {
        // Stripes, blocks and single pixels, in rows shorter and longer than the parts that are compared together.
        for (width, height) in [(1, 1), (5, 4), (16, 3), (17, 9), (50, 40)] {
            for pattern in
                [|_, y| y / 3, |x, _| x / 17, |x: usize, y: usize| usize::from((x, y) == (33, 12)), |x, y| x * y % 3]
            {
                let labels: Vec<u8> = (0..width * height).map(|p| pattern(p % width, p / width) as u8).collect();
                let mut expected = Vec::new();
                for p in 0..labels.len() {
                    let neighbours = [(p + 1, p % width + 1 < width), (p + width, p + width < labels.len())];
                    expected.extend(
                        neighbours.into_iter().filter(|&(q, is)| is && labels[p] != labels[q]).map(|(q, _)| (p, q)),
                    );
                }
                let mut found = Vec::new();
                across_borders(&labels, width, |p, q| found.push((p, q)));
                assert_eq!(found, expected, "{width} × {height}");
            }
        }
    }
}
