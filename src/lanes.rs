//! Loops over rows, a handful of values at a time.
//!
//! WebAssembly's instructions work on four values at once, but the compiler makes use of them only where it knows the number of turns
//! (see `.cargo/config.toml`): elsewhere each loop would come with a second one for the rest, and most loops do not matter. Those
//! that do are written in blocks, or with the functions here.

/// Values that are worked on together: one register of WebAssembly. Two would make no loop faster and each twice as long.
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

/// Replaces every value v by f(v, w), w the values at the same place of `others`, as far as all go.
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

/// Lowers values to others wherever those are smaller, as far as both go.
#[inline(never)]
pub(crate) fn lower(values: &mut [f32], others: &[f32]) {
    each_with(values, [others], |v, [o]| if o < v { o } else { v });
}

/// The first values of a part of a row as an array, whose length the compiler knows: in place, or where there are fewer a copy with
/// anything behind.
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
    fn blocks_and_rest_are_worked_on_alike() {
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
