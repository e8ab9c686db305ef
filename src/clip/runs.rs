//! Run-length code of small numbers: it stores the labels or the coarse log-odds of a frame in a few kilobytes.

use super::saved::saved;
use crate::frame::MAX_SIDE;

/// Values of the pixels of a frame as runs: a value, then its number of repetitions less one in base 128, low digits first, the highest
/// bit set on all but the last.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Runs(Vec<u8>);

saved!(Runs { 0 });

impl Runs {
    /// Of no pixel.
    pub(crate) const EMPTY: Runs = Runs(Vec::new());

    #[inline(never)]
    pub(crate) fn of(values: &[u8]) -> Runs {
        let mut code = Vec::new();
        for run in values.chunk_by(|one, other| one == other) {
            code.push(run[0]);
            let mut rest = run.len() - 1;
            while rest > 0x7f {
                code.push(rest as u8 | 0x80);
                rest >>= 7;
            }
            code.push(rest as u8);
        }
        code.shrink_to_fit();
        Runs(code)
    }

    /// The values. Runs from outside the program must be [`valid`](Self::is_valid).
    #[inline(never)]
    pub(crate) fn values(&self) -> Vec<u8> {
        let mut values: Vec<u8> = Vec::new();
        for (value, length) in self.each() {
            values.extend((0..length).map(|_| value));
        }
        values
    }

    /// The values of runs from outside the program; `None` if they are not valid or have more values than the largest frame has pixels.
    pub(crate) fn bounded_values(&self) -> Option<Vec<u8>> {
        let pixels = self.each().try_fold(0usize, |sum, (_, length)| sum.checked_add(length))?;
        (pixels <= MAX_SIDE * MAX_SIDE).then(|| self.values())
    }

    /// The runs with other values.
    pub(crate) fn map(&self, value: impl Fn(u8) -> u8) -> Runs {
        Runs::of(&self.values().iter().map(|&v| value(v)).collect::<Vec<u8>>())
    }

    /// Length of the code, bytes.
    pub(crate) fn bytes(&self) -> usize {
        self.0.len()
    }

    /// Whether these are runs of `pixels` values.
    #[inline(never)]
    pub(crate) fn is_valid(&self, pixels: usize) -> bool {
        self.each().try_fold(0usize, |sum, (_, length)| sum.checked_add(length)) == Some(pixels)
    }

    /// Whether any pixel has a value.
    pub(crate) fn names(&self, value: u8) -> bool {
        self.any(&|own| own == value)
    }

    /// Whether any pixel has such a value. Not generic, so that it is compiled only once.
    #[inline(never)]
    pub(crate) fn any(&self, is_it: &dyn Fn(u8) -> bool) -> bool {
        self.each().any(|(value, _)| is_it(value))
    }

    /// Marks the values that there are.
    #[inline(never)]
    pub(crate) fn mark(&self, is_there: &mut [bool; 256]) {
        self.each().for_each(|(value, _)| is_there[usize::from(value)] = true);
    }

    /// Every value with the length of its run.
    fn each(&self) -> impl Iterator<Item = (u8, usize)> + '_ {
        let mut bytes = self.0.iter();
        std::iter::from_fn(move || {
            let value = *bytes.next()?;
            let (mut length, mut shift) = (0usize, 0);
            for byte in bytes.by_ref() {
                length |= usize::from(byte & 0x7f).checked_shl(shift).unwrap_or(0);
                shift += 7;
                if byte & 0x80 == 0 {
                    return Some((value, length.saturating_add(1)));
                }
            }
            // The length is cut off.
            Some((value, usize::MAX))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_give_their_values_back() {
        let long: Vec<u8> = [vec![3; 70_000], vec![0; 1], vec![255; 128], vec![7; 129]].concat();
        for values in [vec![], vec![5], vec![1, 2, 2], long] {
            let runs = Runs::of(&values);
            assert_eq!(runs.values()[..], values[..]);
            assert!(runs.is_valid(values.len()) && !runs.is_valid(values.len() + 1));
        }
    }

    #[test]
    fn damaged_runs_are_found() {
        assert!(!Runs(vec![4, 0x80]).is_valid(1), "the length has no end");
        assert!(!Runs(vec![4; 1]).is_valid(2));
        assert!(!Runs([vec![4], vec![0xff; 20], vec![1]].concat()).is_valid(1));
    }
}
