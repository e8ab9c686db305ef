//! A robot that corrects as a person does: it looks at a frame and draws one stroke in the largest missed region of an object and one in
//! the largest region that is wrongly the object's.

/// Least share of the frame of a region that gets a stroke.
const SMALLEST: f64 = 0.0005;
/// A label image says nothing of a pixel with this label.
pub const NOTHING_SAID: u8 = 255;

/// What the robot compares in a frame, for every pixel.
pub struct View<'a> {
    pub width: usize,
    /// Whether it is the object's: in truth, and as found.
    pub truth: &'a [bool],
    pub found: &'a [bool],
}

impl View<'_> {
    /// Adds the strokes to what was said of the frame before: `label` where the object was missed, 0 where it is not. Only pixels that
    /// are `free` are judged and drawn on.
    pub fn draw(&self, label: u8, free: impl Fn(usize) -> bool, said: &mut [u8]) {
        for (object, value) in [(true, label), (false, 0)] {
            let wrong = |p: usize| self.truth[p] == object && self.found[p] != object && free(p);
            let region: Vec<bool> = (0..said.len()).map(wrong).collect();
            stroke(&region, self.width).into_iter().for_each(|p| said[p] = value);
        }
    }
}

/// Pixels of the largest connected part of a region that are at least half as deep inside it as its deepest; none if it is tiny.
pub fn stroke(region: &[bool], width: usize) -> Vec<usize> {
    let part = largest(region, width);
    if (part.iter().filter(|&&inside| inside).count() as f64) < SMALLEST * region.len() as f64 {
        return Vec::new();
    }
    let depths = depths(&part, width);
    let deepest = depths.iter().copied().max().unwrap_or(0);
    (0..part.len()).filter(|&p| part[p] && 4 * depths[p] >= deepest).collect()
}

/// The largest part of a region whose pixels share sides, the first of equals in raster order.
pub fn largest(region: &[bool], width: usize) -> Vec<bool> {
    let mut left = region.to_vec();
    let mut best = Vec::new();
    for start in 0..region.len() {
        if !left[start] {
            continue;
        }
        left[start] = false;
        let mut part = vec![start];
        let mut next = 0;
        while let Some(&p) = part.get(next) {
            next += 1;
            let x = p % width;
            let sides = [
                (x > 0, p.wrapping_sub(1)),
                (x + 1 < width, p + 1),
                (p >= width, p.wrapping_sub(width)),
                (true, p + width),
            ];
            for (_, q) in sides.into_iter().filter(|&(inside, q)| inside && q < region.len()) {
                if std::mem::take(&mut left[q]) {
                    part.push(q);
                }
            }
        }
        if part.len() > best.len() {
            best = part;
        }
    }
    let mut mask = vec![false; region.len()];
    best.into_iter().for_each(|p| mask[p] = true);
    mask
}

/// Squared distance of every pixel from the nearest one outside the region, 0 there; beyond the border of the frame is outside.
pub fn depths(region: &[bool], width: usize) -> Vec<usize> {
    let height = region.len() / width;
    // Along columns, then the nearest of each row.
    let mut along = vec![0usize; region.len()];
    for p in (0..region.len()).filter(|&p| region[p]) {
        along[p] = 1 + if p >= width { along[p - width] } else { 0 };
    }
    for p in (0..region.len()).rev().filter(|&p| region[p]) {
        let below = if p + width < region.len() { along[p + width] } else { 0 };
        along[p] = along[p].min(1 + below);
    }
    let mut squares = vec![0; region.len()];
    for (y, x) in (0..height).flat_map(|y| (0..width).map(move |x| (y, x))) {
        let row = &along[y * width..(y + 1) * width];
        let mut least = row[x] * row[x];
        let mut aside = 1;
        while aside * aside < least {
            let left = if x >= aside { row[x - aside] } else { 0 };
            let nearest = left.min(row.get(x + aside).copied().unwrap_or(0));
            least = least.min(aside * aside + nearest * nearest);
            aside += 1;
        }
        squares[y * width + x] = least;
    }
    squares
}
