//! Masks of objects and how well they agree with the truth.

/// Where a label is in a frame.
pub fn of_label(labels: &[u8], label: u8) -> Vec<bool> {
    labels.iter().map(|&own| own == label).collect()
}

/// Where a label is in every frame.
pub fn masks(labels: &[Vec<u8>], label: u8) -> Vec<Vec<bool>> {
    labels.iter().map(|labels| of_label(labels, label)).collect()
}

/// IoU of two masks, 1 where both are empty.
pub fn iou(a: &[bool], b: &[bool]) -> f64 {
    let both = |(&a, &b): (&bool, &bool)| [usize::from(a && b), usize::from(a || b)];
    let [inside, union] = a.iter().zip(b).map(both).fold([0; 2], |[i, u], [inside, union]| [i + inside, u + union]);
    if union == 0 { 1.0 } else { inside as f64 / union as f64 }
}

/// IoU in each frame.
pub fn each(found: &[Vec<bool>], truths: &[Vec<bool>]) -> Vec<f64> {
    found.iter().zip(truths).map(|(found, truth)| iou(found, truth)).collect()
}

/// Their mean between the first frame and the last.
pub fn between(found: &[Vec<bool>], truths: &[Vec<bool>]) -> f64 {
    let each = each(found, truths);
    mean(&each[1..each.len() - 1])
}

/// The first of the frames with the least IoU.
pub fn worst(each: &[f64]) -> usize {
    (0..each.len()).reduce(|a, b| if each[b] < each[a] { b } else { a }).unwrap_or(0)
}

/// NaN of nothing.
pub fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}
