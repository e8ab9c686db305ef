//! The exponential function of inner loops, in both precisions: the same bits on every platform, and simple enough to be vectorised.
//!
//! The base is 2, so argument reduction is exact: `2ᵗ = 2ᵏ·2ᶠ` with `k = round(t)` and `f = t − k`. `2ᶠ` is a polynomial for `|f| ≤ ½`: of
//! degree 9 with a relative error of 1.6·10⁻¹⁴ (minimax, constant term 1), and in single precision of degree 7 with one of 6·10⁻⁹ (Taylor).
//! Only `+ − ×` and bit operations are used, whose results IEEE 754 determines to the last bit.

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
    let [first, others @ ..] = POLYNOMIAL;
    let p = others.into_iter().fold(first, |p, coefficient| p * f + coefficient) * f + 1.0;
    // The low bits of `shifted` are k in two's complement. Added to the exponent, they multiply by 2ᵏ.
    f64::from_bits(p.to_bits().wrapping_add(shifted.to_bits() << 52))
}

/// Arguments of [`power_of_two_f32`] are limited to those whose results are normal numbers.
const RANGE: (f32, f32) = (-126.0, 127.0);

/// [`ROUNDER`] for absolute values below 2²².
const ROUNDER_F32: f32 = 12_582_912.0; // 1.5·2²³

/// Coefficients of f⁷, f⁶, …, f.
const POLYNOMIAL_F32: [f32; 7] =
    [1.525_273_4e-5, 1.540_353e-4, 1.333_355_8e-3, 9.618_129e-3, 5.550_411e-2, 2.402_265e-1, 6.931_472e-1];

/// `2ᵗ` in single precision, relative error below 2⁻²²; arguments out of range are moved to its nearer end.
#[inline(always)]
pub(crate) fn power_of_two_f32(t: f32) -> f32 {
    let t = if t > RANGE.0 { t } else { RANGE.0 };
    let t = if t < RANGE.1 { t } else { RANGE.1 };
    let shifted = t + ROUNDER_F32;
    let f = t - (shifted - ROUNDER_F32);
    let [first, others @ ..] = POLYNOMIAL_F32;
    let p = others.into_iter().fold(first, |p, coefficient| p * f + coefficient) * f + 1.0;
    f32::from_bits(p.to_bits().wrapping_add(shifted.to_bits() << 23))
}

#[cfg(test)]
mod tests {
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
    fn in_single_precision_it_agrees_to_the_last_bits() {
        for step in -126_000..=127_000 {
            let t = step as f32 / 1000.0;
            let error = (f64::from(power_of_two_f32(t)) / libm::exp2(f64::from(t)) - 1.0).abs();
            assert!(error < 2f64.powi(-22), "{t}: {error:e}");
        }
        assert_eq!(power_of_two_f32(0.0).to_bits(), 1.0_f32.to_bits());
        assert_eq!(power_of_two_f32(-1e9).to_bits(), power_of_two_f32(-126.0).to_bits());
        assert_eq!(power_of_two_f32(f32::INFINITY).to_bits(), power_of_two_f32(127.0).to_bits());
    }

    #[test]
    fn the_ends_of_the_range_are_correct() {
        assert_eq!(power_of_two(0.0).to_bits(), 1.0_f64.to_bits());
        assert_eq!(power_of_two(-1e300).to_bits(), power_of_two(LOWEST).to_bits());
        assert!(power_of_two(LOWEST) > 0.0 && power_of_two(LOWEST).is_normal());
    }
}
