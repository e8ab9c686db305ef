//! Colours in which equal steps look equally different: CIE 1976 L*a*b* of sRGB under D65, scaled to bytes.

use super::Plane;

/// L, a and b of red, green and blue planes: L 0…255 for 0…100, a and b shifted by 128.
pub(crate) fn lab(colours: &[Plane; 3]) -> [Plane; 3] {
    let (width, height) = (colours[0].width(), colours[0].height());
    let linear: Vec<f32> = (0..=LEVELS).map(|level| linear(level as f32 / LEVELS as f32)).collect();
    let root: Vec<f32> = (0..=ROOTS).map(|k| root(k as f32 / ROOTS as f32)).collect();
    let mut planes = [(); 3].map(|()| Plane::filled(width, height, 0.0));
    for p in 0..width * height {
        let [r, g, b] = colours.each_ref().map(|plane| between(&linear, plane.values()[p] / 255.0));
        let x = between(&root, 0.433_91 * r + 0.376_22 * g + 0.189_86 * b);
        let y = between(&root, 0.212_67 * r + 0.715_16 * g + 0.072_17 * b);
        let z = between(&root, 0.017_76 * r + 0.109_47 * g + 0.872_77 * b);
        planes[0].values_mut()[p] = 2.55 * (116.0 * y - 16.0);
        planes[1].values_mut()[p] = 500.0 * (x - y) + 128.0;
        planes[2].values_mut()[p] = 200.0 * (y - z) + 128.0;
    }
    planes
}

/// Steps of the table of linear intensities.
const LEVELS: usize = 255;
/// Steps of the table of their roots.
const ROOTS: usize = 1024;

/// The value of a table over 0…1, linear between its entries.
#[inline(always)]
fn between(table: &[f32], at: f32) -> f32 {
    let at = at.clamp(0.0, 1.0) * (table.len() - 1) as f32;
    let k = (at as usize).min(table.len() - 2);
    table[k] + (at - k as f32) * (table[k + 1] - table[k])
}

fn linear(value: f32) -> f32 {
    if value <= 0.040_45 { value / 12.92 } else { libm::expf(2.4 * libm::logf((value + 0.055) / 1.055)) }
}

fn root(value: f32) -> f32 {
    if value > 0.008_856 { libm::expf(libm::logf(value) / 3.0) } else { 7.787 * value + 16.0 / 116.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_colours() {
        let of = |rgb: [f32; 3]| lab(&rgb.map(|value| Plane::filled(1, 1, value))).map(|plane| plane.at(0, 0));
        let known = [
            ([255.0, 255.0, 255.0], [255.0, 128.0, 128.0]),
            ([0.0, 0.0, 0.0], [0.0, 128.0, 128.0]),
            ([255.0, 0.0, 0.0], [135.8, 208.1, 195.2]),
            ([0.0, 0.0, 255.0], [82.4, 207.2, 20.1]),
            ([30.0, 200.0, 90.0], [181.3, 64.3, 171.3]),
        ];
        for (rgb, expected) in known {
            let near = of(rgb).iter().zip(expected).all(|(value, expected)| (value - expected).abs() < 1.0);
            assert!(near, "{rgb:?}: {:?}, not {expected:?}", of(rgb));
        }
    }
}
