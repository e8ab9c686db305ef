//! Connected components of a labelling: position, size, and absorption of small ones.

use crate::order::ascending;

/// Which pixels are neighbours.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Connectivity {
    /// Pixels that share a side.
    Four,
    /// Pixels that share a side or a corner.
    Eight,
}

/// A connected region of one label.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Component {
    /// The label of its pixels.
    pub(crate) label: u8,
    /// Number of its pixels.
    pub(crate) size: usize,
    /// Bounding box, inclusive: first column, first row, last column, last row.
    pub(crate) bounds: [usize; 4],
}

/// All components of a labelling, numbered in the raster order of their first pixels.
#[derive(Clone, Debug)]
pub(crate) struct Components {
    /// Index in `list` of the component of every pixel.
    pub(crate) of: Vec<u32>,
    pub(crate) list: Vec<Component>,
}

/// A maximal run of pixels with one label in a row.
#[derive(Clone, Copy, Default)]
struct Run {
    /// First column, and the column after the last.
    columns: [usize; 2],
    row: usize,
    label: u8,
    /// Union-find link: an earlier run of the same component, or the run itself.
    earlier: usize,
}

/// The components of `labels`, row-major with rows of `width` pixels.
pub(crate) fn components(labels: &[u8], width: usize, connectivity: Connectivity) -> Components {
    let mut runs: Vec<Run> = Vec::new();
    let mut above = 0..0;
    for (row, line) in labels.chunks_exact(width.max(1)).enumerate() {
        let begin = runs.len();
        let mut start = 0;
        for part in line.chunk_by(|a, b| a == b) {
            let columns = [start, start + part.len()];
            start = columns[1];
            let earlier = runs.len();
            runs.push(Run { columns, row, label: part[0], earlier });
        }
        join(&mut runs, above, begin, connectivity);
        above = begin..runs.len();
    }
    let mut of = vec![0; labels.len()];
    let mut list: Vec<Component> = Vec::new();
    let mut numbers = vec![0; runs.len()];
    for k in 0..runs.len() {
        let first = first_of(&mut runs, k);
        let Run { columns: [start, end], row, label, .. } = runs[k];
        if first == k {
            numbers[k] = list.len();
            list.push(Component { label, size: 0, bounds: [start, row, start, row] });
        }
        let component = &mut list[numbers[first]];
        component.size += end - start;
        let [x0, y0, x1, _] = component.bounds;
        component.bounds = [x0.min(start), y0, x1.max(end - 1), row];
        of[row * width..][start..end].fill(numbers[first] as u32);
    }
    Components { of, list }
}

/// Joins the runs of the last row, which start at index `begin`, with the runs of the row above that they touch.
fn join(runs: &mut [Run], above: std::ops::Range<usize>, begin: usize, connectivity: Connectivity) {
    let reach = usize::from(connectivity == Connectivity::Eight);
    let mut from = above.start;
    for k in begin..runs.len() {
        let [start, end] = runs[k].columns;
        // A run above that ends before this one begins cannot touch a later one either.
        while from < above.end && runs[from].columns[1] + reach <= start {
            from += 1;
        }
        for other in from..above.end {
            if runs[other].columns[0] >= end + reach {
                break;
            }
            if runs[other].label == runs[k].label {
                let (a, b) = (first_of(runs, other), first_of(runs, k));
                runs[a.max(b)].earlier = a.min(b);
                runs[k].earlier = a.min(b);
            }
        }
    }
}

/// The first known run of the component of run `k`. Halves the path on the way.
fn first_of(runs: &mut [Run], mut k: usize) -> usize {
    while runs[k].earlier != k {
        runs[k].earlier = runs[runs[k].earlier].earlier;
        k = runs[k].earlier;
    }
    k
}

/// Gives every 4-connected component of fewer than `smallest` pixels the most frequent label around it (ties: the smallest label),
/// smallest components first. A component that fills the frame stays.
pub(crate) fn absorb_small(labels: &mut [u8], width: usize, smallest: usize) {
    // The component that absorbs one may be small too and be absorbed in the next round. Every round but the last removes a component,
    // and eight rounds are enough for all but contrived labellings.
    for _ in 0..8 {
        if !absorb_once(labels, width, smallest) {
            break;
        }
    }
}

