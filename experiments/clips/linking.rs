//! Labels of a clip without a clip segmenter: each pair of frames by itself, and masks of successive frames linked if the one, carried
//! along its motions, lands on the other.

use veronese::{Frame, Result, SegmentOptions, Segmentation, UNLABELLED, segment_pair};

/// Least IoU of a mask carried along its motions with its successor.
const LINKED: f64 = 0.1;

/// A label for every pixel of every frame: the groups of each pair, numbered so that a mask keeps its number as long as it is found
/// again in the next frame. There are [`UNLABELLED`] numbers at most; masks beyond them have no label.
pub(crate) fn pair_by_pair(frames: &[Frame], options: &SegmentOptions) -> Result<Vec<Vec<u8>>> {
    let mut labels: Vec<Vec<u8>> = Vec::new();
    let mut carried: Vec<u8> = Vec::new();
    let mut next = 0;
    for (t, frame) in frames.iter().enumerate() {
        // The last frame has a neighbour on the other side only.
        let Some(other) = frames.get(t + 1).or_else(|| frames.get(t.checked_sub(1)?)) else { break };
        let found = segment_pair(frame, other, options, &mut |_| {})?;
        let groups: Vec<u8> = found
            .labels
            .iter()
            .map(|&label| found.motions.get(usize::from(label)).map_or(UNLABELLED, |motion| motion.group))
            .collect();
        let numbers = linked(&groups, &carried, &mut next);
        let numbered: Vec<u8> = groups.iter().map(|&group| numbers[usize::from(group)]).collect();
        carried = carry(&found, &numbered);
        labels.push(numbered);
    }
    Ok(labels)
}

/// Where the labels of a frame are in the next.
fn carry(found: &Segmentation, labels: &[u8]) -> Vec<u8> {
    let (width, height) = (found.width, found.height);
    let mut carried = vec![UNLABELLED; labels.len()];
    for (p, (&motion, &label)) in found.labels.iter().zip(labels).enumerate() {
        let Some(motion) = found.motions.get(usize::from(motion)) else { continue };
        let (x, y) = ((p % width) as f64, (p / width) as f64);
        let [u, v] = motion.matrix.flow(x, y);
        let (x, y) = ((x + u).round(), (y + v).round());
        if x >= 0.0 && y >= 0.0 && x < width as f64 && y < height as f64 {
            carried[y as usize * width + x as usize] = label;
        }
    }
    carried
}

/// The number of every group: that of the mask carried here with which it overlaps most, best overlaps first, or a new one.
fn linked(groups: &[u8], carried: &[u8], next: &mut u8) -> [u8; 256] {
    let mut common = vec![[0usize; 256]; 256];
    let (mut sizes, mut reached) = ([0usize; 256], [0usize; 256]);
    groups.iter().for_each(|&group| sizes[usize::from(group)] += 1);
    carried.iter().for_each(|&label| reached[usize::from(label)] += 1);
    for (&group, &label) in groups.iter().zip(carried) {
        common[usize::from(group)][usize::from(label)] += 1;
    }
    let none = usize::from(UNLABELLED);
    let mut links: Vec<(f64, usize, usize)> = Vec::new();
    for group in (0..none).filter(|&group| sizes[group] > 0) {
        for label in (0..none).filter(|&label| common[group][label] > 0) {
            let both = common[group][label];
            links.push((both as f64 / (sizes[group] + reached[label] - both) as f64, group, label));
        }
    }
    links.retain(|(overlap, ..)| *overlap >= LINKED);
    links.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut numbers = [UNLABELLED; 256];
    let mut taken = [false; 256];
    for (_, group, label) in links {
        if numbers[group] == UNLABELLED && !taken[label] {
            (numbers[group], taken[label]) = (label as u8, true);
        }
    }
    for group in (0..none).filter(|&group| sizes[group] > 0) {
        if numbers[group] == UNLABELLED && *next < UNLABELLED {
            numbers[group] = *next;
            *next += 1;
        }
    }
    numbers
}
