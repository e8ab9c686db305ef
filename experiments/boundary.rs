//! How well the borders of a labelling agree with those of the truth (DAVIS's F), the same in both benchmarks.

/// Tolerance of borders as a share of the frame's diagonal (DAVIS).
const TOLERANCE: f64 = 0.008;

/// The pixel grid, and where the truth is known.
pub struct Grid<'a> {
    pub width: usize,
    pub known: &'a [bool],
}

impl Grid<'_> {
    fn height(&self) -> usize {
        self.known.len() / self.width
    }

    /// F measure of borders, those next to unknown pixels left out; none where that leaves too little of the true borders.
    pub fn boundary(&self, truth: &[i16], found: &[i16]) -> Option<f64> {
        let all_known = self.known.iter().all(|&k| k);
        let (all_true, mut found) = (self.borders(truth), self.borders(found));
        let mut truth = all_true.clone();
        if !all_known {
            let far = self.far_from_unknown();
            for border in [&mut truth, &mut found] {
                border.iter_mut().zip(&far).for_each(|(b, &far)| *b &= far);
            }
        }
        let count = |mask: &[bool]| mask.iter().filter(|&&m| m).count();
        let (true_count, found_count) = (count(&truth), count(&found));
        if !all_known && (true_count as f64) < 0.25 * count(&all_true) as f64 {
            return None;
        }
        match (true_count, found_count) {
            (0, 0) => return Some(1.0),
            (0, _) | (_, 0) => return Some(0.0),
            _ => {}
        }
        let diagonal = ((self.width * self.width + self.height() * self.height()) as f64).sqrt();
        let tolerance = (TOLERANCE * diagonal).ceil() as usize;
        let met = |mask: &[bool], near: &[bool]| {
            mask.iter().zip(near).filter(|&(&m, &n)| m && n).count() as f64 / count(mask) as f64
        };
        let precision = met(&found, &self.within(&truth, tolerance));
        let recall = met(&truth, &self.within(&found, tolerance));
        Some(if precision + recall == 0.0 { 0.0 } else { 2.0 * precision * recall / (precision + recall) })
    }

    /// Pixels whose right or lower neighbour is different.
    fn borders(&self, labels: &[i16]) -> Vec<bool> {
        let right = |p: usize| !(p + 1).is_multiple_of(self.width) && labels[p] != labels[p + 1];
        let below = |p: usize| p + self.width < labels.len() && labels[p] != labels[p + self.width];
        (0..labels.len()).map(|p| right(p) || below(p)).collect()
    }

    /// Pixels that are known with all eight neighbours.
    fn far_from_unknown(&self) -> Vec<bool> {
        let (width, height) = (self.width, self.height());
        let known = |x: usize, y: usize| {
            (y.saturating_sub(1)..(y + 2).min(height))
                .all(|v| (x.saturating_sub(1)..(x + 2).min(width)).all(|u| self.known[v * width + u]))
        };
        (0..self.known.len()).map(|p| known(p % width, p / width)).collect()
    }

    /// Pixels whose distance from the mask is at most `reach`.
    fn within(&self, mask: &[bool], reach: usize) -> Vec<bool> {
        let (width, height) = (self.width, self.height());
        const FAR: usize = usize::MAX;
        // Distance along the column, then the nearest over the columns around.
        let mut along = vec![FAR; mask.len()];
        for x in 0..width {
            for order in [false, true] {
                let mut last = FAR;
                for k in 0..height {
                    let p = (if order { height - 1 - k } else { k }) * width + x;
                    last = if mask[p] { 0 } else { last.saturating_add(1) };
                    along[p] = along[p].min(last);
                }
            }
        }
        let near = |p: usize| {
            let (x, row) = (p % width, p - p % width);
            (x.saturating_sub(reach)..(x + reach + 1).min(width)).any(|u| {
                let (dx, dy) = (u.abs_diff(x), along[row + u]);
                dy <= reach && dx * dx + dy * dy <= reach * reach
            })
        };
        (0..mask.len()).map(near).collect()
    }
}
