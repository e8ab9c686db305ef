//! A region of the foreground, shared among several objects.

use super::sight::shown_motion;
use crate::clip::options::model;
use crate::clip::record::Record;
use crate::frame::Plane;
use crate::labelling::solver::Solver;

/// Shares a region among `numbers`. Pixels stay with the object from which they are carried, and pixels of one motion stay together. Pixels
/// that come into sight from behind an object are often carried from that object; those with the main motion of another object are
/// therefore free to change.
pub(crate) fn share(record: &Record, pixels: &[usize], carried: &[u8], numbers: &[u8], labels: &mut [u8]) {
    let [width, height] = record.size();
    let motions = shown_motion(record).map(|flow| &flow.labels);
    let motion = |p: usize| motions.map_or(0, |labels| usize::from(labels[p]));
    let own = |p: usize| numbers.iter().position(|&number| number == carried[p]);
    let mut votes = vec![vec![0usize; numbers.len()]; 256];
    for &p in pixels {
        if let Some(k) = own(p) {
            votes[motion(p)][k] += 1;
        }
    }
    let main: Vec<usize> =
        (0..numbers.len()).map(|k| (0..votes.len()).rev().max_by_key(|&m| votes[m][k]).unwrap_or(0)).collect();
    let mut costs: Vec<Plane> = numbers.iter().map(|_| Plane::filled(width, height, 0.0)).collect();
    for &p in pixels {
        let votes = &votes[motion(p)];
        let all = votes.iter().sum::<usize>().max(1) as f32;
        let own = own(p).filter(|&k| main[k] == motion(p) || !main.contains(&motion(p)));
        for (k, cost) in costs.iter_mut().enumerate() {
            let other = if own.is_some_and(|own| own != k) { 2.0 * model().leaves_motion } else { 0.0 };
            cost.values_mut()[p] = other + model().leaves_motion * (1.0 - votes[k] as f32 / all);
        }
    }
    let solved = record.edge_weights(model().smoothness).solve(&costs, Solver::FAST);
    pixels.iter().for_each(|&p| labels[p] = numbers[usize::from(solved[p])]);
}
