//! Connected components of a labelling: where they are, how large, and what becomes of those that are too small.

use crate::order::ascending;

/// Which pixels touch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Connectivity {
    /// Those that share a side.
    Four,
    /// Those that share a side or a corner.
    Eight,
}

/// One connected region of one label.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Component {
    /// The label of its pixels.
    pub(crate) label: u8,
    /// Number of its pixels.
    pub(crate) size: usize,
    /// Bounding box: first column, first row, last column, last row.
    pub(crate) bounds: [usize; 4],
}

/// All components of a labelling, numbered in the raster order of their first pixels.
#[derive(Clone, Debug)]
pub(crate) struct Components {
    /// Number of the component of every pixel.
    pub(crate) of: Vec<u32>,
    pub(crate) list: Vec<Component>,
}

/// The components of `labels`, rows of `width` pixels.
pub(crate) fn components(labels: &[u8], width: usize, connectivity: Connectivity) -> Components {
    const UNSEEN: u32 = u32::MAX;
    let height = labels.len().checked_div(width).unwrap_or(0);
    let mut of = vec![UNSEEN; labels.len()];
    let mut list = Vec::new();
    let mut stack = Vec::new();
    for start in 0..width * height {
        if of[start] != UNSEEN {
            continue;
        }
        let number = list.len() as u32;
        let label = labels[start];
        let mut component = Component { label, size: 0, bounds: [width, height, 0, 0] };
        of[start] = number;
        stack.push(start);
        while let Some(p) = stack.pop() {
            let (x, y) = (p % width, p / width);
            let [x0, y0, x1, y1] = component.bounds;
            component.bounds = [x0.min(x), y0.min(y), x1.max(x), y1.max(y)];
            component.size += 1;
            for v in y.saturating_sub(1)..=(y + 1).min(height - 1) {
                for u in x.saturating_sub(1)..=(x + 1).min(width - 1) {
                    let q = v * width + u;
                    let touches = connectivity == Connectivity::Eight || u == x || v == y;
                    if touches && of[q] == UNSEEN && labels[q] == label {
                        of[q] = number;
                        stack.push(q);
                    }
                }
            }
        }
        list.push(component);
    }
    Components { of, list }
}

/// Gives every 4-connected component of fewer than `smallest` pixels the label most frequent around it (the smaller label
/// of equals), the smallest components first. A component with nothing around it stays.
pub(crate) fn absorb_small(labels: &mut [u8], width: usize, smallest: usize) {
    // What a component is given to may itself be given away later: then both are one component in the next round. Each
    // round but the last removes a component; a handful is enough for all but contrived labellings.
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
    for c in small.into_iter().filter(|&c| found.list[c].size < smallest) {
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
            // Its own label may touch it at a corner: that is no surrounding.
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
