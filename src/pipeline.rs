//! The image pipeline: the stages that turn two frames into masks, in order.

mod correction;
mod evidence;
mod hypothesis;
mod masks;
mod report;
mod settings;

pub use correction::{Correction, MAX_CORRECTED, Relabelling, relabel};
pub use report::{PairEvidence, Segmentation, SegmentedMotion};
#[doc(hidden)]
pub use settings::Part;

use crate::alignment::brightness::Photometric;
use crate::alignment::cost::{View, noise};
use crate::alignment::dominant::dominant_motion;
use crate::alignment::gauss_newton::{Alignment, Support, align};
use crate::error::{Error, Result};
use crate::frame::Frame;
use crate::frame::Plane;
use crate::frame::filter::{gaussian, halve};
use crate::frame::pyramid::{Level, PRE_BLUR, build};
use crate::labelling::appearance::Palette;
use crate::labelling::energy::Picture;
use crate::motion::AffineMotion;
use crate::options::SegmentOptions;
use crate::progress::{Progress, Stages};
use crate::random::Random;
use crate::workspace::{self, Buffer};
use settings::Settings;

/// The stages of [`segment_pair`], in order.
const STAGES: &[&str] =
    &["frames", "dominant", "measurements", "algebra", "selection", "refinement", "labels", "masks"];

/// Segments two frames: how many things move, how each one moves and which pixels belong to it.
///
/// `before` is the frame before the first. It helps to label pixels that are occluded in the second.
///
/// # Errors
/// [`Error::InvalidOption`], [`Error::FrameSizeMismatch`].
pub fn segment_pair(
    first: &Frame,
    second: &Frame,
    before: Option<&Frame>,
    options: &SegmentOptions,
    progress: Progress<'_>,
) -> Result<Segmentation> {
    segment_with(first, second, before, options, Settings::new(options, size(first)), progress)
}

/// [`segment_pair`] without one part of the pipeline, for ablation studies.
///
/// # Errors
/// As [`segment_pair`].
#[cfg(feature = "ablation")]
#[doc(hidden)]
pub fn segment_pair_without(
    part: Part,
    first: &Frame,
    second: &Frame,
    before: Option<&Frame>,
    options: &SegmentOptions,
) -> Result<Segmentation> {
    let mut settings = Settings { without: Some(part), ..Settings::new(options, size(first)) };
    if part == Part::Coherence {
        settings.coherence.smoothness = 0.0;
    }
    segment_with(first, second, before, options, settings, &mut |_| {})
}

fn segment_with(
    first: &Frame,
    second: &Frame,
    before: Option<&Frame>,
    options: &SegmentOptions,
    settings: Settings,
    progress: Progress<'_>,
) -> Result<Segmentation> {
    options.motions.validate()?;
    check_sizes(first, second, before)?;
    let _call = workspace::begin([first.width(), first.height()]);
    let mut stages = Stages::new(STAGES, progress);
    let mut random = Random::from_seed(options.seed);

    stages.begin("frames");
    let mut pyramid = PairPyramid::new(first, second, before, &settings);
    stages.begin("dominant");
    let dominant = pyramid.find_dominant(settings.has(Part::Brightness));
    let found = hypothesis::best(&pyramid, dominant, &settings, &mut random, &mut stages);
    stages.begin("refinement");
    let found = hypothesis::refine(&pyramid, found, &settings);
    stages.begin("labels");
    let labelled = masks::label(&pyramid, found, &settings);
    stages.begin("masks");
    Ok(report::report(&pyramid, labelled, &settings, first, second, options))
}

fn size(frame: &Frame) -> [usize; 2] {
    [frame.width(), frame.height()]
}

fn check_sizes(first: &Frame, second: &Frame, before: Option<&Frame>) -> Result<()> {
    let size = (first.width(), first.height());
    for other in [Some(second), before].into_iter().flatten() {
        if (other.width(), other.height()) != size {
            return Err(Error::FrameSizeMismatch { first: size, second: (other.width(), other.height()) });
        }
    }
    Ok(())
}

/// Red, green and blue of a frame, halved until they are at most `width` wide.
fn colours(frame: &Frame, width: usize) -> [Plane; 3] {
    let mut planes = if frame.width() > width {
        half_colours(frame)
    } else {
        let plane = |c: usize| frame.colours().iter().map(|colour| f32::from(colour[c])).collect();
        std::array::from_fn(|c| Plane::from_buffer(frame.width(), frame.height(), plane(c)))
    };
    while planes[0].width() > width {
        planes = planes.each_ref().map(halve);
    }
    planes
}

