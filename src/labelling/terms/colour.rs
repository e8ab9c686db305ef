//! Colour model: pixels that motion alone cannot assign take the label of similar colours.
//!
//! A histogram of quantised colours per label, weighted by the margin by which each pixel's own motion is cheaper than the next, gives
//! the probability of a label given a colour. How far it can be trusted is measured by cross-validation: blocks of the frame form
//! two halves, and the histograms of one half predict the labels of the other. If labels share their colours the prediction fails,
//! and colours are ignored.

use crate::frame::Plane;
use crate::frame::palette::{COLOURS, Palette};
use crate::model::Model;

/// Adds the costs of the colours, learned from pixels that are weighted by how clearly their motion wins.
pub(crate) fn add_colours(costs: &mut [Plane], palette: &Palette, labels: &[u8], model: &Model) {
    let n = costs.len();
    let weights = margins(costs, labels);
    let trust = trust(palette, labels, &weights, n, model);
    let mut penalties = posterior(palette, labels, &weights, n, model);
    let largest = model.largest_cost();
    penalties.iter_mut().for_each(|p| *p = (-model.colour_weight * trust * trust * libm::logf(*p)).min(largest));
    for (label, cost) in costs.iter_mut().enumerate() {
        cost.values_mut().iter_mut().enumerate().for_each(|(p, c)| *c += penalties[palette.index(p) * n + label]);
    }
}

/// How well the colours of one half of the blocks predict the labels of the other: information per pixel as a share of the
/// information needed, averaged over the labels; 0…1.
fn trust(palette: &Palette, labels: &[u8], weights: &[f32], n: usize, model: &Model) -> f32 {
    let half = halves(palette.width(), labels.len(), model.colour_block);
    let tables = [0, 1].map(|which| {
        let of_half = |(&weight, &half): (&f32, &u8)| if half == which { weight } else { 0.0 };
        posterior(palette, labels, &weights.iter().zip(&half).map(of_half).collect::<Vec<f32>>(), n, model)
    });
    let mut information = vec![(0.0f32, 0.0f32); n];
    for (p, (&label, &weight)) in labels.iter().zip(weights).enumerate() {
        let believed = tables[usize::from(1 - half[p])][palette.index(p) * n + usize::from(label)];
        let (sum, count) = &mut information[usize::from(label)];
        *sum += weight * libm::logf(believed * n as f32);
        *count += weight;
    }
    let needed = libm::logf(n as f32);
    let shares = information.iter().map(|(sum, count)| (sum / count.max(1e-9) / needed).clamp(0.0, 1.0));
    shares.sum::<f32>() / n as f32
}

/// Which half of the blocks, 0 or 1, every pixel belongs to.
fn halves(width: usize, pixels: usize, block: usize) -> Vec<u8> {
    let mut halves = Vec::with_capacity(pixels);
    for y in 0..pixels / width {
        halves.extend((0..width).map(|x| ((x / block + y / block) % 2) as u8));
    }
    halves
}

/// By how much each pixel's own motion is cheaper than the next one.
fn margins(costs: &[Plane], labels: &[u8]) -> Vec<f32> {
    let next = |p: usize, own: usize| {
        let others = (0..costs.len()).filter(|&l| l != own).map(|l| costs[l].values()[p]);
        others.fold(f32::INFINITY, |least, cost| if cost < least { cost } else { least })
    };
    let gap = |(p, &own): (usize, &u8)| next(p, usize::from(own)) - costs[usize::from(own)].values()[p];
    labels.iter().enumerate().map(gap).map(|gap| if gap > 0.0 { gap } else { 0.0 }).collect()
}

/// Probability of every label for every colour, all labels equally likely beforehand; from pixels with these weights.
#[inline(never)]
fn posterior(palette: &Palette, labels: &[u8], weights: &[f32], n: usize, model: &Model) -> Vec<f32> {
    let smallest = model.fewest_of_colours as f32 * model.largest_cost();
    let mut table = vec![0.0f32; n * COLOURS];
    let mut totals = vec![1e-9f32; n];
    for (p, (&label, &weight)) in labels.iter().zip(weights).enumerate() {
        table[palette.index(p) * n + usize::from(label)] += weight;
        totals[usize::from(label)] += weight;
    }
    let known = totals.iter().filter(|&&total| total >= smallest).count().max(1) as f32;
    for of_colour in table.chunks_exact_mut(n) {
        let mut sum = 0.0;
        for (share, total) in of_colour.iter_mut().zip(&totals).filter(|&(_, &total)| total >= smallest) {
            *share = *share / total + model.colour_prior;
            sum += *share;
        }
        // A label without enough pixels to learn from gets the average probability for every colour.
        let average = if sum > 0.0 { sum / known } else { 1.0 };
        for (share, _) in of_colour.iter_mut().zip(&totals).filter(|&(_, &total)| total < smallest) {
            *share = average;
            sum += average;
        }
        of_colour.iter_mut().for_each(|share| *share /= sum);
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::Frame;
    use crate::frame::scaling::Scaling;

    /// Left and right half of the frame have a motion each; only every third column determines which.
    fn costs(width: usize, height: usize) -> ([Plane; 2], Vec<u8>) {
        let cost = |label: bool| {
            Plane::from_fn(width, height, |x, _| if x % 3 == 0 && (x < width / 2) == label { 2.0 } else { 0.0 })
        };
        let labels = (0..width * height).map(|p| u8::from(p % width >= width / 2)).collect();
        ([cost(false), cost(true)], labels)
    }

    /// The costs that the colours add.
    fn added(palette: &Palette, costs: &[Plane; 2], labels: &[u8]) -> [Plane; 2] {
        let mut with = costs.clone();
        add_colours(&mut with, palette, labels, &Model::DEFAULT);
        for (with, without) in with.iter_mut().zip(costs) {
            with.values_mut().iter_mut().zip(without.values()).for_each(|(w, o)| *w -= o);
        }
        with
    }

    fn frame(colour: impl Fn(usize, usize) -> [u8; 3]) -> Frame {
        let rgba: Vec<u8> = (0..72 * 48)
            .flat_map(|p| colour(p % 72, p / 72))
            .collect::<Vec<_>>()
            .chunks(3)
            .flat_map(|c| [c[0], c[1], c[2], 255])
            .collect();
        Frame::from_rgba(72, 48, &rgba).unwrap()
    }

    #[test]
    fn colours_that_separate_the_labels_are_used_and_others_are_not() {
        let (costs, labels) = costs(72, 48);
        let distinct = frame(|x, _| if x < 36 { [200, 30, 30] } else { [30, 30, 200] });
        let added = added(&Palette::new(&distinct, &Scaling::halved([72, 48], 0)), &costs, &labels);
        assert!(added[1].at(10, 20) > added[0].at(10, 20) + 0.5);
        assert!(added[0].at(60, 20) > added[1].at(60, 20) + 0.5);
        let shared = frame(|x, y| if (x / 2 + y / 2) % 2 == 0 { [200, 30, 30] } else { [30, 30, 200] });
        let added = self::added(&Palette::new(&shared, &Scaling::halved([72, 48], 0)), &costs, &labels);
        assert!((added[0].at(10, 20) - added[1].at(10, 20)).abs() < 0.01);
    }
}
