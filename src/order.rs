//! Sorted orders and medians of numbers, in the order of `total_cmp`.
//!
//! Ties are always broken by index. A single instance of the standard library's sorting would add 5 to 6 kilobytes to the WebAssembly module,
//! more than a hundredth of it; the functions here are never inlined.

use std::cmp::Ordering;

/// Indices by increasing key, ties by index. NaN comes last, −NaN first.
pub(crate) fn ascending(keys: impl IntoIterator<Item = f64>) -> Vec<usize> {
    merged(&keys.into_iter().collect::<Vec<f64>>())
}

/// Indices by increasing key, ties by index, by merge sort.
#[inline(never)]
fn merged(keys: &[f64]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..keys.len()).collect();
    let mut merged = order.clone();
    // Sorted runs of length 1, 2, 4, … are merged in pairs; on ties the left one comes first.
    let mut length = 1;
    while length < order.len() {
        for (runs, target) in order.chunks(2 * length).zip(merged.chunks_mut(2 * length)) {
            let (mut left, mut right) = runs.split_at(length.min(runs.len()));
            for slot in target {
                let from = match (left, right) {
                    (&[l, ..], &[r, ..]) if keys[r].total_cmp(&keys[l]).is_lt() => &mut right,
                    (&[_, ..], _) => &mut left,
                    _ => &mut right,
                };
                if let Some((&first, rest)) = from.split_first() {
                    (*slot, *from) = (first, rest);
                }
            }
        }
        std::mem::swap(&mut order, &mut merged);
        length *= 2;
    }
    order
}

/// Indices by decreasing key, ties by index.
pub(crate) fn descending(keys: impl IntoIterator<Item = f64>) -> Vec<usize> {
    ascending(keys.into_iter().map(|key| -key))
}

/// Sorts a short list by insertion, stable. The time is quadratic in its length.
pub(crate) fn sort_few<T: Copy>(values: &mut [T], compare: impl Fn(&T, &T) -> Ordering) {
    for end in 1..values.len() {
        let value = values[end];
        let mut place = end;
        while place > 0 && compare(&value, &values[place - 1]).is_lt() {
            values[place] = values[place - 1];
            place -= 1;
        }
        values[place] = value;
    }
}

/// The upper median, which is an element of the list; `None` if the list is empty.
pub(crate) fn median(values: &[f32]) -> Option<f32> {
    // Widening is exact and keeps the order.
    middle(values.iter().map(|&v| f64::from(v)).collect()).map(|v| v as f32)
}

/// [`median`] in double precision.
pub(crate) fn median_f64(values: &[f64]) -> Option<f64> {
    middle(values.to_vec())
}

#[inline(never)]
fn middle(mut values: Vec<f64>) -> Option<f64> {
    let rank = values.len() / 2;
    (!values.is_empty()).then(|| *values.select_nth_unstable_by(rank, f64::total_cmp).1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ties_keep_their_order() {
        assert_eq!(ascending([2.0, 1.0, 2.0, 0.0])[..], [3, 1, 0, 2]);
        assert_eq!(descending([2.0, 1.0, 2.0, 0.0])[..], [0, 2, 1, 3]);
    }

    #[test]
    fn orders_and_medians_agree_with_sorting() {
        let mut random = crate::random::Random::from_seed(4);
        for count in [0, 1, 2, 3, 7, 64, 100, 1001] {
            // Many ties, both signs of zero, infinities.
            let mut values: Vec<f64> = (0..count).map(|_| (random.uniform(-9.0, 9.0) as i32) as f64 * 0.3).collect();
            if count > 6 {
                (values[1], values[2], values[5]) = (-0.0, f64::INFINITY, f64::NEG_INFINITY);
            }
            let mut expected: Vec<usize> = (0..count).collect();
            expected.sort_by(|&a, &b| values[a].total_cmp(&values[b]));
            assert_eq!(ascending(values.iter().copied())[..], expected);
            let mut few = values.clone();
            sort_few(&mut few, f64::total_cmp);
            let mut sorted = values.clone();
            sorted.sort_by(f64::total_cmp);
            assert_eq!(
                few.iter().map(|v| v.to_bits()).collect::<Vec<_>>(),
                sorted.iter().map(|v| v.to_bits()).collect::<Vec<_>>()
            );
            let bits = sorted.get(count / 2).map(|v| v.to_bits());
            assert_eq!(median_f64(&values).map(f64::to_bits), bits);
            let narrow: Vec<f32> = values.iter().map(|&v| v as f32).collect();
            assert_eq!(median(&narrow), sorted.get(count / 2).map(|&v| v as f32));
        }
    }

    #[test]
    fn the_median_is_a_value_of_the_list() {
        assert_eq!(median(&[5.0, 1.0, 3.0]), Some(3.0));
        assert_eq!(median_f64(&[4.0, 1.0, 3.0, 2.0]), Some(3.0));
        assert_eq!(median(&[]), None);
    }
}