/// Red, green and blue of a frame at half its size, smoothed by [1 2 1]/4 in integer arithmetic.
fn half_colours(frame: &Frame) -> [Plane; 3] {
    let (width, height) = (frame.width(), frame.height());
    let row = |y: usize| frame.colours()[y * width..(y + 1) * width].as_flattened();
    let [half_width, half_height] = [width, height].map(|size| size.div_ceil(2));
    let mut planes = [0; 3].map(|_| Plane::unwritten(half_width, half_height));
    // Vertical sums over three rows, padded by a pixel on both sides.
    let mut sums = Buffer::unwritten(4 * (width + 2));
    let sums: &mut [[u16; 4]] = sums.as_chunks_mut().0;
    for y in 0..half_height {
        let (above, here, below) = (row((2 * y).saturating_sub(1)), row(2 * y), row((2 * y + 1).min(height - 1)));
        for (((s, a), h), b) in sums[1..].as_flattened_mut().iter_mut().zip(above).zip(here).zip(below) {
            *s = u16::from(*a) + 2 * u16::from(*h) + u16::from(*b);
        }
        (sums[0], sums[width + 1]) = (sums[1], sums[width]);
        let [red, green, blue] = planes.each_mut().map(|plane| plane.row_mut(y));
        let places = red.iter_mut().zip(green).zip(blue);
        for (((red, green), blue), near) in places.zip(sums.windows(3).step_by(2)) {
            let sum: [f32; 4] = std::array::from_fn(|c| f32::from(near[0][c] + 2 * near[1][c] + near[2][c]) / 16.0);
            [*red, *green, *blue, _] = sum;
        }
    }
    planes
}

/// Image pyramid of the pair, from the working size down.
pub(crate) struct PairPyramid {
    /// Level 0 is the working size.
    levels: Vec<Level>,
    /// Index of the level on which the dominant motion is found and others are proposed.
    base: usize,
    /// Index of the level on which motions are first selected, the base level or a finer one.
    selection: usize,
    /// Index of the level on which the draft labels are solved.
    draft: usize,
    /// The first frame without blur, at the sizes of the levels down to the base or the draft level.
    pictures: Vec<Picture>,
    /// Quantised colour of every working pixel.
    palette: Palette,
    /// Full-size pixels per working pixel.
    reduction: f64,
}

impl PairPyramid {
    fn new(first: &Frame, second: &Frame, before: Option<&Frame>, settings: &Settings) -> PairPyramid {
        let mut reduction = 1.0;
        let mut planes: Vec<Plane> =
            [Some(first), Some(second), before].into_iter().flatten().map(|f| f.luminance().clone()).collect();
        for _ in 0..settings.halvings {
            planes.iter_mut().for_each(|p| *p = halve(p));
            reduction *= 2.0;
        }
        let picture = Picture { luminance: planes[0].clone(), colours: colours(first, planes[0].width()) };
        let palette = Palette::new(first, planes[0].width(), planes[0].height());
        let mut blurred = planes.iter().map(|p| gaussian(p, PRE_BLUR));
        let empty = || Plane::filled(1, 1, 0.0);
        let (one, two) = (blurred.next().unwrap_or_else(empty), blurred.next().unwrap_or_else(empty));
        let levels = build(one, two, blurred.next(), settings.smallest_side);
        let within =
            |side: usize| levels.iter().position(|l| l.width().max(l.height()) <= side).unwrap_or(levels.len() - 1);
        let (base, draft) = (within(settings.base_side), within(settings.draft_side));
        let selection = within(settings.selection_side);
        let mut pictures = vec![picture];
        while pictures.len() <= base.max(draft) {
            let last = &pictures[pictures.len() - 1];
            pictures.push(Picture { luminance: halve(&last.luminance), colours: last.colours.each_ref().map(halve) });
        }
        PairPyramid { levels, base, selection, draft, pictures, palette, reduction }
    }

    /// Finds the dominant motion, measures the noise and, with `brightness`, removes the change of brightness from every view.
    fn find_dominant(&mut self, brightness: bool) -> AffineMotion {
        let (mut motion, photometric) = dominant_motion(&self.levels, self.base, brightness);
        for level in &mut self.levels {
            photometric.remove_from(level, View::Second);
        }
        if motion != AffineMotion::STATIC {
            let base = &mut self.levels[self.base];
            base.noise = noise(base, &motion);
            let how = Alignment::of_region(3, 1e-3);
            motion = align(base, &motion, &Support::everything(base), &mut Default::default(), how);
        }
        for level in &mut self.levels {
            level.noise = noise(level, &motion);
        }
        let base = &self.levels[self.base];
        if brightness && let Some(photometric) = Photometric::of_frame_before(base, &motion) {
            self.levels.iter_mut().for_each(|level| photometric.remove_from(level, View::Before));
        }
        motion
    }

    fn finest(&self) -> &Level {
        &self.levels[0]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_of_half_the_size_are_weighted_means() {
        for (width, height) in [(16usize, 16usize), (17, 19), (21, 16)] {
            let bytes: Vec<u8> = (0..width * height * 4).map(|k| (k * k * 31 % 251) as u8).collect();
            let frame = Frame::from_rgba(width, height, &bytes).unwrap();
            let planes = half_colours(&frame);
            for (c, plane) in planes.iter().enumerate() {
                assert_eq!((plane.width(), plane.height()), (width.div_ceil(2), height.div_ceil(2)));
                for y in 0..plane.height() {
                    for x in 0..plane.width() {
                        let mut sum = 0.0;
                        for (dy, v) in [(-1i32, 1.0), (0, 2.0), (1, 1.0)] {
                            for (dx, u) in [(-1i32, 1.0), (0, 2.0), (1, 1.0)] {
                                let place = |at: usize, by: i32, size: usize| {
                                    (2 * at).saturating_add_signed(by as isize).min(size - 1)
                                };
                                let p = place(y, dy, height) * width + place(x, dx, width);
                                sum += u * v * f32::from(bytes[4 * p + c]);
                            }
                        }
                        assert_eq!(plane.at(x, y), sum / 16.0);
                    }
                }
            }
        }
    }
}
