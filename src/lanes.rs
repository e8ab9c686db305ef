//! Loops over slices in blocks of a fixed size, which the compiler vectorises.
//!
//! The build for WebAssembly vectorises only loops of known length (see `.cargo/config.toml`). A vectorised loop of unknown length needs
//! a second loop for the remainder, and most loops are not worth that code size. Loops that are use blocks, or the functions here.

/// Values in a block: one 128-bit register of `f32`. Blocks of two registers are no faster and double the code.
pub(crate) const LANES: usize = 4;

/// Replaces every value v by f(v).
#[inline(always)]
pub(crate) fn each<T: Copy>(values: &mut [T], f: impl Fn(T) -> T) {
    let (blocks, rest) = values.as_chunks_mut::<LANES>();
    for block in blocks {
        *block = block.map(&f);
    }
    for value in rest {
        *value = f(*value);
    }
}

/// Replaces every value v by f(v, w), with w the values at the same index of `others`, up to the shortest length.
#[inline(always)]
pub(crate) fn each_with<T: Copy, const N: usize>(values: &mut [T], others: [&[T]; N], f: impl Fn(T, [T; N]) -> T) {
    let count = others.iter().fold(values.len(), |least, other| least.min(other.len()));
    let (blocks, rest) = values[..count].as_chunks_mut::<LANES>();
    let others = others.map(|other| other[..count].as_chunks::<LANES>());
    for (k, block) in blocks.iter_mut().enumerate() {
        let others = others.map(|(blocks, _)| blocks[k]);
        *block = std::array::from_fn(|l| f(block[l], others.map(|other| other[l])));
    }
    for (k, value) in rest.iter_mut().enumerate() {
        *value = f(*value, others.map(|(_, rest)| rest[k]));
    }
}

/// Replaces every value by the minimum of itself and the other value, up to the shorter length.
#[inline(never)]
pub(crate) fn lower(values: &mut [f32], others: &[f32]) {
    each_with(values, [others], |v, [o]| if o < v { o } else { v });
}

/// Sum of a row in eight lanes, an order that vectorises and is the same on every platform.
pub(crate) fn lane_sum(row: &[f32]) -> f32 {
    let mut lanes = [0.0f32; 8];
    let chunks = row.chunks_exact(8);
    let rest: f32 = chunks.remainder().iter().sum();
    for chunk in chunks {
        for (lane, value) in lanes.iter_mut().zip(chunk) {
            *lane += value;
        }
    }
    lanes.iter().sum::<f32>() + rest
}

/// The first N values of a slice as an array of known length: in place, or, if the slice is shorter, a copy in `space` followed by
/// arbitrary values.
pub(crate) fn whole<'a, const N: usize>(part: &'a [f32], space: &'a mut [f32; N]) -> &'a [f32; N] {
    if let Some(array) = part.first_chunk() {
        return array;
    }
    space[..part.len()].copy_from_slice(part);
    space
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_and_remainder_are_treated_alike() {
        for count in [0, 1, 7, 8, 9, 40, 43] {
            let start: Vec<f32> = (0..count).map(|k| k as f32 * 0.3).collect();
            let mut values = start.clone();
            each(&mut values, |v| v * v - 1.0);
            assert!(values.iter().zip(&start).all(|(v, s)| *v == s * s - 1.0));
            let others: Vec<f32> = (0..count + 3).map(|k| 50.0 - k as f32).collect();
            each_with(&mut values, [&others, &start], |v, [w, s]| v + 2.0 * w - s);
            assert!(values.iter().zip(&start).zip(&others).all(|((v, s), w)| *v == s * s - 1.0 + 2.0 * w - s));
        }
        let mut space = [9.0; 3];
        assert_eq!(whole(&[1.0, 2.0, 3.0, 4.0], &mut space), &[1.0, 2.0, 3.0]);
        assert_eq!(whole(&[1.0], &mut space), &[1.0, 9.0, 9.0]);
        let mut longer = [1.0; 10];
        each_with(&mut longer, [&[2.0; 9]], |v, [w]| v + w);
        assert_eq!(longer[8..], [3.0, 1.0]);
    }
}