fn absorb_once(labels: &mut [u8], width: usize, smallest: usize) -> bool {
    let height = labels.len().checked_div(width).unwrap_or(0);
    let found = components(labels, width, Connectivity::Four);
    let small = ascending(found.list.iter().map(|c| c.size as f64));
    let mut changed = false;
    for c in small.iter().copied().filter(|&c| found.list[c].size < smallest) {
        let Component { label, bounds: [x0, y0, x1, y1], .. } = found.list[c];
        let inside = |x: usize, y: usize| found.of[y * width + x] == c as u32;
        let mut votes = [0usize; 256];
        for y in y0.saturating_sub(1)..=(y1 + 1).min(height - 1) {
            for x in x0.saturating_sub(1)..=(x1 + 1).min(width - 1) {
                if inside(x, y) {
                    continue;
                }
                let mut around = false;
                for v in y.saturating_sub(1)..=(y + 1).min(height - 1) {
                    for u in x.saturating_sub(1)..=(x + 1).min(width - 1) {
                        around |= inside(u, v);
                    }
                }
                if around {
                    votes[usize::from(labels[y * width + x])] += 1;
                }
            }
        }
        let mut winner = usize::from(label);
        let mut most = 0;
        for (l, &count) in votes.iter().enumerate() {
            // Another component of the same label may touch it at a corner. It does not count.
            if l != usize::from(label) && count > most {
                (winner, most) = (l, count);
            }
        }
        if winner != usize::from(label) {
            changed = true;
            for y in y0..=y1 {
                for x in x0..=x1 {
                    if inside(x, y) {
                        labels[y * width + x] = winner as u8;
                    }
                }
            }
        }
    }
    changed
}

#[cfg(test)]
mod tests {
    use super::*;

    const PICTURE: [u8; 20] = [
        0, 0, 1, 0, 0, //
        0, 1, 0, 0, 2, //
        0, 0, 0, 2, 2, //
        1, 0, 0, 2, 2, //
    ];

    #[test]
    fn corners_connect_only_with_eight_neighbours() {
        let four = components(&PICTURE, 5, Connectivity::Four);
        let eight = components(&PICTURE, 5, Connectivity::Eight);
        let count = |c: &Components, label| c.list.iter().filter(|c| c.label == label).count();
        assert_eq!((count(&four, 1), count(&eight, 1)), (3, 2));
        assert_eq!((count(&four, 0), count(&eight, 0)), (1, 1));
        let two = four.list.iter().find(|c| c.label == 2).unwrap();
        assert_eq!((two.size, two.bounds), (5, [3, 1, 4, 3]));
        assert_eq!(four.list.iter().map(|c| c.size).sum::<usize>(), 20);
        for (p, &c) in four.of.iter().enumerate() {
            assert_eq!(four.list[c as usize].label, PICTURE[p]);
        }
    }

    /// The components by flood fill.
    fn flooded(labels: &[u8], width: usize, connectivity: Connectivity) -> Components {
        let height = labels.len() / width;
        let (mut of, mut list) = (vec![u32::MAX; labels.len()], Vec::new());
        for start in 0..labels.len() {
            if of[start] != u32::MAX {
                continue;
            }
            let number = list.len() as u32;
            let mut component = Component { label: labels[start], size: 0, bounds: [width, height, 0, 0] };
            let mut stack = vec![start];
            of[start] = number;
            while let Some(p) = stack.pop() {
                let (x, y) = (p % width, p / width);
                let [x0, y0, x1, y1] = component.bounds;
                component.bounds = [x0.min(x), y0.min(y), x1.max(x), y1.max(y)];
                component.size += 1;
                for q in 0..labels.len() {
                    let (dx, dy) = (x.abs_diff(q % width), y.abs_diff(q / width));
                    let near = dx.max(dy) == 1 && (connectivity == Connectivity::Eight || dx + dy == 1);
                    if near && of[q] == u32::MAX && labels[q] == labels[start] {
                        of[q] = number;
                        stack.push(q);
                    }
                }
            }
            list.push(component);
        }
        Components { of, list }
    }

    #[test]
    fn components_agree_with_flood_fill() {
        let mut random = crate::random::Random::from_seed(11);
        for (width, height, kinds) in [(19, 14, 2), (1, 9, 2), (12, 1, 3), (13, 13, 4), (25, 8, 2)] {
            let labels: Vec<u8> = (0..width * height).map(|_| random.uniform(0.0, f64::from(kinds)) as u8).collect();
            for connectivity in [Connectivity::Four, Connectivity::Eight] {
                let (found, expected) =
                    (components(&labels, width, connectivity), flooded(&labels, width, connectivity));
                assert_eq!((found.of, found.list), (expected.of, expected.list));
            }
        }
    }

    #[test]
    fn small_components_take_the_label_around_them() {
        let mut labels = PICTURE;
        absorb_small(&mut labels, 5, 3);
        let expected = [0, 0, 0, 0, 0, 0, 0, 0, 0, 2, 0, 0, 0, 2, 2, 0, 0, 0, 2, 2];
        assert_eq!(labels, expected);
    }

    #[test]
    fn small_components_inside_small_components_vanish_too() {
        // A ring of 1 (8 pixels) around a 2, in a field of 0.
        let mut labels = vec![0u8; 81];
        for y in 3..6 {
            for x in 3..6 {
                labels[y * 9 + x] = 1;
            }
        }
        labels[40] = 2;
        absorb_small(&mut labels, 9, 10);
        assert!(labels.iter().all(|&l| l == 0));
    }

    #[test]
    fn a_single_component_stays() {
        let mut labels = vec![3u8; 12];
        absorb_small(&mut labels, 4, 100);
        assert!(labels.iter().all(|&l| l == 3));
        assert!(components(&[], 0, Connectivity::Four).list.is_empty());
    }
}
