//! The exponential function of the innermost loop: the same bits on every platform, and simple enough to be vectorised.
//!
//! The base is 2, so argument reduction is exact: `2ᵗ = 2ᵏ·2ᶠ` with `k = round(t)` and `f = t − k`. `2ᶠ` is the minimax polynomial of
//! degree 9 with constant term 1 for `|f| ≤ ½`, with a relative error of 1.6·10⁻¹⁴. Only `+ − ×` and bit operations are used, whose
//! results IEEE 754 determines to the last bit.

/// Arguments below this give `2^LOWEST`, about 10⁻³⁰⁴, which is negligible but still a normal number.
pub(crate) const LOWEST: f64 = -1010.0;

/// Adding this to a number of absolute value below 2⁵¹ rounds it to an integer, stored in the low bits of the sum.
const ROUNDER: f64 = 6_755_399_441_055_744.0; // 1.5·2⁵²

/// Coefficients of f⁹, f⁸, …, f.
const POLYNOMIAL: [f64; 9] = [
    1.014_833_444_978_223e-7,
    1.325_833_598_776_052_6e-6,
    1.525_299_005_273_448_6e-5,
    1.540_344_088_146_581_2e-4,
    1.333_355_762_539_437_2e-3,
    9.618_129_181_168_694e-3,
    5.550_410_866_841_633e-2,
    2.402_265_069_572_279_7e-1,
    6.931_471_805_598_851e-1,
];

/// `2ᵗ` for `t ≤ 0`, relative error below 10⁻¹³; arguments below [`LOWEST`] are raised to it.
#[inline(always)]
pub(crate) fn power_of_two(t: f64) -> f64 {
    let t = if t < LOWEST { LOWEST } else { t };
    let shifted = t + ROUNDER;
    let f = t - (shifted - ROUNDER);
    let mut p = POLYNOMIAL[0];
    p = p * f + POLYNOMIAL[1];
    p = p * f + POLYNOMIAL[2];
    p = p * f + POLYNOMIAL[3];
    p = p * f + POLYNOMIAL[4];
    p = p * f + POLYNOMIAL[5];
    p = p * f + POLYNOMIAL[6];
    p = p * f + POLYNOMIAL[7];
    p = p * f + POLYNOMIAL[8];
    p = p * f + 1.0;
    // The low bits of `shifted` are k in two's complement. Added to the exponent, they multiply by 2ᵏ.
    f64::from_bits(p.to_bits().wrapping_add(shifted.to_bits() << 52))
}

#[cfg(test)]
mod tests {
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    use super::*;

    #[test]
    fn agrees_with_the_library_to_thirteen_digits() {
        let mut worst = 0.0_f64;
        for i in 0..=200_000 {
            let t = LOWEST * (f64::from(i) / 200_000.0) * (f64::from(i % 1000) / 999.0);
            worst = worst.max((power_of_two(t) / libm::exp2(t) - 1.0).abs());
        }
        assert!(worst < 1e-13, "relative error {worst:e}");
    }

    #[test]
    fn the_ends_of_the_range_are_correct() {
        assert_eq!(power_of_two(0.0).to_bits(), 1.0_f64.to_bits());
        assert_eq!(power_of_two(-1e300).to_bits(), power_of_two(LOWEST).to_bits());
        assert!(power_of_two(LOWEST) > 0.0 && power_of_two(LOWEST).is_normal());
    }
}
