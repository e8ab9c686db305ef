//! The full size of a frame and the size at which it is processed.

use super::MIN_SIDE;

/// The full size of frames and a smaller one, halved k times and rounded up each time: one small pixel for 2ᵏ × 2ᵏ full-size pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Scaling {
    /// Width and height, full-size pixels.
    pub(crate) full: [usize; 2],
    /// Width and height, small pixels.
    pub(crate) small: [usize; 2],
    /// Full-size pixels for each small one, along a side: 2ᵏ.
    pub(crate) step: usize,
}

impl Scaling {
    /// Frames that are halved so many times.
    pub(crate) fn halved(full: [usize; 2], halvings: usize) -> Scaling {
        let step = 1 << halvings;
        Scaling { full, small: full.map(|side| side.div_ceil(step)), step }
    }

    /// Frames that are halved until their longer side is at most `longest`, or their shorter side would be too short for a frame.
    pub(crate) fn within(full: [usize; 2], longest: usize) -> Scaling {
        let mut scaling = Scaling::halved(full, 0);
        while scaling.small.iter().any(|&side| side > longest) && scaling.small.iter().all(|&side| side >= 2 * MIN_SIDE)
        {
            scaling = Scaling::halved(full, scaling.halvings() + 1);
        }
        scaling
    }

    /// The scaling from one size to another that was halved from it.
    pub(crate) fn between(full: [usize; 2], small: [usize; 2]) -> Scaling {
        let mut scaling = Scaling::halved(full, 0);
        while scaling.small.iter().zip(small).any(|(&side, small)| side > small) {
            scaling = Scaling::halved(full, scaling.halvings() + 1);
        }
        scaling
    }

    /// How often the full size is halved.
    pub(crate) fn halvings(&self) -> usize {
        self.step.ilog2() as usize
    }

    /// The small pixel that a full-size pixel belongs to.
    #[inline(always)]
    pub(crate) fn small_pixel(&self, p: usize) -> usize {
        p / self.full[0] / self.step * self.small[0] + p % self.full[0] / self.step
    }

    /// The full-size pixel at the top-left corner of a small one.
    #[inline(always)]
    pub(crate) fn corner(&self, p: usize) -> usize {
        p / self.small[0] * self.step * self.full[0] + p % self.small[0] * self.step
    }

    /// Small values at the full size: each pixel has that of the small one it belongs to.
    pub(crate) fn enlarged<T: Copy>(&self, small: &[T]) -> Vec<T> {
        (0..self.full[0] * self.full[1]).map(|p| small[self.small_pixel(p)]).collect()
    }

    /// Full-size values at the small size: those at the corners of the pixels.
    pub(crate) fn thinned<T: Copy>(&self, full: &[T]) -> Vec<T> {
        (0..self.small[0] * self.small[1]).map(|p| full[self.corner(p)]).collect()
    }

    /// Sparse full-size values at the small size: the value in the middle of each small pixel or, without one, any that lies in it; else
    /// `nothing`.
    #[inline(never)]
    pub(crate) fn gathered<T: Copy + PartialEq>(&self, full: &[T], nothing: T) -> Vec<T> {
        let (width, step) = (self.full[0], self.step);
        let mut small = vec![nothing; self.small[0] * self.small[1]];
        for (p, &value) in full.iter().enumerate().filter(|(_, value)| **value != nothing) {
            let here = &mut small[self.small_pixel(p)];
            if *here == nothing || (p % width % step, p / width % step) == (step / 2, step / 2) {
                *here = value;
            }
        }
        small
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_pixel_has_a_place_at_the_other_size() {
        for full in [[16, 16], [33, 47], [640, 480], [853, 479], [4096, 64]] {
            for longest in [16, 100, 480] {
                let scaling = Scaling::within(full, longest);
                assert_eq!(scaling, Scaling::between(full, scaling.small));
                let small: Vec<usize> = (0..scaling.small[0] * scaling.small[1]).collect();
                assert_eq!(scaling.thinned(&scaling.enlarged(&small)), small);
                assert_eq!(scaling.gathered(&scaling.enlarged(&small), usize::MAX), small);
            }
        }
        // Narrow frames are not halved to less than a frame may have.
        assert_eq!(Scaling::within([4096, 64], 480).small, [1024, 16]);
    }
}
