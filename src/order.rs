//! Orders and medians of numbers, in one place: results must not depend on how equals fall, and every copy of a sorting routine
//! for another type of element costs three kilobytes of the module.

/// Indices by increasing key; equals by index. NaN comes last.
pub(crate) fn ascending(keys: impl IntoIterator<Item = f64>) -> Vec<usize> {
    let mut order: Vec<(f64, usize)> = keys.into_iter().enumerate().map(|(k, key)| (key, k)).collect();
    order.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    order.into_iter().map(|(_, k)| k).collect()
}

/// Indices by decreasing key; equals by index.
pub(crate) fn descending(keys: impl IntoIterator<Item = f64>) -> Vec<usize> {
    ascending(keys.into_iter().map(|key| -key))
}

/// The upper median, which is a value of the list; `None` of nothing. Reorders the list.
pub(crate) fn median(values: &mut [f32]) -> Option<f32> {
    if values.is_empty() {
        return None;
    }
    let middle = values.len() / 2;
    Some(*values.select_nth_unstable_by(middle, f32::total_cmp).1)
}

/// The same in double precision.
pub(crate) fn median_f64(values: &mut [f64]) -> Option<f64> {
    if values.is_empty() {
        return None;
    }
    let middle = values.len() / 2;
    Some(*values.select_nth_unstable_by(middle, f64::total_cmp).1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equals_keep_their_order() {
        assert_eq!(ascending([2.0, 1.0, 2.0, 0.0]), [3, 1, 0, 2]);
        assert_eq!(descending([2.0, 1.0, 2.0, 0.0]), [0, 2, 1, 3]);
    }

    #[test]
    fn the_median_is_a_value_of_the_list() {
        assert_eq!(median(&mut [5.0, 1.0, 3.0]), Some(3.0));
        assert_eq!(median_f64(&mut [4.0, 1.0, 3.0, 2.0]), Some(3.0));
        assert_eq!(median(&mut []), None);
    }
}
