//! Figures 2 and 3: the paper's pipeline and ours on a real pair and on a generated scene like that of the paper.
//!
//! A picture is a grid of panels: the first frame, the paper's pipeline, ours, and the ground truth, if known. Pixels without a label are
//! dark grey, others have the colour of their label.

use std::error::Error;
use std::fs;

use scenes::leader_follower;
use serde::Serialize;
use veronese::codecs::{decode_image, encode_indexed_png};
use veronese::{Frame, KeptPixels, MotionCount, SegmentOptions, Segmentation, UNLABELLED, literal_pair, segment_pair};

/// Share of the pixels that the paper keeps: 1995 of 150 × 200.
const KEPT: KeptPixels = KeptPixels::Strongest(0.0665);
/// Number of motions for the paper's pipeline. Both scenes show two moving objects on a static background, whose pixels the paper does not
/// keep. The pictures use given numbers of motions; the estimated numbers are printed.
const MOVING: MotionCount = MotionCount::Given(2);
/// Number of motions for our pipeline.
const WITH_BACKGROUND: MotionCount = MotionCount::Given(3);

/// Colours of the moving objects: orange, blue.
const COLOURS: [[u8; 3]; 2] = [[255, 140, 0], [60, 150, 255]];
/// Grey levels per group of the palette: plain grey, dark grey, and each colour.
const STEPS: usize = 51;
/// Width of the white lines between panels, pixels.
const GAP: usize = 4;

/// How a panel shows a pixel.
#[derive(Clone, Copy, PartialEq)]
enum Look {
    Plain,
    Dark,
    Coloured(usize),
}

struct Panel(Vec<Look>);

/// Name and content of a file.
type File = (&'static str, Vec<u8>);

/// Both pipelines on a pair, in figures.
#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct OfPair {
    pair: &'static str,
    /// Pixels that the paper's pipeline keeps: the strongest, and those above the paper's threshold, if that works.
    kept: usize,
    above_threshold: Option<usize>,
    /// The number of motions by the paper's rule, and by ours, which counts the background.
    by_rule: usize,
    by_ours: usize,
    score: Option<Score>,
}

/// Agreement with the truth.
#[derive(Serialize)]
struct Score {
    /// Pixels that the paper's pipeline keeps on moving objects and beside them, and the share of the former with the right label.
    on: usize,
    beside: usize,
    right: f64,
    /// Intersection over union of our masks with these objects.
    ours: [f64; 2],
}

/// The pictures as PNG files, and their figures.
pub(crate) fn pictures(seed: u64) -> Result<([File; 2], [OfPair; 2]), Box<dyn Error>> {
    let (first, second) = (bundled("first")?, bundled("second")?);
    let (cars, of_cars) = panels("two cars", &first, &second, None, None)?;
    let cars = picture(&first, &cars, Layout { columns: 3, enlargement: 1, reduction: 2 })?;

    let scene = leader_follower(seed)?;
    let (first, second, before) = (scene.first(), scene.second(), scene.before());
    let (robots, of_robots) = panels("leader and follower", first, second, Some(before), Some(&scene.labels))?;
    let robots = picture(first, &robots, Layout { columns: 2, enlargement: 2, reduction: 1 })?;
    Ok(([("paper-two-cars.png", cars), ("leader-follower.png", robots)], [of_cars, of_robots]))
}

/// A frame of the bundled pair.
fn bundled(name: &str) -> Result<Frame, Box<dyn Error>> {
    let path = format!("{}/../www/public/samples/intel-two-cars/{name}.png", env!("CARGO_MANIFEST_DIR"));
    let bytes = fs::read(&path).map_err(|error| format!("{path} cannot be read: {error}"))?;
    Ok(decode_image(&bytes)?.frame()?)
}

/// The panels of a pair. Only the paper's pipeline takes the frame `before`. `truth` has label 0 for the background.
fn panels(
    pair: &'static str,
    first: &Frame,
    second: &Frame,
    before: Option<&Frame>,
    truth: Option<&[u8]>,
) -> Result<(Vec<Panel>, OfPair), Box<dyn Error>> {
    let paper = literal_pair(first, second, before, KEPT, MOVING)?;
    let rule = literal_pair(first, second, before, KEPT, MotionCount::Auto)?;
    let automatic = segment_pair(first, second, &SegmentOptions::default(), &mut |_| {})?;
    let options = SegmentOptions::default().with_motions(WITH_BACKGROUND);
    let ours = segment_pair(first, second, &options, &mut |_| {})?;
    let threshold = literal_pair(first, second, before, KeptPixels::default(), MOVING);
    let figures = OfPair {
        pair,
        kept: paper.kept,
        above_threshold: threshold.ok().map(|found| found.kept),
        by_rule: rule.fit.count,
        by_ours: automatic.count,
        score: truth.map(|truth| score(truth, &paper.labels, &ours.labels)),
    };
    let plain = Panel(vec![Look::Plain; paper.labels.len()]);
    let labels = Panel(paper.labels.iter().map(|&label| look((label != UNLABELLED).then_some(label))).collect());
    let mut panels = vec![plain, labels, moving(&ours)];
    if let Some(truth) = truth {
        panels.push(Panel(truth.iter().map(|label| look(label.checked_sub(1))).collect()));
    }
    Ok((panels, figures))
}

