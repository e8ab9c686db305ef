//! Figures 2 and 3: the paper's pipeline and ours on a real pair and on a generated scene like that of the paper.
//!
//! A picture is a grid of panels: the first frame, the paper's pipeline, ours, and the ground truth, if known. Moving objects have a colour,
//! all other pixels are dark.
use std::fs;

use experiments::Failure;
use experiments::panels::Sheet;
use scenes::leader_follower;
use serde::Serialize;
use veronese::codecs::decode_image;
use veronese::{Frame, KeptPixels, MotionCount, SegmentOptions, UNLABELLED, literal_pair, segment_pair};

/// Share of the pixels that the paper keeps: 1995 of 150 × 200.
const KEPT: KeptPixels = KeptPixels::Strongest(0.0665);
/// Number of motions for the paper's pipeline. Both scenes show two moving objects on a static background, whose pixels the paper does not
/// keep. The pictures use given numbers of motions; the estimated numbers are printed.
const MOVING: MotionCount = MotionCount::Given(2);
/// Number of motions for our pipeline.
const WITH_BACKGROUND: MotionCount = MotionCount::Given(3);

/// Width of the white lines between panels, pixels.
const GAP: usize = 4;

/// The labels of a panel; `None` shows the frame.
type Panel = Option<Vec<u8>>;

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
pub(crate) fn pictures(seed: u64) -> Result<([File; 2], [OfPair; 2]), Failure> {
    let (first, second) = (bundled("first")?, bundled("second")?);
    let (cars, of_cars) = panels("two cars", &first, &second, None, None)?;
    let cars = picture(&first, &cars, 3, 2)?;

    let scene = leader_follower(seed)?;
    let (first, second, before) = (scene.first(), scene.second(), scene.before());
    let (robots, of_robots) = panels("leader and follower", first, second, Some(before), Some(&scene.labels))?;
    let robots = picture(first, &robots, 2, 1)?;
    Ok(([("paper-two-cars.png", cars), ("leader-follower.png", robots)], [of_cars, of_robots]))
}

/// A frame of the bundled pair.
fn bundled(name: &str) -> Result<Frame, Failure> {
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
) -> Result<(Vec<Panel>, OfPair), Failure> {
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
    // The paper's pipeline labels moving objects alone, from 0; ours and the truth have the background as 0.
    let of_paper = paper.labels.iter().map(|&label| if label == UNLABELLED { UNLABELLED } else { label + 1 }).collect();
    let moving = |labels: &[u8]| labels.iter().map(|&label| if label == 0 { UNLABELLED } else { label }).collect();
    let mut panels = vec![None, Some(of_paper), Some(moving(&ours.labels))];
    panels.extend(truth.map(|truth| Some(moving(truth))));
    Ok((panels, figures))
}

/// The panels on a grid, reduced by `step`, as an indexed PNG.
fn picture(frame: &Frame, panels: &[Panel], columns: usize, step: usize) -> Result<Vec<u8>, Failure> {
    let [width, height] = [frame.width(), frame.height()].map(|side| side / step + GAP);
    let mut sheet = Sheet::new(columns * width - GAP, panels.len().div_ceil(columns) * height - GAP);
    for (k, labels) in panels.iter().enumerate() {
        sheet.place([k % columns * width, k / columns * height], frame.luminance(), labels.as_deref(), step);
    }
    Ok(sheet.png()?)
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
