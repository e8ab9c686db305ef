//! The dominant motion of a pair, along which the noise is measured, and the change of brightness, which is removed.

use super::frames::Pair;
use super::settings::Settings;
use crate::estimation::alignment::{Alignment, Support, align};
use crate::estimation::dominant::{DominantSearch, dominant_motion};
use crate::motion::AffineMotion;
use crate::view::brightness::GainBias;
use crate::view::cost::noise;
use crate::view::level::PairLevel;

/// Where the dominant motion comes from.
pub(crate) enum Dominant<'a> {
    /// It is searched for, near an expected motion if there is one.
    Sought(Option<&'a AffineMotion>),
    /// It is given.
    Known(&'a AffineMotion),
    /// The background is at rest behind these objects.
    Rest(&'a Objects<'a>),
}

/// Objects before a background that may be at rest: their motions, and labels of the working size in rows of `width` pixels.
pub(crate) struct Objects<'a> {
    pub(super) motions: &'a [AffineMotion],
    pub(super) labels: &'a [u8],
    pub(super) width: usize,
}

impl Objects<'_> {
    /// The change of brightness, measured along the motions of all labels. Along a single motion, the objects' would pass for that of
    /// ground without texture.
    fn brightness_at_rest(&self, level: &PairLevel) -> GainBias {
        let motions: Vec<AffineMotion> = [AffineMotion::STATIC].iter().chain(self.motions).copied().collect();
        let step = level.stride << level.index;
        GainBias::along_labels(level, &motions, |x, y| usize::from(self.labels[y * step * self.width + x * step]))
    }
}

impl Pair {
    /// Determines the dominant motion, removes the change of brightness along it, if that is estimated, and measures the noise.
    pub(crate) fn settle_dominant(&mut self, dominant: Dominant<'_>, settings: &Settings) -> AffineMotion {
        let motion = match dominant {
            Dominant::Sought(expected) => self.find_dominant(expected, settings),
            Dominant::Known(motion) => {
                if settings.brightness() {
                    self.remove(GainBias::along(&self.levels[self.base], motion));
                }
                *motion
            }
            Dominant::Rest(objects) => {
                for _ in 0..rest_rounds(settings) {
                    self.remove(objects.brightness_at_rest(&self.levels[self.base]));
                    let level = &mut self.levels[self.base];
                    level.noise = noise(level, &AffineMotion::STATIC);
                }
                AffineMotion::STATIC
            }
        };
        self.levels.iter_mut().for_each(|level| level.noise = noise(level, &motion));
        motion
    }

    fn find_dominant(&mut self, expected: Option<&AffineMotion>, settings: &Settings) -> AffineMotion {
        let search = DominantSearch { brightness: settings.brightness(), convergence: settings.dominant };
        let (motion, photometric) = dominant_motion(&self.levels, self.base, expected, search);
        self.remove(photometric);
        if motion == AffineMotion::STATIC {
            return motion;
        }
        let base = &mut self.levels[self.base];
        let model = base.model;
        base.noise = noise(base, &motion);
        let how = Alignment::of_region(model.region_iterations, model.ridge_background, model).until(settings.dominant);
        align(base, &motion, &Support::everything(base), &mut GainBias::default(), how)
    }

    /// A sample of the base level, much as [`Dominant::Rest`] would leave it, in a fraction of the time.
    pub(super) fn sample_of_rest(&self, objects: &Objects<'_>, settings: &Settings) -> PairLevel {
        let mut level = self.levels[self.base].clone();
        for _ in 0..rest_rounds(settings) {
            objects.brightness_at_rest(&level.thinned()).remove_from(&mut level);
            level.noise = noise(&level, &AffineMotion::STATIC);
        }
        level.noise = noise(&level, &AffineMotion::STATIC);
        level.thinned()
    }

    fn remove(&mut self, photometric: GainBias) {
        self.levels.iter_mut().for_each(|level| photometric.remove_from(level));
    }
}

/// How often the estimates of the change of brightness and of the noise alternate when the background is at rest.
fn rest_rounds(settings: &Settings) -> usize {
    if settings.brightness() { settings.model.rest_rounds } else { 0 }
}