fn look(label: Option<u8>) -> Look {
    label.map_or(Look::Dark, |label| Look::Coloured(usize::from(label).min(COLOURS.len() - 1)))
}

/// A panel in which every motion but the largest has a colour.
fn moving(found: &Segmentation) -> Panel {
    Panel(found.labels.iter().map(|label| look(label.checked_sub(1).filter(|_| *label != UNLABELLED))).collect())
}

/// Agreement with the ground truth: the share of right labels among the pixels that the paper's pipeline keeps on moving objects, and the
/// overlap of our masks with these objects. The objects may be numbered either way.
fn score(truth: &[u8], paper: &[u8], ours: &[u8]) -> Score {
    let of = |labels: &[u8], label: u8, thing: u8| {
        labels.iter().zip(truth).filter(|&(&l, &t)| l == label && t == thing).count() as f64
    };
    let kept = |moving: bool| {
        paper.iter().zip(truth).filter(|&(&label, &thing)| label != UNLABELLED && (thing != 0) == moving).count()
    };
    let (on, beside) = (kept(true), kept(false));
    let right = f64::max(of(paper, 0, 1) + of(paper, 1, 2), of(paper, 0, 2) + of(paper, 1, 1));
    let overlap = |thing: u8| {
        let size = truth.iter().filter(|&&t| t == thing).count() as f64;
        let of_label = |label: u8| {
            let both = of(ours, label, thing);
            both / (size + ours.iter().filter(|&&l| l == label).count() as f64 - both)
        };
        (1..=ours.iter().copied().max().unwrap_or(0)).map(of_label).fold(0.0, f64::max)
    };
    Score { on, beside, right: right / on as f64, ours: [overlap(1), overlap(2)] }
}

/// The layout of a picture.
struct Layout {
    columns: usize,
    /// Factor by which frames are enlarged.
    enlargement: usize,
    /// Factor by which frames are reduced, averaging their luminance.
    reduction: usize,
}

/// The panels on a grid, as an indexed PNG.
fn picture(frame: &Frame, panels: &[Panel], layout: Layout) -> Result<Vec<u8>, Box<dyn Error>> {
    let Layout { columns, enlargement, reduction } = layout;
    let [width, height] = [frame.width(), frame.height()].map(|side| side * enlargement / reduction);
    let rows = panels.len().div_ceil(columns);
    let (full_width, full_height) = (columns * (width + GAP) - GAP, rows * (height + GAP) - GAP);
    let mut indices = vec![WHITE; full_width * full_height];
    for (k, panel) in panels.iter().enumerate() {
        let (left, top) = (k % columns * (width + GAP), k / columns * (height + GAP));
        for y in 0..height {
            for x in 0..width {
                let [from_x, from_y] = [x, y].map(|place| place * reduction / enlargement);
                let square = (0..reduction * reduction).map(|i| [from_x + i % reduction, from_y + i / reduction]);
                let sum: f32 = square.map(|[x, y]| frame.luminance().at(x, y)).sum();
                let luminance = sum / (reduction * reduction) as f32;
                let look = panel.0[from_y * frame.width() + from_x];
                indices[(top + y) * full_width + left + x] = index(look, luminance);
            }
        }
    }
    Ok(encode_indexed_png(full_width, full_height, &indices, &palette())?)
}

/// The brightest plain grey.
const WHITE: u8 = STEPS as u8 - 1;

fn index(look: Look, luminance: f32) -> u8 {
    let step = (luminance / 255.0 * (STEPS - 1) as f32).round() as usize;
    let group = match look {
        Look::Plain => 0,
        Look::Dark => 1,
        Look::Coloured(label) => 2 + label,
    };
    (group * STEPS + step.min(STEPS - 1)) as u8
}

fn palette() -> Vec<u8> {
    let mut palette = Vec::with_capacity(3 * 5 * STEPS);
    for group in 0..2 + COLOURS.len() {
        for step in 0..STEPS {
            let grey = step as f64 * 255.0 / (STEPS - 1) as f64;
            let colour = match group.checked_sub(2) {
                None if group == 0 => [grey; 3],
                None => [0.45 * grey; 3],
                Some(label) => COLOURS[label].map(|c| 0.7 * f64::from(c) + 0.3 * grey),
            };
            palette.extend(colour.map(|value| value.round() as u8));
        }
    }
    palette
}
